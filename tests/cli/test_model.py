"""Versions of the model, from the command line and in a running daemon."""

import json
import os
import signal
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import pytest

from gripperd.config import Provenance, load_settings
from gripperd.config.lineage import Added, Gap, Recorded
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.model import StaticMuscle
from gripperd.store import Version, versions_of
from tests.daemon import (
    PATIENCE,
    children,
    document,
    gripperd,
    running_daemon,
    settings_file,
    until,
)

PREDICT = ("predict", "--current", "10.7", "--diameter", "65", "--json")
FRICTION = 20.0
"""Of the version under test: at a ratio of 4 it takes 5 N from each jaw. [N]"""

NEXT_START = "no control runs here; it goes by it from its next start"

Run = Callable[..., str]


def add_version(settings: Path) -> Version:
    loaded = load_settings(settings)
    versions = versions_of(loaded, loaded.grippers["g0"])
    base = versions.get(0).model
    effects = (*base.static.effects, CoulombFriction(magnitude=FRICTION))
    return versions.add(
        replace(base, static=StaticMuscle(base.static.muscle, effects)),
        parent=0,
        created_at=datetime(2026, 1, 31, 12, tzinfo=UTC),
        provenance=Provenance(
            program="0.1.0",
            recording=Recorded(name="cycles.csv", sha256="a" * 64),
            seed=1,
            effects=(
                Added(name="coulomb_friction", parameters={"magnitude_N": FRICTION}),
            ),
            refitted=(
                Added(
                    name="parameter:muscle.diameter_mm",
                    parameters={"diameter_mm": 20.1},
                ),
            ),
            gap=Gap(
                signal="force_N",
                unit="N",
                rmse_before=20.4,
                rmse_recalibrated=14.1,
                rmse_after=2.2,
                noise_floor=2.0,
            ),
        ),
    )


@pytest.fixture
def settings(tmp_path: Path) -> Path:
    path = settings_file(tmp_path)
    add_version(path)
    return path


@pytest.fixture
def run(settings: Path) -> Run:
    """What a command says, that must end well."""

    def said(*arguments: str) -> str:
        done = gripperd(*arguments, "--config", str(settings))
        assert done.returncode == 0, done.stderr
        return done.stdout

    return said


def test_versions_are_listed_with_what_they_closed(run: Run) -> None:
    assert run("model", "list").splitlines() == [
        "* 0  reference",
        "  1  reference-1",
        "     parent      0",
        "     created_at  2026-01-31T12:00:00+00:00",
        "     added       coulomb_friction",
        "     refitted    parameter:muscle.diameter_mm",
        "     gap         force_N: 20.4 -> 2.2 N, noise 2 N",
    ]
    found = json.loads(run("model", "list", "--json"))
    assert (found["active"], found["complaints"]) == (0, [])
    assert [one["name"] for one in found["versions"]] == ["reference", "reference-1"]
    listed = found["versions"][1]
    assert listed["parent"] == 0
    assert listed["added"] == ["coulomb_friction"]
    assert listed["refitted"] == ["parameter:muscle.diameter_mm"]


def test_a_version_is_shown_as_a_model_file(run: Run, tmp_path: Path) -> None:
    shown = tmp_path / "shown.yaml"
    shown.write_text(run("model", "show", "reference-1"))
    from_file = gripperd(*PREDICT, "--model", str(shown))
    run("model", "activate", "1")
    assert from_file.stdout == run(*PREDICT)
    document = json.loads(run("model", "show", "1", "--json"))
    assert document["effects"][-1] == {
        "name": "coulomb_friction",
        "magnitude_N": FRICTION,
        "distance": 0.0,
        "slip_per_s": 0.0,
        "seated_kPa": 0.0,
    }
    assert document["provenance"]["recording"]["name"] == "cycles.csv"


def test_versions_are_compared(run: Run) -> None:
    found = json.loads(run("model", "diff", "0", "1", "--json"))
    assert found["changes"] == [
        {"path": "effects.coulomb_friction", "before": None, "after": "present"},
        {
            "path": "effects.coulomb_friction.magnitude_N",
            "before": None,
            "after": FRICTION,
        },
        {
            "path": "effects.coulomb_friction.distance",
            "before": None,
            "after": 0.0,
        },
        {
            "path": "effects.coulomb_friction.slip_per_s",
            "before": None,
            "after": 0.0,
        },
        {
            "path": "effects.coulomb_friction.seated_kPa",
            "before": None,
            "after": 0.0,
        },
    ]
    table = run("model", "diff", "0", "1").splitlines()
    assert table[0].split() == ["what", "reference", "reference-1"]
    assert table[1].split() == ["effects.coulomb_friction", "-", "present"]
    assert table[2].split() == ["effects.coulomb_friction.magnitude_N", "-", "20"]
    assert max(map(len, table)) <= 80
    assert (
        run("model", "diff", "1", "1") == "reference-1 and reference-1 do not differ\n"
    )


def test_predictions_follow_the_active_version_and_back(run: Run) -> None:
    before = json.loads(run(*PREDICT))
    assert run("model", "activate", "1") == f"reference-1 is active\n{NEXT_START}\n"
    after = json.loads(run(*PREDICT))
    assert (before["model"], after["model"]) == ("reference", "reference-1")
    assert before["force_N"] - after["force_N"] == pytest.approx(FRICTION / 4, abs=2e-3)
    assert json.loads(run("model", "rollback", "--json")) == {
        "active": 0,
        "name": "reference",
        "taken_up": False,
    }
    assert json.loads(run(*PREDICT)) == before


@pytest.mark.parametrize(
    ("arguments", "status", "complaint"),
    [
        (["show", "7"], 2, "reference has no version '7'; there are: reference,"),
        (["rollback"], 1, "version 0 was the first; there is none before it"),
        (["list", "--gripper", "g1"], 2, "there is no gripper 'g1'; there are: g0"),
    ],
)
def test_what_cannot_be_done_is_one_clear_message(
    settings: Path, arguments: list[str], status: int, complaint: str
) -> None:
    said = gripperd("model", *arguments, "--config", str(settings))
    assert said.returncode == status
    assert complaint in said.stderr
    assert "Traceback" not in said.stderr


def test_a_damaged_active_version_stops_the_start_and_can_be_left(
    run: Run, settings: Path, tmp_path: Path
) -> None:
    run("model", "activate", "1")
    file = tmp_path / "state/models/reference/1.yaml"
    file.write_text(
        file.read_text().replace("magnitude_N: 20.0}", "magnitude_N: 25.0}")
    )
    said = gripperd("run", "--config", str(settings))
    assert said.returncode == 78
    assert f"{file}: is not as it was written" in said.stderr
    assert "'gripperd model rollback' goes back to the one before" in said.stderr
    assert run("model", "rollback") == f"reference is active\n{NEXT_START}\n"


def test_the_daemon_takes_up_a_version_at_once_and_keeps_it_while_it_holds(
    tmp_path: Path,
) -> None:
    add_version(settings_file(tmp_path))
    config = ("--config", str(tmp_path / "gripperd.yaml"))
    assert gripperd("model", "activate", "1", *config).returncode == 0
    with running_daemon(tmp_path) as daemon:
        url = daemon.url
        asked = {"current_mA": 10.7, "diameter_mm": 65}
        found = httpx.post(f"{url}/v1/predictions", json=asked, timeout=PATIENCE).json()
        assert found["model"] == "reference-1"
        told = gripperd("model", "activate", "0", *config)
        assert "the daemon that runs goes by it from now on" in told.stdout
        found = httpx.post(f"{url}/v1/predictions", json=asked, timeout=PATIENCE).json()
        assert found["model"] == "reference"
        assert document(f"{url}/v1/grippers/g0")["model"] == "reference"
        assert document(f"{url}/v1/info")["models"] == {"g0": "reference"}
        httpx.put(f"{url}/v1/bench/object", json={"profile": "apple"}, timeout=PATIENCE)
        held = gripperd("grasp", "apple", "--current", "10.7", GRIPPERD_URL=url)
        # The rig is the configured one: what the version adds is in the model alone.
        assert held.stdout.startswith("held: 46.")
        for command in (["activate", "1"], ["rollback"]):
            refused = gripperd("model", *command, *config)
            assert refused.returncode == 1
            assert "g0 is ready, holding: its model stays as it is" in refused.stderr
            assert "release first" in refused.stderr
        gripperd("release", GRIPPERD_URL=url)
        back = gripperd("model", "rollback", "--json", *config)
        assert json.loads(back.stdout) == {
            "active": 1,
            "name": "reference-1",
            "taken_up": True,
        }
        # Control that is started anew reads what was kept.
        control = children(daemon.process)["control"]
        os.kill(control, signal.SIGKILL)
        until(lambda: children(daemon.process).get("control", control) != control)
        until(lambda: _state(url).get("machine") == "ready")
        assert _state(url)["model"] == "reference-1"


def _state(url: str) -> dict[str, Any]:
    found: dict[str, Any] = document(f"{url}/v1/grippers/g0")
    return found
