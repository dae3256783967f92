"""The commands a person types, run for real."""

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.daemon import Daemon, gripperd, running_daemon


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    with running_daemon(tmp_path_factory.mktemp("daemon")) as daemon:
        yield daemon


def test_predict_gives_the_published_force() -> None:
    said = gripperd("predict", "--current", "10.7", "--diameter", "65")
    assert said.returncode == 0
    assert said.stdout.startswith("47.6 N per jaw, ± ")


def test_predict_inverts_itself() -> None:
    asked = gripperd("predict", "--force", "12", "--diameter", "58", "--json")
    current = json.loads(asked.stdout)["current_mA"]
    back = gripperd("predict", "--current", str(current), "--diameter", "58", "--json")
    assert json.loads(back.stdout)["force_N"] == pytest.approx(12, abs=0.01)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--current", "30", "--diameter", "65"], "30.00 mA is outside 4 to 20 mA"),
        (["--current", "10.7", "--diameter", "-41"], "-41 mm is not above 0 mm"),
        (["--current", "nan", "--diameter", "41"], "nan mA is not above 0 mA"),
        (["--diameter", "41"], "either --current in mA or --force in N"),
        (["--current", "10.7", "--diameter", "90"], "they open 85 mm"),
        (["--current", "10,7", "--diameter", "65"], "Invalid value for '--current'"),
    ],
)
def test_unusable_input_is_one_clear_message(
    arguments: list[str], complaint: str
) -> None:
    said = gripperd("predict", *arguments)
    assert said.returncode == 2
    assert complaint in said.stderr
    assert "Traceback" not in said.stderr


def test_the_shipped_configuration_is_usable() -> None:
    said = gripperd("config", "check")
    assert said.returncode == 0
    assert "gripper g0: model reference" in said.stdout


def test_a_grasp_from_the_command_line(daemon: Daemon) -> None:
    url = daemon.url
    httpx.put(f"{url}/v1/bench/object", json={"profile": "apple"}).raise_for_status()
    held = gripperd("grasp", "apple", "--current", "10.7", GRIPPERD_URL=url)
    assert held.returncode == 0, held.stderr
    assert held.stdout.startswith("held: 46.")
    shown = gripperd("status", GRIPPERD_URL=url)
    assert shown.stdout.startswith("g0: ready, holding")
    again = gripperd("grasp", "apple", GRIPPERD_URL=url)
    assert again.returncode == 1
    assert "apple is being held" in again.stderr
    assert "release first" in again.stderr
    stopped = gripperd("stop", GRIPPERD_URL=url)
    assert stopped.stdout == "stopping, holding\n"
    released = gripperd("release", "--json", GRIPPERD_URL=url)
    assert json.loads(released.stdout)["status"] == "succeeded"
    missed = gripperd("grasp", "apple", GRIPPERD_URL=url)
    assert missed.returncode == 1
    assert "no_object: the jaws closed without meeting an object" in missed.stdout


def test_without_a_daemon_it_says_so() -> None:
    said = gripperd("status", GRIPPERD_URL="http://127.0.0.1:9")
    assert said.returncode == 1
    assert "no daemon answers at http://127.0.0.1:9" in said.stderr


def test_reproduce_writes_a_page(tmp_path: Path) -> None:
    said = gripperd("reproduce", "--output", str(tmp_path / "paper"))
    assert said.returncode == 0, said.stderr
    assert (tmp_path / "paper" / "index.html").stat().st_size > 100_000
    assert "does not hold" in said.stdout
