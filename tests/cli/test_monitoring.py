"""``gripperd bus monitor`` against a daemon that runs."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.daemon import (
    Daemon,
    document,
    gripperd,
    running_daemon,
    settings_file,
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("daemon")


@pytest.fixture(scope="module")
def daemon(folder: Path) -> Iterator[Daemon]:
    with running_daemon(folder) as daemon:
        yield daemon


def test_what_goes_over_the_bus_is_shown_decoded(daemon: Daemon, folder: Path) -> None:
    asked = (
        "bus",
        "monitor",
        "--count",
        "10",
        "--config",
        str(folder / "gripperd.yaml"),
    )
    said = gripperd(*asked, "--json")
    assert said.returncode == 0, said.stderr
    halves = [json.loads(line) for line in said.stdout.splitlines()]
    assert len(halves) == 20
    assert [half["direction"] for half in halves] == ["request", "reply"] * 10
    assert {half["unit"] for half in halves} == {1, 2}
    assert {half["error"] for half in halves} == {None}
    seen = {name: ma for half in halves for name, ma in half["current_mA"].items()}
    sensors = {"pressure", "opening", "grip"}
    assert seen.keys() == {"valve", *sensors, "enable", "estop"}
    # The jaws are open: 85 of 100 mm, on 4 to 20 mA.
    assert seen["opening"] == pytest.approx(4 + 16 * 0.85, abs=0.1)
    lines = gripperd(*asked).stdout.splitlines()
    assert len(lines) == 20
    # 17.6 mA, and the noise of the sensor.
    assert any(re.search(r"opening 17\.(5[5-9]|6[0-4])", line) for line in lines)


def test_a_bus_is_found_by_its_address(daemon: Daemon, folder: Path) -> None:
    host, port = daemon.bench
    config = str(folder / "gripperd.yaml")
    asked = ("bus", "monitor", "--count", "1", "--config", config)
    assert gripperd(*asked, "--tcp", f"{host}:{port}").returncode == 0
    wrong = gripperd(*asked, "--port", "/dev/ttyUSB9")
    assert wrong.returncode == 2
    assert f"{host}:{port} of g0" in wrong.stderr


def test_info_has_the_figures_of_every_bus(daemon: Daemon) -> None:
    (bus,) = document(f"{daemon.url}/v1/info")["buses"]
    host, port = daemon.bench
    assert (bus["name"], bus["grippers"], bus["up"]) == (f"{host}:{port}", ["g0"], True)
    replies = sum(each["replies"] for each in bus["latency"])
    assert 0 < replies <= bus["requests"]
    assert bus["latency"][-1]["up_to_ms"] is None
    assert bus["mean_latency_ms"] > 0


def test_without_a_daemon_there_is_nothing_to_see(tmp_path: Path) -> None:

    path = settings_file(tmp_path)
    said = gripperd("bus", "monitor", "--config", str(path))
    assert said.returncode == 1
    assert "the control process is not running" in said.stderr
