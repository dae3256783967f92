"""The real control loop on a line that is cut, or busy; the far end tells what came."""

from pathlib import Path

import pytest

from gripperd.control.gripper import ATTACH_SAMPLES
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused
from gripperd.protocol.modbus import WRITE_REGISTER, Table

from ..drivers.far_end import Asked  # noqa: TID252
from .far_rig import Fault, far_rig
from .outage import (
    QUEUED,
    SOON,
    Outage,
    became,
    controlled,
    hold,
    interrupt,
    stop_behind_reads,
)

PATIENCE = 1.0
"""Time-out of the bus: no reply of the far end takes so long. [s]"""
LONG, SHORT = 10.0, 0.3
"""How long the line is cut; that it is lost is always waited for. [s]"""
OUTPUT_UNIT = 1


@pytest.fixture
def anyio_backend() -> object:
    """The loop of the daemon."""
    return "asyncio", {"use_uvloop": True}


def writes(heard: tuple[Asked, ...]) -> list[int]:
    """What was written to the output register. [µA]."""
    return [asked.value for asked in heard if asked.pdu[0] == WRITE_REGISTER]


def looks_before_the_first_write(heard: tuple[Asked, ...], outage: Outage) -> int:
    """How often the output register was read since the line was back."""
    kinds = [asked.pdu[0] for asked in heard]
    before = heard[: kinds.index(WRITE_REGISTER)]
    looks = [
        asked
        for asked in before
        if asked.at >= outage.mended
        and (asked.unit, asked.pdu[0]) == (OUTPUT_UNIT, Table.HOLDING)
        and asked.address == 0
    ]
    return len(looks)


@pytest.mark.parametrize(
    ("fault", "seconds"),
    [
        (Fault.TCP_SILENT, LONG),
        (Fault.TCP_CLOSED, SHORT),
        (Fault.RTU_SILENT, SHORT),
        (Fault.RTU_UNPLUGGED, SHORT),
    ],
)
async def test_a_line_cut_while_holding_moves_nothing_and_is_read_before_it_is_written(
    fault: Fault, seconds: float, tmp_path: Path
) -> None:
    async with (
        far_rig(fault, tmp_path, PATIENCE) as (bus, far),
        controlled(bus) as loop,
    ):
        await hold(loop, far)
        held, force = far.output, far.rig.plant.grip
        outage = await interrupt(loop, far, seconds)
        assert writes(outage.heard) == []
        assert far.output == held
        assert far.rig.plant.grip == pytest.approx(force, rel=0.05)
        state = loop.state()
        assert state.adopted
        assert state.current == pytest.approx(held * 1e-6)
        assert state.grip is Grip.HOLDING
        # Only to see generous bounds kept; the figures are in the benchmark "outage".
        assert outage.offline_after < SOON / 4
        assert outage.ready_after < SOON / 4

        since = len(far.heard)
        release, _ = loop.submit(None, SOON, None)
        await loop.wait(release.id, SOON)
        heard = (*outage.heard, *far.heard[since:])
        assert looks_before_the_first_write(heard, outage) >= ATTACH_SAMPLES
        first, *_, last = writes(heard)
        assert last < first <= held


async def test_what_was_set_while_the_line_was_cut_is_adopted_and_not_undone(
    tmp_path: Path,
) -> None:
    fault = Fault.TCP_SILENT
    async with (
        far_rig(fault, tmp_path, PATIENCE) as (bus, far),
        controlled(bus) as loop,
    ):
        await hold(loop, far)
        outage = await interrupt(loop, far, SHORT, meanwhile=9000)
        assert loop.state().current == pytest.approx(9e-3)
        assert loop.state().adopted
        assert writes(outage.heard) == []
        assert far.output == 9000


async def test_a_line_that_is_cut_takes_no_command_and_no_stop(tmp_path: Path) -> None:
    fault = Fault.TCP_SILENT
    async with (
        far_rig(fault, tmp_path, PATIENCE) as (bus, far),
        controlled(bus) as loop,
    ):
        await hold(loop, far)
        since = len(far.heard)
        far.cut()
        await became(loop, Machine.OFFLINE)
        with pytest.raises(Refused, match="offline"):
            loop.submit(None, SOON, None)
        with pytest.raises(Refused, match="offline"):
            await loop.stop()
        far.mend()
        await became(loop, Machine.READY)
        assert writes(tuple(far.heard[since:])) == []


@pytest.mark.parametrize("fault", [Fault.TCP_SILENT, Fault.RTU_SILENT])
async def test_a_stop_passes_all_that_waits_but_the_request_in_flight(
    fault: Fault, tmp_path: Path
) -> None:
    async with (
        far_rig(fault, tmp_path, PATIENCE) as (bus, far),
        controlled(bus) as loop,
    ):
        _, heard = await stop_behind_reads(loop, bus, far)
        assert heard[0].pdu[0] == WRITE_REGISTER
        assert [asked.pdu[0] for asked in heard[1 : 1 + QUEUED]] == (
            [Table.HOLDING] * QUEUED
        )
        await became(loop, Machine.READY)
        assert writes(heard) == [heard[0].value] == [far.output]
