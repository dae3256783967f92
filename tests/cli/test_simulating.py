"""``gripperd bench`` with modules on a line, as a shell runs it."""

import os
import re
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import serial
from pyModbusTCP.client import ModbusClient

from tests.daemon import START, gripperd, settings_file

PATIENT = 60.0
"""[s]"""


@contextmanager
def listening(folder: Path, *arguments: str) -> Iterator[str]:
    """A bench, and the line in which it says where it listens."""
    process = subprocess.Popen(
        [*START, "bench", "--config", str(settings_file(folder)), *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )
    assert process.stderr is not None
    try:
        lines = (line for line in process.stderr if "bench listens" in line)
        yield next(lines, "it ended")
    finally:
        process.terminate()
        process.wait(PATIENT)
        process.stderr.close()


def talk(port: Path, *lines: bytes) -> list[bytes]:
    with serial.Serial(str(port), timeout=PATIENT) as opened:
        answers = []
        for line in lines:
            opened.write(line)
            answers.append(opened.read_until(b"\r"))
        return answers


def test_an_i_7024_answers_on_a_pty(tmp_path: Path) -> None:
    port = tmp_path / "line"
    options = ("--module", "icpdas_i_7024:3", "--dcon", str(port), "--baud", "115200")
    with listening(tmp_path, *options) as said:
        assert f"dcon={port}" in said
        assert "baud=115200" in said
        assert "icpdas_i_7024 unit 3" in said
        assert talk(port, b"#030+10.700\r", b"$0360\r") == [b">\r", b"!03+10.700\r"]
    assert not port.is_symlink()


def test_an_object_lies_between_the_jaws(tmp_path: Path) -> None:
    port = tmp_path / "line"
    options = ("--module", "icpdas_i_7024", "--module", "adam_4017_plus:2")
    line = ("--dcon", str(port), "--baud", "115200", "--object", "apple")
    with listening(tmp_path, *options, *line):
        talk(port, b"#010+10.700\r")
        end, grip = time.monotonic() + PATIENT, 0.0
        # 47.6 N of 100 N at 10.7 mA: 11.6 mA, and 4 mA without the apple.
        while grip < 11.0 and time.monotonic() < end:
            (reply,) = talk(port, b"#02\r")
            grip = float(reply[15:22])
    assert grip == pytest.approx(11.6, abs=0.6)


def test_an_object_without_a_profile_is_refused(tmp_path: Path) -> None:
    said = gripperd("bench", "--config", str(settings_file(tmp_path)), "--object", "eg")
    assert said.returncode == 2
    assert "--object 'eg' is not a profile; there are: apple" in said.stderr


def test_faults_are_met_in_the_order_of_the_options(tmp_path: Path) -> None:
    port = tmp_path / "line"
    options = ("--module", "icpdas_i_7024", "--dcon", str(port))
    faults = ("--fault", "none", "--fault", "exception", "--fault", "watchdog_tripped")
    with listening(tmp_path, *options, *faults):
        answers = talk(port, *[b"#010+10.700\r"] * 4)
    assert answers == [b">\r", b"?01\r", b"!\r", b"!\r"]


def test_modules_of_ones_own_choice_answer_on_tcp(tmp_path: Path) -> None:
    options = ("--module", "adam_6224:1:0-20mA", "--module", "adam_6217")
    with listening(tmp_path, *options, "--tcp", "127.0.0.1:0") as said:
        found = re.search(r"modbus_tcp=127\.0\.0\.1:(\d+)", said)
        assert found is not None
        client = ModbusClient("127.0.0.1", int(found[1]), 1, timeout=PATIENT)
        try:
            assert client.write_single_register(0, 2191)
            assert client.read_holding_registers(200, 1) == [0x0182]
            client.unit_id = 2
            assert client.read_holding_registers(200, 1) == [0x0180]
        finally:
            client.close()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--module", "adam_6225"], 'did you mean "adam_6224"'),
        (["--module", "adam_6224:0"], '"0" is no unit'),
        (["--module", "adam_6224:1:0-10V"], "0-10V is not a range"),
        (["--module", "smc_itv_rc", "--rtu", "x"], "speaks itv, this line modbus"),
        (["--rtu", "x", "--dcon", "y"], "--rtu and --dcon are given"),
        (["--rtu", "x", "--tcp", "127.0.0.1:0"], "--tcp and --rtu are given"),
        (["--tcp", "127.0.0.1:0", "--checksum"], "--checksum is for --dcon"),
        (["--rtu", "x", "--baud", "0"], "baud = 0 Bd"),
        (["--fault", "lat"], 'did you mean "late"'),
        (["--fault", "late:delay=5"], "keys are code, delay_ms, unit, times"),
        (["--fault", "late:times=0"], "times = 0: must be 1 to 10000"),
        (["--fault-chance", "1.5"], "chance = 1.5: must be 0 to 1"),
    ],
)
def test_what_cannot_be_simulated_is_one_clear_line(
    tmp_path: Path, options: list[str], says: str
) -> None:
    settings = str(settings_file(tmp_path))
    ended = gripperd("bench", "--config", settings, *options)
    assert ended.returncode == 2
    assert says in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_description_of_ones_own_is_named_by_its_file(tmp_path: Path) -> None:
    mine = tmp_path / "mine.yaml"
    mine.write_text("name: mine\n")
    settings = str(settings_file(tmp_path))
    ended = gripperd("bench", "--config", settings, "--module", str(mine))
    assert ended.returncode == 78
    assert str(mine) in ended.stderr
