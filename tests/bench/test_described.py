"""Every shipped module on every line that it speaks, driven by us and by others."""

from pathlib import Path

import pytest
from pymodbus.client import AsyncModbusTcpClient
from pymodbus.client.mixin import ModbusClientMixin

from gripperd.bench.rig import Rig
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.wiring import (
    InputWiring,
    OutputWiring,
    SensorWiring,
    WatchdogSettings,
)
from gripperd.errors import WatchdogTripped
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import InputModule, ModuleDialect, OutputModule
from gripperd.signals import Quality

from .line import DESCRIBED, LINES, OnLine, on_line, spoken

SPANS = {"pressure": 600e3, "opening": 0.1, "grip": 100.0}
PATIENCE = 0.5
"""Generous, so that a busy machine is no fault of the line. [s]"""
COARSEST = 16e-3 / 1023
"""Step of an SMC regulator; every other module is finer. [A]"""
OUTPUTS = [n for n, module in DESCRIBED.items() if isinstance(module, OutputModule)]
INPUTS = [n for n, module in DESCRIBED.items() if isinstance(module, InputModule)]
NUMBERS = ModbusClientMixin.DATATYPE


def on_lines(names: list[str]) -> list[tuple[str, str]]:
    return [(name, line) for name in names for line in spoken(name)]


def dialect(name: str, line: str) -> ModuleDialect:
    known = DESCRIBED[name].dialects
    return next(each for each in LINES[line] if each in known)


def wired(
    line: OnLine, name: str, kind: str, watchdog: WatchdogSettings | None = None
) -> AnalogRig:
    """Our driver for an output module at unit 1."""
    module = DESCRIBED[name]
    assert isinstance(module, OutputModule)
    wiring = OutputWiring(
        module=module,
        unit=1,
        channel=0,
        dialect=dialect(name, kind),
        watchdog=watchdog,
    )
    return AnalogRig(line.bus, wiring, None)


def test_every_shipped_module_is_here() -> None:
    assert len(OUTPUTS) + len(INPUTS) == len(DESCRIBED) >= 18


@pytest.mark.parametrize(("name", "kind"), on_lines(OUTPUTS))
async def test_our_driver_drives_the_valve(
    rig: Rig, tmp_path: Path, name: str, kind: str
) -> None:
    async with on_line(kind, rig, tmp_path, name, patience=PATIENCE) as line:
        valve = wired(line, name, kind)
        before = (await valve.read(0.0)).current.value
        assert before == pytest.approx(rig.plant.current, abs=COARSEST)
        await valve.write(0.0107)
        assert rig.plant.current == pytest.approx(0.0107, abs=COARSEST)
        after = (await valve.read(1.0)).current.value
        assert after == pytest.approx(rig.plant.current, abs=1e-9)


@pytest.mark.parametrize(("name", "kind"), on_lines(INPUTS))
async def test_our_driver_reads_the_sensors(
    rig: Rig, tmp_path: Path, name: str, kind: str
) -> None:
    module = DESCRIBED[name]
    assert isinstance(module, InputModule)
    sensors = {
        sensor: SensorWiring(
            channel=channel, scale=LoopScale(value_low=0.0, value_high=span)
        )
        for channel, (sensor, span) in enumerate(SPANS.items())
    }
    driver = "dcon" if kind == "dcon" else "modbus"
    output = {"dcon": "icpdas_i_7024", "modbus": "waveshare_ao_8ch"}[driver]
    async with on_line(kind, rig, tmp_path, output, name, patience=PATIENCE) as line:
        valve = DESCRIBED[output]
        assert isinstance(valve, OutputModule)
        rigged = AnalogRig(
            line.bus,
            OutputWiring(
                module=valve, unit=1, channel=0, dialect=dialect(output, kind)
            ),
            InputWiring(
                module=module, unit=2, sensors=sensors, dialect=dialect(name, kind)
            ),
        )
        measured = await rigged.read(0.0)
        for sensor in (measured.pressure, measured.opening, measured.grip):
            assert sensor.quality is Quality.GOOD, sensor.cause
        # 85 of 100 mm; five sigma of 0.05 %, and the coarsest count.
        assert measured.opening.value == pytest.approx(0.085, abs=3e-4)
        assert measured.pressure.value == pytest.approx(0.0, abs=1700)


@pytest.mark.parametrize(
    ("name", "address", "sent", "current"),
    [
        ("waveshare_ao_8ch", 0, 10_700, 10.7e-3),
        ("adam_6224", 0, 1715, 10.7e-3),
        ("adam_6024", 10, 1715, 10.7e-3),
        ("adam_4024", 0, 1715, 10.7e-3),
        ("icpdas_i_7024", 0, 10_700, 10.7e-3),
        ("brainboxes_ed_560_int", 0, 6860, 10.7e-3),
        ("brainboxes_ed_560_engineering", 0, 10_700, 10.7e-3),
        ("wago_750_554", 0, 13_720, 10.7e-3),
    ],
)
async def test_pymodbus_drives_the_valve_with_the_count_of_the_manual(
    rig: Rig, tmp_path: Path, name: str, address: int, sent: int, current: float
) -> None:
    async with (
        on_line("tcp", rig, tmp_path, name) as line,
        pymodbus(line) as client,
    ):
        written = await client.write_register(address, sent, device_id=1)
        assert not written.isError()
    assert rig.plant.current == pytest.approx(current, abs=4e-6)


@pytest.mark.parametrize(
    ("name", "address", "word_order"),
    [("brainboxes_ed_560", 0x20, "little"), ("moxa_e1241", 0, "big")],
)
async def test_pymodbus_drives_the_valve_with_a_float(
    rig: Rig, tmp_path: Path, name: str, address: int, word_order: str
) -> None:
    words = AsyncModbusTcpClient.convert_to_registers(
        10.7,
        NUMBERS.FLOAT32,
        word_order=word_order,  # type: ignore[arg-type]
    )
    async with (
        on_line("tcp", rig, tmp_path, name) as line,
        pymodbus(line) as client,
    ):
        written = await client.write_registers(address, words, device_id=1)
        assert not written.isError()
        read = await client.read_holding_registers(address, count=2, device_id=1)
        assert read.registers == words
    assert rig.plant.current == pytest.approx(0.0107, abs=1e-9)


WATCHED = [
    ("wago_750_554", "tcp"),
    ("icpdas_i_7024", "rtu"),
    ("icpdas_i_7024", "dcon"),
    ("brainboxes_ed_560", "dcon"),
]


@pytest.mark.parametrize(("name", "kind"), WATCHED)
async def test_our_driver_arms_a_watchdog_and_notices_its_trip(
    rig: Rig, tmp_path: Path, name: str, kind: str
) -> None:
    asked = WatchdogSettings(timeout=20.0, safe_current=None)
    async with on_line(kind, rig, tmp_path, name, patience=PATIENCE) as line:
        valve = wired(line, name, kind, asked)
        await valve.read(0.0)
        (outputs,) = line.bench.modules.outputs
        assert outputs.watchdog.timeout == pytest.approx(20.0)
        await valve.write(0.0107)
        # The time that nobody keeps it quiet in is that of the bench.
        assert outputs.watchdog.due is not None
        line.bench.modules.advance(outputs.watchdog.due + 0.1)
        assert rig.plant.current == pytest.approx(0.004)
        with pytest.raises(WatchdogTripped):
            await valve.read(60.0)
        with pytest.raises(WatchdogTripped):
            await valve.write(0.0107)
        assert rig.plant.current == pytest.approx(0.004)


def pymodbus(line: OnLine) -> AsyncModbusTcpClient:
    host, _, port = line.bench.address.rpartition(":")
    return AsyncModbusTcpClient(host, port=int(port), timeout=60, retries=0)
