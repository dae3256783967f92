"""What an input module says that cannot be is told, and nothing is let go."""

import math

import pytest

from tests.faults import inputs
from tests.faults.inputs import Line


@pytest.fixture
def anyio_backend() -> object:
    """The loop of the daemon."""
    return "asyncio", {"use_uvloop": True}


@pytest.mark.anyio
@pytest.mark.parametrize(
    ("line", "instead", "cause"),
    [
        (inputs.in_registers, math.nan, "its current is not a number"),
        (inputs.in_text, "+nan   ", "'+nan   ' is not a current"),
    ],
)
async def test_a_force_that_is_no_number_is_replaced_and_told(
    line: Line, instead: object, cause: str
) -> None:
    row = await inputs.said(line, instead, tries=1)
    assert row.wrong == ()
    assert cause in row.noticed


@pytest.mark.anyio
@pytest.mark.parametrize("name", inputs.WIRES)
async def test_a_wire_that_is_cut_or_shorted_is_told_or_warned_of(name: str) -> None:
    row = await inputs.wired(name, inputs.WIRES[name])
    assert row.wrong == ()
    assert row.came["told"] >= 11
