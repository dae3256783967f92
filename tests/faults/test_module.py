"""What befalls an output module is noticed, and nothing drives it again."""

import pytest

from gripperd.bench.wire_faults import WireFaultKind
from tests.faults import module


@pytest.fixture
def anyio_backend() -> object:
    """The loop of the daemon."""
    return "asyncio", {"use_uvloop": True}


@pytest.mark.anyio
@pytest.mark.parametrize(
    "kinds",
    [
        (WireFaultKind.POWER_CYCLED,),
        (WireFaultKind.POWER_CYCLED, WireFaultKind.WATCHDOG_TRIPPED),
    ],
)
async def test_a_module_at_another_value_is_a_fault_until_a_person_comes(
    kinds: tuple[WireFaultKind, ...],
) -> None:
    row = await module.befallen("module", *kinds, tries=1)
    assert row.wrong == ()
    assert "fault: module_restarted" in row.noticed
