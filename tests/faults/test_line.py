"""Lines that are busy, echo or go away; tests/drivers has all other faults."""

import pytest

from tests.control.far_rig import Fault
from tests.faults import line

PATIENT = 10.0
"""Time-out where a busy machine must not make a test fail. [s]"""


@pytest.fixture
def anyio_backend() -> object:
    """The loop of the daemon."""
    return "asyncio", {"use_uvloop": True}


@pytest.mark.anyio
async def test_a_busy_device_is_read_again_and_never_written_again() -> None:
    assert (await line.busy(1)).wrong == ()


@pytest.mark.anyio
async def test_an_echo_that_the_settings_know_of_harms_nothing() -> None:
    assert (await line.echoed(2)).wrong == ()


@pytest.mark.anyio
async def test_an_adapter_that_is_unplugged_is_adopted_before_it_is_written() -> None:
    offline, back = await line.gone(Fault.RTU_UNPLUGGED, 1, PATIENT)
    assert (offline.wrong, back.wrong) == ((), ())
