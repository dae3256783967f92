from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.config import GripperSettings, load_settings, shipped
from gripperd.drivers.analog import AnalogRig, WatchdogSettings
from gripperd.drivers.bus import DconAddress, ItvAddress, RtuAddress
from gripperd.protocol.modules import ModuleDialect
from tests.drivers.device import Device, holding, on_the_wire

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

TCP = '{tcp: "plc.local:502"}'
LINE = "serial: /dev/serial/by-id/usb-FTDI_FT232R-if00-port0, protocol: "
RTU, DCON, ITV = f"{{{LINE}rtu}}", f"{{{LINE}dcon}}", f"{{{LINE}itv}}"


def settings(bus: str, output: str, rest: str = "") -> str:
    return f"""\
grippers:
  left:
    bus: {bus}
    output: {output}
    model: {shipped("models/reference.yaml")}
    fail_mode: vent
{rest}profiles: objects
"""


@pytest.fixture
def gripper(tmp_path: Path, write: Write) -> Callable[..., GripperSettings]:
    """The one gripper of a settings file."""
    (tmp_path / "objects").mkdir()

    def load(bus: str, output: str, rest: str = "") -> GripperSettings:
        path = write("own.yaml", settings(bus, output, rest))
        return load_settings(path, {}).grippers["left"]

    return load


Load = Callable[..., GripperSettings]


def test_a_serial_line_has_every_setting_of_its_port(gripper: Load) -> None:
    bus = f"{{{LINE}rtu, baud: 19200, parity: E, stop_bits: 1, local_echo: true}}"
    output = "{module: adam_4024, unit: 1, channel: 0}"
    loaded = gripper(bus, output)
    assert loaded.bus == RtuAddress(
        port="/dev/serial/by-id/usb-FTDI_FT232R-if00-port0",
        baud=19_200,
        parity="E",
        stop_bits=1,
        local_echo=True,
        timeout=0.25,
    )
    assert loaded.output.dialect is ModuleDialect.MODBUS


def test_the_bus_decides_what_a_module_is_asked_in(gripper: Load) -> None:
    bus = f"{{{LINE}dcon, checksum: true, timeout_ms: 250}}"
    adam = gripper(bus, "{module: adam_4024, unit: 1, channel: 3}")
    assert isinstance(adam.bus, DconAddress)
    assert (adam.bus.checksum, adam.bus.timeout) == (True, 0.25)
    assert adam.output.dialect is ModuleDialect.ADAM_ASCII
    icpdas = gripper(DCON, "{module: icpdas_i_7024, unit: 1, channel: 3}")
    assert icpdas.output.dialect is ModuleDialect.DCON


def test_the_bus_decides_what_the_sensors_are_asked_in(gripper: Load) -> None:
    sensors = (
        "    input: {module: adam_4017_plus, unit: 2, range: 4-20mA,\n"
        "      grip: {channel: 2, current_mA: [4, 20], grip_N: [0, 100]}}\n"
        "    interlocks: {estop: {channel: 4}}\n"
    )
    output = "{module: icpdas_i_7024, unit: 1, channel: 0}"
    wiring = gripper(DCON, output, sensors).input
    assert wiring is not None
    assert (wiring.dialect, wiring.range_name) == (ModuleDialect.ADAM_ASCII, "4-20mA")
    assert set(wiring.sensors) == {"grip", "estop"}


def test_a_regulator_needs_neither_unit_nor_channel(gripper: Load) -> None:
    loaded = gripper(ITV, "{module: smc_itv_rc}")
    assert isinstance(loaded.bus, ItvAddress)
    assert (loaded.output.unit, loaded.output.channel) == (0, 0)
    assert loaded.output.dialect is ModuleDialect.ITV


def test_range_and_watchdog_are_what_the_file_says(gripper: Load) -> None:
    output = (
        "{module: icpdas_i_7024, unit: 1, channel: 0, range: 0-20mA,"
        " watchdog: {timeout_s: 2, safe_mA: 4}}"
    )
    wiring = gripper(DCON, output).output
    assert wiring.range.current_low == 0.0
    assert wiring.watchdog == WatchdogSettings(timeout=2.0, safe_current=0.004)
    assert not wiring.set_range


UNIT = "unit: 1, channel: 0"


@pytest.mark.parametrize(
    ("bus", "output", "complaint"),
    [
        (
            DCON,
            f"{{module: waveshare_ao_8ch, {UNIT}}}",
            "output: waveshare_ao_8ch speaks modbus, the bus at"
            " /dev/serial/by-id/usb-FTDI_FT232R-if00-port0 speaks dcon or adam_ascii",
        ),
        (
            TCP,
            "{module: smc_itv_rc}",
            "output: smc_itv_rc speaks itv, the bus at plc.local:502 speaks modbus",
        ),
        (
            "bench",
            "{module: smc_itv_rc}",
            "output: smc_itv_rc speaks itv, the bench speaks modbus",
        ),
        (
            TCP,
            "{module: adam_6224, channel: 0}",
            "output: unit is missing; adam_6224 needs one",
        ),
        (
            TCP,
            "{module: adam_6224, unit: 1}",
            "output: channel is missing; adam_6224 needs one",
        ),
        (
            TCP,
            f"{{module: adam_6224, {UNIT}, range: 4-20}}",
            'output.range: "4-20" is not a range of adam_6224; did you mean "4-20mA"?',
        ),
        (
            TCP,
            f"{{module: waveshare_ao_8ch, {UNIT}, watchdog: {{timeout_s: 2}}}}",
            "output: watchdog.timeout_s: waveshare_ao_8ch has no watchdog that can be"
            " armed over modbus",
        ),
        (
            DCON,
            f"{{module: icpdas_i_7024, {UNIT}, watchdog: {{timeout_s: 30}}}}",
            "output: watchdog.timeout_s: 30 s is outside 0.1 to 25.5 s, what"
            " icpdas_i_7024 takes",
        ),
        (
            TCP,
            f"{{module: wago_750_554, {UNIT}, watchdog: {{timeout_s: 2, safe_mA: 5}}}}",
            "output: watchdog.safe_mA: wago_750_554 goes to 4 mA on time-out, and to"
            " nothing else such as 5 mA",
        ),
        (
            TCP,
            f"{{module: adam_6024, {UNIT}, watchdog: {{safe_mA: 5}}}}",
            "output: watchdog.safe_mA: adam_6024 has no safe value over modbus",
        ),
        (
            TCP,
            f"{{module: adam_6224, {UNIT}, watchdog: {{safe_mA: 3}}}}",
            "output: 3 mA is outside 4 to 20 mA, the range of adam_6224",
        ),
        (
            DCON,
            f"{{module: icpdas_i_7024, {UNIT}, watchdog: {{timeout_s: 0.24}}}}",
            "output: watchdog.timeout_s: 0.24 s is no whole number of steps of 0.1 s,"
            " in which icpdas_i_7024 counts; 0.2 s is",
        ),
        (
            DCON,
            f"{{module: icpdas_i_7024, {UNIT}, set_range: true}}",
            "output: set_range: the range of icpdas_i_7024 cannot be set over dcon",
        ),
        (
            TCP,
            f"{{module: waveshare_ao_8ch, {UNIT}, set_range: true}}",
            "output: set_range: the range of waveshare_ao_8ch cannot be set over",
        ),
        (
            f"{{{LINE}modbus}}",
            f"{{module: adam_4024, {UNIT}}}",
            'bus.protocol: "modbus" is unknown; there are: dcon, itv, rtu',
        ),
        (
            f"{{{LINE}rtu, baud: 9601}}",
            f"{{module: adam_4024, {UNIT}}}",
            "bus.baud: 9601 Bd is not one of 1200, ",
        ),
        (
            f"{{{LINE}rtu, checksum: true}}",
            f"{{module: adam_4024, {UNIT}}}",
            "bus.checksum: is for protocol dcon, not for rtu",
        ),
        (
            f"{{{LINE}itv, local_echo: true}}",
            "{module: smc_itv_rc}",
            "bus.local_echo: is for protocol rtu or dcon, not for itv",
        ),
        (
            "{serial: ttyS0, protocol: rtu}",
            f"{{module: adam_4024, {UNIT}}}",
            'bus.serial: "ttyS0" is not the path of a device, such as /dev/ttyS0',
        ),
        (
            f"{{{LINE}rtu, boud: 9600}}",
            f"{{module: adam_4024, {UNIT}}}",
            'bus.boud: is not a key here; did you mean "baud"?',
        ),
        (
            f"{{{LINE}rtu, parity: X}}",
            f"{{module: adam_4024, {UNIT}}}",
            'bus.parity: "X" is unknown; there are: E, N, O',
        ),
    ],
    ids=str,
)
def test_what_does_not_fit_together_is_refused(
    gripper: Load,
    refusal: Refusal,
    bus: str,
    output: str,
    complaint: str,
    tmp_path: Path,
) -> None:
    said = refusal(lambda _: gripper(bus, output), tmp_path)
    bare = [line.partition(": grippers.left.")[2] for line in said]
    assert any(line.startswith(complaint) for line in bare), said


def test_control_must_be_fast_enough_to_keep_a_watchdog(
    gripper: Load, refusal: Refusal, tmp_path: Path
) -> None:
    output = f"{{module: icpdas_i_7024, {UNIT}, watchdog: {{timeout_s: 0.5}}}}"
    assert gripper(DCON, output, "    rate_Hz: 8\n").rate == 8.0
    (said,) = refusal(lambda _: gripper(DCON, output, "    rate_Hz: 7\n"), tmp_path)
    assert "7 Hz is too slow for watchdog.timeout_s 0.5 s" in said


def test_a_valve_below_the_range_of_its_module_is_refused(
    gripper: Load, refusal: Refusal, write: Write, tmp_path: Path
) -> None:
    reference = shipped("models/reference.yaml").read_text(encoding="utf-8")
    model = write(
        "rig.yaml", reference.replace("current_mA: [4, 20]", "current_mA: [0, 20]")
    )
    text = settings(TCP, f"{{module: adam_6224, {UNIT}}}")
    old = str(shipped("models/reference.yaml"))
    path = write("low.yaml", text.replace(old, str(model)))
    (said,) = refusal(lambda file: load_settings(file, {}), path)
    assert "starts at 0 mA, adam_6224 drives from 4 mA" in said


def test_a_port_that_may_be_another_tomorrow_is_warned_of(
    gripper: Load, write: Write
) -> None:
    for port, warned in (("/dev/ttyUSB0", 1), ("/dev/ttyS0", 0)):
        bus = f"{{serial: {port}, protocol: rtu}}"
        text = settings(bus, f"{{module: adam_4024, {UNIT}}}")
        gripper(bus, f"{{module: adam_4024, {UNIT}}}")
        warnings = load_settings(write("own.yaml", text), {}).warnings
        assert len(warnings) == warned
        assert all("/dev/serial/by-id" in said for said in warnings)


def test_one_line_is_set_up_in_one_way(
    write: Write, refusal: Refusal, tmp_path: Path
) -> None:
    (tmp_path / "objects").mkdir()
    text = settings(RTU, f"{{module: adam_4024, {UNIT}}}")
    left = text[len("grippers:\n") : text.index("profiles:")]
    right = left.replace("left", "right").replace("channel: 0", "channel: 1")
    right = right.replace("rtu}", "rtu, baud: 19200}")
    path = write("own.yaml", text.replace("profiles:", f"{right}profiles:"))
    (said,) = refusal(lambda file: load_settings(file, {}), path)
    assert "baud 9600" in said
    assert "baud 19200" in said


OWN = """\
name: bench_supply
title: A home-made current source
kind: output
evidence: unverified
sources: [its maker]
channels: 2
power_on: 4 mA
ranges:
  4-20mA: {current_mA: [4, 20], counts: [400, 2000]}
modbus:
  values: {address: 0x0010, stride: 4, type: u16}
vectors:
  - {current_mA: 10.7, registers: [1070]}
"""


async def test_a_users_own_module_drives_its_registers(
    gripper: Load, write: Write
) -> None:
    write("modules/bench_supply.yaml", OWN)
    output = "{module: bench_supply, unit: 9, channel: 1}"
    wiring = gripper(TCP, output, "modules: modules\n").output
    device = Device(holding(0x14, 400))
    async with on_the_wire(device) as bus:
        rig = AnalogRig(bus, wiring, None)
        assert (await rig.read(0.0)).current.value == pytest.approx(0.004)
        await rig.write(0.0107)
    assert device.registers == holding(0x14, 1070)
    assert {request.unit for request in device.requests} == {9}
    assert "bench_supply: nobody has verified this description" in rig.warnings


def test_a_broken_module_that_nobody_names_is_refused_all_the_same(
    gripper: Load, write: Write, refusal: Refusal, tmp_path: Path
) -> None:
    write("modules/bench_supply.yaml", OWN.replace("1070", "1071"))
    output = f"{{module: adam_6224, {UNIT}}}"
    said = refusal(lambda _: gripper(TCP, output, "modules: modules\n"), tmp_path)
    assert said == [
        "modules/bench_supply.yaml:13: vectors[0]: 10.7 mA is 0x042E by the rest of"
        " the file, not 0x042F"
    ]


@pytest.mark.parametrize("folder", ["gone", "own.yaml", "7"])
def test_a_folder_of_modules_must_be_there(
    gripper: Load, refusal: Refusal, tmp_path: Path, folder: str
) -> None:
    output = f"{{module: adam_6224, {UNIT}}}"
    (said,) = refusal(lambda _: gripper(TCP, output, f"modules: {folder}\n"), tmp_path)
    assert said.startswith("own.yaml:7: modules: ")
