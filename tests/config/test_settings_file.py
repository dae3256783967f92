import pickle
from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.config import (
    BenchBus,
    BenchSettings,
    FailMode,
    Http,
    load_settings,
    reference_chain,
    shipped,
)
from gripperd.drivers.analog import SensorWiring
from gripperd.drivers.bus import TcpAddress
from gripperd.protocol.live_zero import LoopScale

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

GRIPPER = """\
grippers:
  left:
    bus: {tcp: "plc.local:502", timeout_ms: 250}
    output: {module: waveshare_ao_8ch, unit: 1, channel: 7}
    model: rig.yaml
    fail_mode: spring_close
    rate_Hz: 50
"""
RIG = """\
name: rig
muscle: {rest_length_mm: 120, diameter_mm: 10, braid_angle_deg: 30,
         wall_thickness_mm: 1, elastic_modulus_MPa: 2.5, friction_coefficient: 0.01}
valve: {current_mA: [4, 20], pressure_kPa: [0, 600]}
gripper: {open_width_mm: 60, width_per_contraction: 2.5, spring_preload_N: 30,
          spring_rate_N_per_mm: 0.5}
"""


@pytest.fixture
def settings_file(write: Write, tmp_path: Path) -> Path:
    """Settings in a folder of their own, with one model and no profiles."""
    (tmp_path / "objects").mkdir()
    write("rig.yaml", RIG)
    return write("own.yaml", GRIPPER + "profiles: objects\n")


def test_without_a_file_the_shipped_bench_is_driven_over_the_wire() -> None:
    settings = load_settings(None, {})
    (gripper,) = settings.grippers.values()
    assert settings.source == shipped("gripperd.yaml")
    assert settings.http == Http(host="127.0.0.1", port=8765)
    assert settings.bench == BenchSettings(
        host="127.0.0.1", port=15020, seed=1, noise=0.0005
    )
    assert sorted(settings.profiles) == ["apple", "grape", "peach", "raw_egg"]
    assert (gripper.name, gripper.bus, gripper.rate) == ("g0", BenchBus(), 100.0)
    assert (gripper.fail_mode, gripper.auto_enable) == (FailMode.FREEZE, True)
    assert gripper.chain == reference_chain()
    assert (gripper.output.unit, gripper.output.channel) == (1, 0)
    assert gripper.output.module.name == "waveshare_ao_8ch"
    assert gripper.input is not None
    assert (gripper.input.unit, gripper.input.module.name) == (2, "waveshare_ai_8ch")
    low, high = {"current_low": 0.004, "value_low": 0.0}, {"current_high": 0.02}
    assert gripper.input.sensors == {
        "pressure": SensorWiring(
            channel=0, scale=LoopScale(**low, **high, value_high=600e3)
        ),
        "opening": SensorWiring(
            channel=1, scale=LoopScale(**low, **high, value_high=0.1)
        ),
        "grip": SensorWiring(
            channel=2, scale=LoopScale(**low, **high, value_high=100.0)
        ),
        "enable": SensorWiring(
            channel=3, scale=LoopScale(**low, **high, value_high=1.0)
        ),
        "estop": SensorWiring(
            channel=4, scale=LoopScale(**low, **high, value_high=1.0)
        ),
    }


def test_a_gripper_may_have_no_sensors_and_keeps_its_defaults(
    settings_file: Path,
) -> None:
    settings = load_settings(settings_file, {})
    gripper = settings.grippers["left"]
    assert gripper.bus == TcpAddress(host="plc.local", port=502, timeout=0.25)
    assert gripper.input is None
    assert gripper.fail_mode is FailMode.SPRING_CLOSE
    assert gripper.auto_enable is False
    assert gripper.rate == 50.0
    assert gripper.chain.linkage.ratio == 2.5
    assert settings.http == Http(host="127.0.0.1", port=8765)
    assert settings.profiles == {}


def test_settings_survive_the_way_to_another_process() -> None:
    settings = load_settings(None, {})
    assert pickle.loads(pickle.dumps(settings)) == settings


def test_the_environment_may_name_the_file(settings_file: Path) -> None:
    environ = {"GRIPPERD_CONFIG": str(settings_file)}
    assert load_settings(None, environ).source == settings_file
    shipped_one = shipped("gripperd.yaml")
    assert load_settings(shipped_one, environ).source == shipped_one


def test_sockets_live_where_the_file_or_systemd_or_the_system_says(
    settings_file: Path,
) -> None:
    systemd = {"RUNTIME_DIRECTORY": "/run/gripperd:/run/other"}
    assert load_settings(settings_file, systemd).runtime_dir == Path("/run/gripperd")
    own = load_settings(settings_file, {}).runtime_dir
    assert own.name.startswith("gripperd-")
    assert own.is_absolute()
    settings_file.write_text(settings_file.read_text() + "runtime_dir: run\n")
    named = load_settings(settings_file, systemd).runtime_dir
    assert named == settings_file.parent / "run"


@pytest.mark.parametrize(
    ("address", "host", "port"),
    [
        ("127.0.0.1:0", "127.0.0.1", 0),
        ("[::1]:502", "::1", 502),
        ("gateway:65535", "gateway", 65535),
    ],
)
def test_an_address_is_a_host_and_a_port(
    settings_file: Path, address: str, host: str, port: int
) -> None:
    text = settings_file.read_text().replace("plc.local:502", address)
    settings_file.write_text(text)
    bus = load_settings(settings_file, {}).grippers["left"].bus
    assert bus == TcpAddress(host=host, port=port, timeout=0.25)


MODULE_HINT = 'did you mean "waveshare_ao_8ch"?'


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("rate_Hz: 50", "rate_Hz: 501", "rate_Hz: 501 Hz is above 500 Hz"),
        ("rate_Hz: 50", "rate_Hz: 0", "rate_Hz: 0 Hz is below 1 Hz"),
        ("rate_Hz: 50", "rate: 50", 'rate: is not a key here; did you mean "rate_Hz"?'),
        ("rate_Hz: 50", "auto_enable: yes", 'auto_enable: "yes" is not true or false'),
        ("timeout_ms: 250", "timeout_ms: 0", "bus.timeout_ms: 0 ms is not above 0 ms"),
        (
            "timeout_ms: 250",
            "timeout_s: 1",
            'bus.timeout_s: is not a key here; did you mean "timeout_ms"?',
        ),
        ('tcp: "plc.local:502", ', "", "bus.tcp: is missing"),
        (
            "plc.local:502",
            "plc.local:65536",
            'bus.tcp: "plc.local:65536" is not "host:port" with a port of 0 to 65535',
        ),
        (
            "plc.local:502",
            "plc.local",
            'bus.tcp: "plc.local" is not "host:port" with a port of 0 to 65535',
        ),
        (
            '{tcp: "plc.local:502", timeout_ms: 250}',
            "bensh",
            'bus: "bensh" is unknown; did you mean "bench"?',
        ),
        ("unit: 1", "unit: 0", "output.unit: 0 is below 1"),
        ("unit: 1", "unit: 248", "output.unit: 248 is above 247"),
        (
            "channel: 7",
            "channel: 8",
            "output.channel: channel 8 is not one of waveshare_ao_8ch: 0 to 7",
        ),
        ("channel: 7", "channel: -1", "output.channel: -1 is below 0"),
        (
            "waveshare_ao_8ch",
            "waveshare_ai_8ch",
            f'output.module: "waveshare_ai_8ch" is not an output module; {MODULE_HINT}',
        ),
        (
            "spring_close",
            "hold",
            'fail_mode: "hold" is unknown; there are: freeze, spring_close, vent',
        ),
        (
            "model: rig.yaml",
            "model: gone.yaml",
            'model: "gone.yaml" cannot be found from ',
        ),
        ("model: rig.yaml", "model: 3", "model: 3 cannot be found from "),
    ],
)
def test_a_bad_setting_is_refused_at_its_line(
    settings_file: Path, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    text = settings_file.read_text()
    assert text.count(good) == 1
    line = text[: text.index(good)].count("\n") + 1
    settings_file.write_text(text.replace(good, bad))
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == f"own.yaml:{line}: grippers.left.{complaint}"


SENSORS = """\
    input:
      module: waveshare_ai_8ch
      unit: 2
      pressure: {channel: 0, current_mA: [4, 20], pressure_kPa: [0, 600]}
      opening: {channel: 1, current_mA: [4, 20], opening_mm: [100, 0]}
"""


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        (
            "channel: 0",
            "channel: 9",
            ".pressure: channel 9 is not one of waveshare_ai_8ch",
        ),
        ("channel: 1", "channel: 0", ".opening: channel 0 is already that of pressure"),
        (
            "[4, 20], p",
            "[0, 20], p",
            ".pressure.current_mA[0]: 0 mA is below 3.6 mA",
        ),
        ("[100, 0]", "[5, 5]", ".opening.opening_mm: both ends are 5, so the values"),
        (
            "opening:",
            "openning:",
            '.openning: is not a key here; did you mean "opening"?',
        ),
        ("waveshare_ai", "waveshare_ao", '.module: "waveshare_ao_8ch" is not an input'),
    ],
)
def test_bad_wiring_of_a_sensor_is_refused_at_its_line(
    settings_file: Path, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    def settings(sensors: str) -> str:
        return f"{GRIPPER}{sensors}profiles: objects\n"

    settings_file.write_text(settings(SENSORS))
    wired = load_settings(settings_file, {}).grippers["left"].input
    assert wired is not None
    # A sensor may be mounted the other way round.
    assert wired.sensors["opening"].scale.value_low == 0.1
    assert SENSORS.count(good) == 1
    settings_file.write_text(settings(SENSORS.replace(good, bad)))
    line = (GRIPPER + SENSORS[: SENSORS.index(good)]).count("\n") + 1
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said.startswith(f"own.yaml:{line}: grippers.left.input{complaint}")


def test_two_grippers_never_drive_one_valve(
    settings_file: Path, refusal: Refusal
) -> None:
    text = GRIPPER + GRIPPER.removeprefix("grippers:\n").replace("left", "right")
    settings_file.write_text(text + "profiles: objects\n")
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:1: grippers: channel 7 of unit 1 on plc.local:502 is both"
        " the valve of left and the valve of right"
    )


def test_one_unit_is_one_module(settings_file: Path, refusal: Refusal) -> None:
    text = GRIPPER + SENSORS.replace("unit: 2", "unit: 1") + "profiles: objects\n"
    settings_file.write_text(text)
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:1: grippers: unit 1 on plc.local:502 is both waveshare_ao_8ch and"
        " waveshare_ai_8ch"
    )


def test_without_a_gripper_there_is_nothing_to_do(
    settings_file: Path, refusal: Refusal
) -> None:
    settings_file.write_text("grippers: {}\nprofiles: objects\n")
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == "own.yaml:1: grippers: is empty"


def test_everything_wrong_in_any_of_the_files_is_said_at_once(
    settings_file: Path, write: Write, refusal: Refusal
) -> None:
    settings_file.write_text(
        "http: {port: 70000}\n" + settings_file.read_text().replace("Hz: 50", "Hz: 0.5")
    )
    write("rig.yaml", RIG.replace("diameter_mm: 10", "diameter_mm: 300"))
    write("objects/pear.yaml", "- not a profile\n")
    said = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == [
        "own.yaml:1: http.port: 70000 is above 65535",
        "own.yaml:8: grippers.left.rate_Hz: 0.5 Hz is below 1 Hz",
        "rig.yaml:2: muscle.diameter_mm: 300 mm is above 200 mm",
        "objects/pear.yaml:1: a list of 1 is not a mapping of keys to values",
    ]


def test_a_missing_settings_file_is_named(refusal: Refusal, tmp_path: Path) -> None:
    said = refusal(lambda path: load_settings(path, {}), tmp_path / "gone.yaml")
    assert said == ["gone.yaml: there is no such file"]


def test_what_users_save_has_a_place_of_its_own(settings_file: Path) -> None:
    systemd = {"STATE_DIRECTORY": "/var/lib/gripperd:/var/lib/other"}
    assert load_settings(settings_file, systemd).state_dir == Path("/var/lib/gripperd")
    home = {"XDG_STATE_HOME": "/home/egg/.state"}
    found = load_settings(settings_file, home).state_dir
    assert found == Path("/home/egg/.state/gripperd")
    settings_file.write_text(settings_file.read_text() + "state_dir: kept\n")
    named = load_settings(settings_file, systemd).state_dir
    assert named == settings_file.parent / "kept"


def test_a_service_that_others_can_reach_is_refused(
    settings_file: Path, refusal: Refusal
) -> None:
    for host in ("0.0.0.0", "192.168.0.7", "gripper.local", "::"):
        settings_file.write_text(
            f'{GRIPPER}profiles: objects\nhttp: {{host: "{host}"}}\n'
        )
        (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
        assert said == (
            f'own.yaml:9: http.host: "{host}" is not a loopback address; access keys'
            " are not there yet: put a reverse proxy with authentication in front"
        )
    for host in ("localhost", "127.0.0.2", "::1"):
        settings_file.write_text(
            f'{GRIPPER}profiles: objects\nhttp: {{host: "{host}"}}\n'
        )
        assert load_settings(settings_file, {}).http.host == host


def test_one_bus_has_one_timeout(settings_file: Path, refusal: Refusal) -> None:
    right = GRIPPER.removeprefix("grippers:\n").replace("left", "right")
    right = right.replace("channel: 7", "channel: 6")
    settings_file.write_text(GRIPPER + right + "profiles: objects\n")
    assert len(load_settings(settings_file, {}).grippers) == 2
    right = right.replace("250", "300")
    settings_file.write_text(GRIPPER + right + "profiles: objects\n")
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:1: grippers: left.bus (plc.local:502, timeout_ms 250) and right.bus"
        " (plc.local:502, timeout_ms 300) are one line, plc.local:502: say the same of"
        " it in both"
    )


def test_a_valve_that_its_module_cannot_drive_is_refused(
    settings_file: Path, write: Write, refusal: Refusal
) -> None:
    write("rig.yaml", RIG.replace("current_mA: [4, 20]", "current_mA: [4, 21]"))
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:5: grippers.left.model: valve.current_mA ends at 21 mA,"
        " waveshare_ao_8ch drives up to 20 mA"
    )


ON_BENCH = GRIPPER.replace('{tcp: "plc.local:502", timeout_ms: 250}', "bench").replace(
    "channel: 7", "channel: 0"
)


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        (SENSORS, "", "2: grippers.left: no input is given; the bench has its sensors"),
        (
            "unit: 1, channel: 0",
            "unit: 1, channel: 3",
            "4: grippers.left.output: channel 3: the bench has its valve on channel 0",
        ),
        (
            "opening: {channel: 1",
            "opening: {channel: 2",
            "8: grippers.left.input: opening on channel 2: the bench has it on",
        ),
        ("      pressure: {channel: 0", "      pressure: {channel: 5", "8: grippers"),
    ],
)
def test_a_gripper_on_the_bench_is_wired_as_the_bench_is(
    settings_file: Path, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    text = f"{ON_BENCH}{SENSORS}profiles: objects\n"
    settings_file.write_text(text)
    assert load_settings(settings_file, {}).grippers["left"].bus == BenchBus()
    assert text.count(good) == 1
    settings_file.write_text(text.replace(good, bad))
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said.startswith(f"own.yaml:{complaint}")


def test_the_bench_is_one_rig(settings_file: Path, refusal: Refusal) -> None:
    left = ON_BENCH + SENSORS
    right = left.removeprefix("grippers:\n").replace("left", "right")
    settings_file.write_text(f"{left}{right}profiles: objects\n")
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:1: grippers: the bench is both the rig of left and the rig of right"
    )


def test_two_models_do_not_share_a_name(
    settings_file: Path, refusal: Refusal, write: Write
) -> None:
    right = GRIPPER.removeprefix("grippers:\n").replace("left", "right")
    right = right.replace("channel: 7", "channel: 6")
    settings_file.write_text(GRIPPER + right + "profiles: objects\n")
    assert len(load_settings(settings_file, {}).grippers) == 2
    write("other.yaml", RIG.replace("600", "500"))
    right = right.replace("rig.yaml", "other.yaml")
    settings_file.write_text(GRIPPER + right + "profiles: objects\n")
    (said,) = refusal(lambda path: load_settings(path, {}), settings_file)
    assert said == (
        "own.yaml:1: grippers: rig.yaml and other.yaml differ, both named rig"
    )
