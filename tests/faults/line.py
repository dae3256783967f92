"""Faults of single exchanges on every kind of line, and serial lines that go away."""

import tempfile
import time
from collections.abc import AsyncIterator, Iterator, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from random import Random

import uvloop

from gripperd.bench.rig import Rig
from gripperd.bench.wire_faults import WireFault, WireFaultKind
from gripperd.drivers.registers import Unit
from gripperd.errors import DeviceRefused, LinkError
from gripperd.protocol import dcon
from gripperd.protocol.modbus import WRITE_REGISTER, Request, Write
from tests.bench.line import OnLine, on_line
from tests.bench.test_wire_faults import DCON, HOLDING, MODBUS, READ_BACK, SET_TEXT
from tests.control.far_rig import GRIPPER, FarRig, Fault, far_rig
from tests.control.outage import controlled, hold, interrupt
from tests.drivers.far_end import Asked, FarEnd, honest, over_rtu, read
from tests.faults.row import Row, counted

TRIES = 3
TIMEOUT = 0.2
"""Of every line here, as shipped for TCP. [s]"""
WITHIN = 0.3
"""The time-out, and a machine that is busy. [s]"""
CUT = 0.4
"""How long a line is gone. [s]"""
OFFLINE_WITHIN, BACK_WITHIN = 0.3, 2.0
SERIAL = 0.25
"""Time-out of a serial line as shipped. [s]"""
CODES = (1, 2, 3, 4, 6)
MODULES = {
    "tcp": "waveshare_ao_8ch",
    "rtu": "waveshare_ao_8ch",
    "dcon": "icpdas_i_7024",
}

Asking = Request | dcon.Ask
Case = tuple[str, Asking, type[LinkError]]


def _cases() -> dict[WireFaultKind, list[Case]]:
    """Where each fault is met, by what, and as what it has to be told."""
    found: dict[WireFaultKind, list[Case]] = {}
    tables: Mapping[str, Sequence[tuple[WireFaultKind, Asking, type[LinkError]]]]
    tables = {"tcp": MODBUS, "rtu": MODBUS, "dcon": DCON}
    for line, table in tables.items():
        for kind, request, error in table:
            if kind is not WireFaultKind.WATCHDOG_TRIPPED:
                found.setdefault(kind, []).append((line, request, error))
    return found


@asynccontextmanager
async def _line(kind: str) -> AsyncIterator[OnLine]:
    rig = Rig(GRIPPER.chain, Random(1))
    with tempfile.TemporaryDirectory() as folder:
        opened = on_line(kind, rig, Path(folder), MODULES[kind], patience=TIMEOUT)
        async with opened as line:
            yield line


async def _told(line: OnLine, request: Asking) -> tuple[float, LinkError | None]:
    """How long an answer took, and what it was if none that is believed. [s]."""
    start = time.monotonic()
    try:
        await line.bus.ask(request)
    except LinkError as error:
        return time.monotonic() - start, error
    return time.monotonic() - start, None


async def _sound(line: OnLine, kind: str) -> bool:
    """Whether the line answers the right question again."""
    await line.bus.up.wait()
    if kind == "dcon":
        await line.bus.ask(dcon.Ask(1, "1", dcon.Lead.HOST, dcon.Good.ADDRESS))
        await line.bus.ask(SET_TEXT)
        return bool(await line.bus.ask(READ_BACK) == "+10.700")
    await line.bus.ask(HOLDING)  # Nothing is written to a line that was never read.
    await line.bus.ask(Write(1, 3, (5000,)))
    return bool((await line.bus.ask(HOLDING))[3] == 5000)


async def spoilt(fault: WireFaultKind, cases: list[Case], tries: int = TRIES) -> Row:
    """Spoil one exchange at a time; each is to be told, counted and over."""
    took, names, wrong = [], set[str](), set[str]()
    for kind, request, error in cases:
        async with _line(kind) as line:
            for _ in range(tries):
                if not await _sound(line, kind):
                    wrong.add(f"{kind}: unsound")
                before = line.bus.statistics.errors.total()
                line.bench.faults.set([WireFault(kind=fault, delay=1.5 * TIMEOUT)])
                seconds, said = await _told(line, request)
                took.append(seconds)
                names.add(type(said).__name__)
                if not isinstance(said, error):
                    wrong.add(f"{kind}: {said!r}")
                if line.bus.statistics.errors.total() != before + 1:
                    wrong.add(f"{kind}: not counted")
    lines = ", ".join(dict.fromkeys(kind for kind, _, _ in cases))
    return Row(
        fault=f"{fault.replace('_', ' ')} ({lines})",
        noticed=", ".join(sorted(names)),
        took=tuple(took),
        limit=WITHIN,
        wrong=tuple(sorted(wrong)),
    )


async def excepted(tries: int = TRIES) -> Row:
    """Exceptions instead of answers, which say nothing against the line."""
    took, wrong = [], set[str]()
    for kind in ("tcp", "rtu"):
        async with _line(kind) as line:
            for code in CODES * tries:
                await _sound(line, kind)
                fault = WireFault(kind=WireFaultKind.EXCEPTION, code=code)
                line.bench.faults.set([fault])
                seconds, said = await _told(line, Write(1, 0, (10_700,)))
                took.append(seconds)
                if not isinstance(said, DeviceRefused) or said.exception_code != code:
                    wrong.add(f"{kind}: {said!r}")
                if not line.bus.up.is_set():
                    wrong.add(f"{kind}: the line was given up")
    told = f"DeviceRefused {', '.join(map(str, CODES))}"
    return Row(
        fault="exception to a write (tcp, rtu)",
        noticed=told,
        took=tuple(took),
        limit=WITHIN,
        wrong=tuple(sorted(wrong)),
    )


async def busy(tries: int = TRIES) -> Row:
    """A device that is busy once: what reads asks again, a write is never repeated."""
    found = []
    for kind in ("tcp", "rtu"):
        async with _line(kind) as line:
            once = WireFault(kind=WireFaultKind.EXCEPTION, code=6)
            for _ in range(tries):
                await _sound(line, kind)
                line.bench.faults.set([once])
                words = await Unit(line.bus, 1).look(HOLDING)
                found.append("read answered" if words[3] == 5000 else "read wrong")
                line.bench.faults.set([once])
                before = line.bus.statistics.requests
                _, said = await _told(line, Write(1, 0, (10_700,)))
                sent = line.bus.statistics.requests - before
                refused = isinstance(said, DeviceRefused) and sent == 1
                found.append("write refused" if refused else f"write sent {sent} times")
    fault = "exception 6, busy, once (tcp, rtu)"
    return counted(fault, found, {"read answered", "write refused"})


async def echoed(tries: int = TRIES) -> Row:
    """A converter that hears itself, as the settings say."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "echoing"
        async with over_rtu(path, TIMEOUT, local_echo=True) as (bus, far):
            far.behave = _echoing
            for place in range(tries):
                right = await bus.ask(read(place)) == (1000 + place,)
                found.append("read right" if right else "read wrong")
                written = await bus.ask(Write(1, 0, (10_000 + place,)))
                right = written == (10_000 + place,)
                found.append("write right" if right else "write wrong")
    fault = "own echo, `local_echo: true` (rtu)"
    return counted(fault, found, {"read right", "write right"})


def _echoing(far: FarEnd, asked: Asked) -> None:
    far.put(asked.frame)
    honest(far, asked)


async def gone(
    fault: Fault, tries: int = TRIES, patience: float = SERIAL
) -> tuple[Row, Row]:
    """A serial line that goes away and comes back while an apple is held."""
    offline, back, wrong = [], [], set[str]()
    with tempfile.TemporaryDirectory() as folder:
        async with (
            far_rig(fault, Path(folder), patience) as (bus, far),
            controlled(bus) as loop,
        ):
            await hold(loop, far)
            for _ in range(tries):
                held = far.output
                outage = await interrupt(loop, far, CUT)
                offline.append(outage.offline_after)
                back.append(outage.ready_after)
                if far.output != held or _written(far, outage.mended):
                    wrong.add("written before it was adopted")
    return (
        Row(
            fault=f"{fault}",
            noticed="offline",
            took=tuple(offline),
            limit=OFFLINE_WITHIN,
            wrong=tuple(wrong),
        ),
        Row(
            fault=f"{fault}: over",
            noticed="adopted, ready",
            took=tuple(back),
            limit=BACK_WITHIN,
        ),
    )


def _written(far: FarRig, since: float) -> bool:
    return any(
        asked.pdu[0] == WRITE_REGISTER for asked in far.heard if asked.at >= since
    )


def rows() -> Iterator[Row]:
    """Every kind of fault on every line that knows it."""
    for fault, cases in _cases().items():
        yield uvloop.run(spoilt(fault, cases))
    yield uvloop.run(excepted())
    yield uvloop.run(busy())
    yield uvloop.run(echoed())
    for silent in (Fault.RTU_SILENT, Fault.RTU_UNPLUGGED):
        yield from uvloop.run(gone(silent))
