"""The command, run for real against modules on sockets and ptys."""

import json
from pathlib import Path
from typing import Any

import pytest

from gripperd.config import load_settings, shipped
from tests.drivers.far_end import Asked, FarEnd, plugged

from .rack import AI, AO, Image, Said, doctor, powered

SETTINGS = """\
grippers:
  g0:
    bus: {{tcp: "{address}", timeout_ms: 2000}}
    output: {{module: waveshare_ao_8ch, unit: 1, channel: 0}}
    input:
      module: waveshare_ai_8ch
      unit: 2
      pressure: {{channel: 0, current_mA: [4, 20], pressure_kPa: [0, 600]}}
      grip: {{channel: 2, current_mA: [4, 20], grip_N: [0, 100]}}
    model: {model}
    fail_mode: vent
profiles: {profiles}
"""


@pytest.fixture
def anyio_backend() -> tuple[str, dict[str, bool]]:
    """One loop is enough: what is tested runs in another process."""
    return "asyncio", {"use_uvloop": False}


def checks(said: Said) -> dict[tuple[str, str], dict[str, Any]]:
    found = json.loads(said.out)["checks"]
    return {(each["subject"], each["check"]): each for each in found}


def settings(folder: Path, address: str) -> Path:
    path = folder / "gripperd.yaml"
    model, profiles = shipped("models/reference.yaml"), shipped("profiles")
    path.write_text(SETTINGS.format(address=address, model=model, profiles=profiles))
    return path


async def test_it_says_who_is_there_and_nothing_is_written() -> None:
    async with powered({1: AO, 2: AI}) as rack:
        said = await doctor("--tcp", rack.address, "--units", "1-3", "--json")
        assert rack.writes == 0
    assert said.status == 0, said.err
    found = [
        (each["unit"], each["modules"], each["certainty"])
        for each in json.loads(said.out)["found"]
    ]
    assert found == [
        (1, ["waveshare_ao_8ch"], "likely"),
        (2, ["waveshare_ai_8ch"], "likely"),
    ]


async def test_it_says_beforehand_how_long_it_takes() -> None:
    async with powered({1: AO}) as rack:
        said = await doctor("--tcp", rack.address, "--units", "1-10")
    # Ten units, each half a second and the time to open the connection anew.
    assert "10 units" in said.err
    assert "only reads; at most 7 s" in said.err


async def test_what_no_description_fits_is_unknown() -> None:
    async with powered({1: {(4, 9000): 1}}) as rack:  # type: ignore[dict-item]
        said = await doctor("--tcp", rack.address, "--units", "1", "--json")
    assert said.status == 0
    (found,) = json.loads(said.out)["found"]
    assert (found["certainty"], found["modules"]) == ("unknown", [])


async def test_a_line_without_anybody_fails() -> None:
    async with powered({}) as rack:
        said = await doctor("--tcp", rack.address, "--units", "1-2", "--json")
    assert said.status == 1
    assert checks(said)[rack.address, "probe"]["said"] == "nobody answered"


async def test_a_port_that_is_not_there_fails_with_what_to_do(tmp_path: Path) -> None:
    port = str(tmp_path / "ttyUSB0")
    said = await doctor("--port", port, "--protocol", "rtu", "--units", "1")
    assert said.status == 1
    assert "is the adapter plugged in?" in said.out


async def test_a_broken_wire_is_found_and_the_rest_is_in_order(tmp_path: Path) -> None:
    async with powered({1: AO, 2: AI}) as rack:
        path = settings(tmp_path, rack.address)
        said = await doctor("--config", str(path), "--json")
        assert rack.writes == 0
    assert said.status == 1
    found = checks(said)
    verdicts = {
        check: each["verdict"] for (who, check), each in found.items() if who == "g0"
    }
    assert verdicts == {
        "model and output": "ok",
        "evidence of waveshare_ao_8ch": "ok",
        "evidence of waveshare_ai_8ch": "ok",
        "link": "ok",
        "set-point read-back": "ok",
        "output range": "not possible",
        "output status": "not possible",
        "watchdog": "warning",
        "safe value": "not possible",
        "input range": "ok",
        "loop of pressure": "ok",
        "loop of grip": "failed",
    }
    assert found["g0", "set-point read-back"]["said"] == "10.700 mA"
    assert found["g0", "loop of pressure"]["said"] == "8.000 mA"
    broken = found["g0", "loop of grip"]
    assert "0.000 mA is below 3.6 mA" in broken["said"]
    assert "channel 2" in broken["remedy"]


async def test_without_a_link_the_other_checks_are_not_possible(tmp_path: Path) -> None:
    said = await doctor("--config", str(settings(tmp_path, "127.0.0.1:1")), "--json")
    assert said.status == 1
    found = checks(said)
    assert found["g0", "link"]["verdict"] == "failed"
    assert "connection refused" in found["g0", "link"]["said"]
    assert found["g0", "watchdog"]["verdict"] == "not possible"


async def test_the_first_settings_are_usable_and_nothing_is_overwritten(
    tmp_path: Path,
) -> None:
    path = tmp_path / "first.yaml"
    async with powered({1: AO, 2: AI}) as rack:
        asked = ("--tcp", rack.address, "--units", "1-2", "--write", str(path))
        said = await doctor(*asked)
        assert said.status == 0, said.err
        written = path.read_text()
        path.write_text("mine")
        again = await doctor(*asked)
    assert again.status == 2
    assert "is there already" in again.err
    assert path.read_text() == "mine"
    path.write_text(written)
    gripper = load_settings(path, {}).grippers["g0"]
    assert (gripper.output.module.name, gripper.output.unit) == ("waveshare_ao_8ch", 1)
    assert gripper.input is not None
    assert (gripper.input.module.name, gripper.input.unit) == ("waveshare_ai_8ch", 2)
    assert not gripper.auto_enable


async def test_nothing_is_written_for_what_is_unknown(tmp_path: Path) -> None:
    path = tmp_path / "first.yaml"
    async with powered({2: AI}) as rack:
        said = await doctor(
            "--tcp", rack.address, "--units", "1-2", "--write", str(path)
        )
    assert said.status == 1
    assert "no output module was identified" in said.err
    assert not path.exists()


async def test_modules_on_a_serial_port_are_found(tmp_path: Path) -> None:
    units: dict[int, Image] = {1: AO, 2: AI}

    def behave(far: FarEnd, asked: Asked) -> None:
        held = units.get(asked.unit)
        if held is None:
            return
        function = asked.pdu[0]
        places = [(function, asked.address + n) for n in range(asked.value)]
        if not held.keys() >= set(places):
            far.reply(asked, bytes([function | 0x80, 2]))
            return
        values = (held[place].to_bytes(2, "big") for place in places)  # type: ignore[index]
        far.reply(asked, bytes([function, 2 * len(places)]) + b"".join(values))

    async with plugged(tmp_path / "tty") as far:
        far.behave = behave
        asked = ("--port", str(far.path), "--units", "1-3", "--baud", "9600")
        path = tmp_path / "first.yaml"
        said = await doctor(*asked, "--json", "--write", str(path))
        functions = {each.pdu[0] for each in far.asked}
    assert said.status == 0, said.err
    assert functions <= {1, 2, 3, 4}
    found = json.loads(said.out)["found"]
    assert [each["modules"] for each in found] == [
        ["waveshare_ao_8ch"],
        ["waveshare_ai_8ch"],
    ]
    bus = load_settings(path, {}).grippers["g0"].bus
    assert (bus.port, bus.baud) == (str(far.path), 9600)  # type: ignore[union-attr]


async def test_a_dcon_module_says_its_name(tmp_path: Path) -> None:
    async with plugged(tmp_path / "tty") as far:
        far.speak(b"\r", {b"$01M\r": b"!017024\r"})
        said = await doctor(
            *("--port", str(far.path), "--protocol", "dcon", "--units", "1-2"),
            *("--baud", "9600", "--json"),
        )
        heard = far.heard
    (found,) = json.loads(said.out)["found"]
    assert (found["modules"], found["certainty"]) == (["icpdas_i_7024"], "named")
    assert heard == b"$01M\r$02M\r"


async def test_a_dcon_module_without_a_name_is_not_guessed_at(tmp_path: Path) -> None:
    async with plugged(tmp_path / "tty") as far:
        answers = {
            b"$01M\r": b"?01\r",
            b"$01M0\r": b"?01\r",
            b"$016C0\r": b"?01\r",
            b"$0160\r": b"!01+04.000\r",
        }
        far.speak(b"\r", answers)
        said = await doctor(
            *("--port", str(far.path), "--protocol", "dcon", "--units", "1"),
            *("--baud", "9600", "--json"),
        )
        heard = set(far.heard.split(b"\r"))
    (found,) = json.loads(said.out)["found"]
    assert found["certainty"] == "ambiguous"
    assert {"icpdas_i_7024", "brainboxes_ed_560"} == set(found["modules"])
    # Lines that start with # could set an output.
    assert heard <= {line.rstrip(b"\r") for line in answers} | {b""}


async def test_an_echoing_line_is_noticed(tmp_path: Path) -> None:
    async with plugged(tmp_path / "tty") as far:
        far.speak(b"\r", {b"$01M\r": b"$01M\r!017024\r"})
        said = await doctor(
            *("--port", str(far.path), "--protocol", "dcon", "--units", "1"),
            *("--baud", "9600", "--json", "--write", str(tmp_path / "first.yaml")),
        )
    assert said.status == 0, said.err
    assert "local_echo: true" in (tmp_path / "first.yaml").read_text()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--tcp", "here"], "--tcp 'here' is not HOST:PORT"),
        (["--tcp", "h:1", "--units", "0-3"], "--units '0-3' is not a unit or a range"),
        (["--tcp", "h:1", "--port", "/dev/x"], "give --port or --tcp, not both"),
        (["--write", "x.yaml"], "--write needs --port or --tcp"),
    ],
)
async def test_wrong_use_is_one_clear_message(
    arguments: list[str], complaint: str
) -> None:
    said = await doctor(*arguments)
    assert said.status == 2
    assert complaint in said.err
    assert "Traceback" not in said.err
