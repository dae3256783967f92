"""Faults of the wire: the queue, and each of them as the driver meets it."""

from contextlib import nullcontext
from pathlib import Path
from random import Random

import pytest

from gripperd.bench.rig import Rig
from gripperd.bench.wire_faults import Asked, WireFault, WireFaultKind, WireFaults
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import (
    BadReply,
    DeviceRefused,
    InputError,
    LinkError,
    LocalEcho,
    ReplyTimeout,
    WatchdogTripped,
)
from gripperd.protocol import dcon, itv
from gripperd.protocol.modbus import Read, Table, Write
from gripperd.protocol.modules import OutputModule
from gripperd.signals import Quality

from ..drivers.steady import unsteady  # noqa: TID252
from .line import DESCRIBED, PATIENCE, OnLine, on_line

READ = Asked(frozenset({2}), writes=False, drives=False)
WRITE = Asked(frozenset({1}), writes=True, drives=True)


def queue(*faults: WireFault, chance: float = 0.0, seed: int = 1) -> WireFaults:
    found = WireFaults(Random(seed))
    found.set(faults, chance)
    return found


def test_requests_meet_faults_in_their_order() -> None:
    faults = queue(
        WireFault(kind=WireFaultKind.NONE),
        WireFault(kind=WireFaultKind.LOST, times=2),
        WireFault(kind=WireFaultKind.LATE),
    )
    met = [faults.meet(READ) for _ in range(5)]
    kinds = [fault.kind if fault else None for fault in met]
    assert kinds == [
        None,
        WireFaultKind.LOST,
        WireFaultKind.LOST,
        WireFaultKind.LATE,
        None,
    ]
    assert faults.waiting == ()


@pytest.mark.parametrize(
    ("fault", "passes", "meets"),
    [
        (WireFault(kind=WireFaultKind.WRONG_ECHO), READ, WRITE),
        (WireFault(kind=WireFaultKind.SHORT), WRITE, READ),
        (WireFault(kind=WireFaultKind.WATCHDOG_TRIPPED), READ, WRITE),
        (WireFault(kind=WireFaultKind.OPEN_LOOP), READ, WRITE),
        (WireFault(kind=WireFaultKind.LOST, unit=1), READ, WRITE),
    ],
)
def test_a_fault_waits_for_a_request_that_it_can_befall(
    fault: WireFault, passes: Asked, meets: Asked
) -> None:
    faults = queue(fault)
    assert faults.meet(passes) is None
    assert faults.waiting == (fault,)
    assert faults.meet(meets) == fault


def test_chance_is_the_same_with_the_same_seed_and_as_frequent_as_told() -> None:
    first, second = queue(chance=0.25, seed=7), queue(chance=0.25, seed=7)
    met = [first.meet(READ) for _ in range(4000)]
    assert met == [second.meet(READ) for _ in range(4000)]
    # Wrong echoes, one kind of eleven, do not befall reads; five sigma.
    share = sum(fault is not None for fault in met) / 4000
    assert share == pytest.approx(0.25 * 10 / 11, abs=0.035)
    kinds = {fault.kind for fault in met if fault}
    assert not kinds & {
        WireFaultKind.WATCHDOG_TRIPPED,
        WireFaultKind.OPEN_LOOP,
        WireFaultKind.POWER_CYCLED,
    }


@pytest.mark.parametrize(
    ("key", "value"),
    [("code", 0), ("code", 256), ("delay", -1.0), ("unit", 256), ("times", 0)],
)
def test_an_impossible_fault_is_refused(key: str, value: float) -> None:
    with pytest.raises(InputError, match=key):
        WireFault(**{"kind": WireFaultKind.LATE, key: value})  # type: ignore[arg-type]


def test_a_chance_that_is_no_probability_is_refused() -> None:
    with pytest.raises(InputError, match="chance"):
        queue(chance=1.5)


HOLDING = Read(1, Table.HOLDING, 0, 4)
SET = Write(1, 0, (10_700,))
MODBUS: list[tuple[WireFaultKind, Read | Write, type[LinkError]]] = [
    (WireFaultKind.LATE, HOLDING, ReplyTimeout),
    (WireFaultKind.LOST, SET, ReplyTimeout),
    (WireFaultKind.GARBLED, HOLDING, LinkError),
    (WireFaultKind.WRONG_UNIT, HOLDING, BadReply),
    (WireFaultKind.WRONG_FUNCTION, HOLDING, BadReply),
    (WireFaultKind.WRONG_FUNCTION, SET, BadReply),
    (WireFaultKind.WRONG_ECHO, SET, BadReply),
    (WireFaultKind.SHORT, HOLDING, BadReply),
    (WireFaultKind.CUT, HOLDING, ReplyTimeout),
    (WireFaultKind.NOISE, HOLDING, LinkError),
    (WireFaultKind.LOCAL_ECHO, HOLDING, BadReply),
]


async def is_not_believed(
    line: OnLine, fault: WireFaultKind, request: object, error: type[LinkError]
) -> None:
    """A fault befalls a request, and the bus is up again soon."""
    line.bench.faults.set([WireFault(kind=fault, delay=1.5 * PATIENCE)])
    late = fault is WireFaultKind.LATE
    with unsteady(line.bus) if late else nullcontext(), pytest.raises(error):
        await line.bus.ask(request)
    await line.bus.up.wait()


async def modbus_is_sound_again(line: OnLine) -> None:
    await line.bus.up.wait()
    assert await line.bus.ask(Write(1, 3, (5000,))) == (5000,)
    assert (await line.bus.ask(HOLDING))[3] == 5000


@pytest.mark.parametrize("kind", ["tcp", "rtu"])
@pytest.mark.parametrize(("fault", "request_", "error"), MODBUS)
async def test_modbus_is_spoilt_once_and_the_driver_notices(
    rig: Rig,
    tmp_path: Path,
    kind: str,
    fault: WireFaultKind,
    request_: Read | Write,
    error: type[LinkError],
) -> None:
    async with on_line(kind, rig, tmp_path, "waveshare_ao_8ch") as line:
        assert len(await line.bus.ask(HOLDING)) == 4
        await is_not_believed(line, fault, request_, error)
        await modbus_is_sound_again(line)
        # The module has obeyed all the same.
        driven = 10.7e-3 if request_ is SET else 0.0
        assert rig.plant.current == pytest.approx(driven)


@pytest.mark.parametrize("kind", ["tcp", "rtu"])
@pytest.mark.parametrize("code", [1, 2, 4, 6])
async def test_an_exception_is_given_and_nothing_is_done(
    rig: Rig, tmp_path: Path, kind: str, code: int
) -> None:
    async with on_line(kind, rig, tmp_path, "waveshare_ao_8ch") as line:
        await line.bus.ask(HOLDING)
        line.bench.faults.set([WireFault(kind=WireFaultKind.EXCEPTION, code=code)])
        with pytest.raises(DeviceRefused) as refused:
            await line.bus.ask(Write(1, 0, (10_700,), multiple=True))
        assert refused.value.exception_code == code
        assert rig.plant.current == 0.0
        await modbus_is_sound_again(line)


async def test_the_echo_of_a_line_is_called_so(rig: Rig, tmp_path: Path) -> None:
    async with on_line("rtu", rig, tmp_path, "waveshare_ao_8ch") as line:
        line.bench.faults.set([WireFault(kind=WireFaultKind.LOCAL_ECHO)])
        with pytest.raises(LocalEcho):
            await line.bus.ask(HOLDING)


READ_BACK = dcon.Ask(1, "60", dcon.Lead.SETTING, dcon.Good.ADDRESS, 7)
SET_TEXT = dcon.Ask(1, "0+10.700")
DCON = [
    (WireFaultKind.LATE, SET_TEXT, ReplyTimeout),
    (WireFaultKind.LOST, SET_TEXT, ReplyTimeout),
    (WireFaultKind.GARBLED, SET_TEXT, BadReply),
    (WireFaultKind.GARBLED, READ_BACK, BadReply),
    (WireFaultKind.WRONG_UNIT, READ_BACK, BadReply),
    (WireFaultKind.WRONG_FUNCTION, SET_TEXT, BadReply),
    (WireFaultKind.WRONG_FUNCTION, READ_BACK, BadReply),
    (WireFaultKind.WRONG_ECHO, SET_TEXT, BadReply),
    (WireFaultKind.SHORT, READ_BACK, BadReply),
    (WireFaultKind.CUT, READ_BACK, ReplyTimeout),
    (WireFaultKind.EXCEPTION, READ_BACK, DeviceRefused),
    (WireFaultKind.NOISE, READ_BACK, BadReply),
    (WireFaultKind.LOCAL_ECHO, READ_BACK, LocalEcho),
    (WireFaultKind.WATCHDOG_TRIPPED, SET_TEXT, WatchdogTripped),
]


@pytest.mark.parametrize(("fault", "request_", "error"), DCON)
async def test_dcon_is_spoilt_once_and_the_driver_notices(
    rig: Rig,
    tmp_path: Path,
    fault: WireFaultKind,
    request_: dcon.Ask,
    error: type[LinkError],
) -> None:
    async with on_line("dcon", rig, tmp_path, "icpdas_i_7024") as line:
        await is_not_believed(line, fault, request_, error)
        await line.bus.ask(dcon.Ask(1, "1", dcon.Lead.HOST, dcon.Good.ADDRESS))
        assert await line.bus.ask(SET_TEXT) == ""
        assert await line.bus.ask(READ_BACK) == "+10.700"


ITV = [
    (WireFaultKind.LATE, itv.Set(428), ReplyTimeout),
    (WireFaultKind.LOST, itv.Set(428), ReplyTimeout),
    (WireFaultKind.GARBLED, itv.Query.SET_POINT, BadReply),
    (WireFaultKind.WRONG_FUNCTION, itv.Query.SET_POINT, BadReply),
    (WireFaultKind.WRONG_ECHO, itv.Set(428), BadReply),
    (WireFaultKind.SHORT, itv.Query.SET_POINT, BadReply),
    (WireFaultKind.CUT, itv.Query.SET_POINT, ReplyTimeout),
    (WireFaultKind.EXCEPTION, itv.Set(428), DeviceRefused),
    (WireFaultKind.NOISE, itv.Query.SET_POINT, BadReply),
    (WireFaultKind.LOCAL_ECHO, itv.Query.SET_POINT, BadReply),
]


@pytest.mark.parametrize(("fault", "request_", "error"), ITV)
async def test_a_regulator_is_spoilt_once_and_the_driver_notices(
    rig: Rig,
    tmp_path: Path,
    fault: WireFaultKind,
    request_: itv.Request,
    error: type[LinkError],
) -> None:
    async with on_line("itv", rig, tmp_path, "smc_itv_rc") as line:
        await is_not_believed(line, fault, request_, error)
        assert await line.bus.ask(itv.Set(512)) == 512
        assert await line.bus.ask(itv.Query.SET_POINT) == 512


def adam(line: OnLine) -> AnalogRig:
    module = DESCRIBED["adam_6224"]
    assert isinstance(module, OutputModule)
    wiring = OutputWiring(module=module, unit=1, channel=0)
    return AnalogRig(line.bus, wiring, None)


async def test_a_tripped_watchdog_is_noticed_and_not_driven(
    rig: Rig, tmp_path: Path
) -> None:
    async with on_line("tcp", rig, tmp_path, "adam_6224") as line:
        valve = adam(line)
        await valve.read(0.0)
        await valve.write(0.012)
        line.bench.faults.set([WireFault(kind=WireFaultKind.WATCHDOG_TRIPPED)])
        with pytest.raises(WatchdogTripped):
            await valve.read(1.0)
        with pytest.raises(WatchdogTripped):
            await valve.write(0.012)
        assert rig.plant.current == pytest.approx(0.004)


async def test_an_open_loop_is_a_bad_reading_until_it_is_mended(
    rig: Rig, tmp_path: Path
) -> None:
    async with on_line("tcp", rig, tmp_path, "adam_6224") as line:
        valve = adam(line)
        await valve.read(0.0)
        await valve.write(0.012)
        line.bench.faults.set([WireFault(kind=WireFaultKind.OPEN_LOOP)])
        measured = (await valve.read(1.0)).current
        assert measured.quality is Quality.BAD
        assert "the loop is open" in measured.cause
        assert rig.plant.current == 0.0
        line.bench.modules.mend()
        measured = (await valve.read(2.0)).current
        assert measured.value == pytest.approx(0.012, abs=4e-6)


async def test_a_power_cycle_shows_in_the_read_back(rig: Rig, tmp_path: Path) -> None:
    async with on_line("tcp", rig, tmp_path, "adam_6224") as line:
        valve = adam(line)
        await valve.read(0.0)
        await valve.write(0.012)
        line.bench.faults.set([WireFault(kind=WireFaultKind.POWER_CYCLED)])
        assert (await valve.read(1.0)).current.value == pytest.approx(0.004)
