"""A case is what it says it is, to the byte."""

import ast
import csv
from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.hidden_rig import ARTEFACTS, make_case
from tests.hidden_rig.campaign import Weather
from tests.hidden_rig.hidden import PLACES, TEXTBOOK, Hidden
from tests.hidden_rig.protocol import Sweep
from tests.hidden_rig.rig import Rig
from tests.hidden_rig.sensors import Noise, drift, noise
from tests.hidden_rig.truth import Bench, hide

HEADER = (
    "run,t_s,current_mA,pressure_kPa,contraction,force_N,opening_mm,grip_N,"
    "object_mm,temperature_C,supply_kPa,ambient_kPa"
)

SHORT = [
    Sweep("p", "isometric", (0, 3, 9, 15), (0, 20, 420, 20), (-0.01, 0.1, 0.1, 0.1)),
    Sweep(
        "h", "isobaric", (0, 2, 6, 9, 12), (0, 300, 300, 300, 300), (0, 0, 0.2, 0.1, 0)
    ),
    Sweep("s", "step", (0, 1, 12, 12.02, 30), (0, 0, 0, 380, 380), (0.05,) * 5),
    Sweep(
        "g", "grasp", (0, 3, 8, 12), (0, 280, 280, 0), object_size=0.05,
        object_stiffness=1e4,
    ),
]  # fmt: skip


def bench(family: str) -> Bench:
    day = Weather(warming=10.0, warm_up=60.0, ambient=1e5, sessions=(0.0, 1.0, -0.4))
    return Bench(family, Rig(), SHORT, np.full(4, 10.0), day, late="force_N")


def column(path: Path, name: str) -> np.ndarray:
    with path.open() as file:
        cells = [row[name] for row in csv.DictReader(file)]
    return np.array([float(cell) for cell in cells if cell])


def test_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    first = make_case(tmp_path / "1", seed=7, family="A", kind="single")
    again = make_case(tmp_path / "2", seed=7, family="A", kind="single")
    other = make_case(tmp_path / "3", seed=8, family="A", kind="single")
    for ours, theirs in zip(
        (first.recording, first.side_file, first.model, first.sealed),
        (again.recording, again.side_file, again.model, again.sealed),
        strict=True,
    ):
        assert ours.read_bytes() == theirs.read_bytes()
    assert other.recording.read_bytes() != first.recording.read_bytes()


@pytest.mark.parametrize("seed", range(4))
def test_a_recording_has_the_size_and_columns_agreed(tmp_path: Path, seed: int) -> None:
    case = make_case(tmp_path, seed=seed, family="A", kind="none")
    lines = case.recording.read_text().splitlines()
    assert lines[0] == HEADER
    assert 2_000 <= len(lines) - 1 <= 12_000
    runs = list(dict.fromkeys(line.split(",")[0] for line in lines[1:]))
    assert 12 <= len(runs) <= 18
    assert list(yaml.safe_load(case.side_file.read_text())["runs"]) == runs
    assert case.truth["effects"] == []


def test_a_rounded_sweep_stands_still_at_its_knots() -> None:
    sweep = Sweep("p", "isobaric", (0, 4, 8), (0, 300, 300), (0, 0.1, 0), rounded=True)
    since = np.array([0.0, 0.04, 2.0, 3.96, 4.0, 6.0, 8.0])
    # From rest to rest, half way at half time; 1 % of the time is 2.5e-4 of the way.
    np.testing.assert_allclose(
        sweep.contraction_at(since) / 0.1,
        [0, 2.5e-4, 0.5, 1 - 2.5e-4, 1, 0.5, 0],
        atol=1e-5,
    )
    np.testing.assert_allclose(sweep.pressure_at(since)[[2, 5]], [150, 300])


@pytest.mark.parametrize("family", ["A", "B"])
def test_every_effect_reaches_the_strength_asked_for(family: str) -> None:
    rig = bench(family)
    _, plain = rig.run(Hidden())
    for name, place in PLACES.items():
        if name in TEXTBOOK:
            continue
        hidden = hide(rig, {name: 0.03}, np.random.default_rng(1))
        course, changed = rig.run(hidden)
        signal = place.signal
        runs = (3,) if signal in ("opening_mm", "grip_N") else range(4)
        sizes = np.abs(changed[signal] - plain[signal])
        rows = [np.sort(sizes[course.run == run]) for run in runs]
        scale = 0.25 if signal == "contraction" else np.nanmax(np.abs(plain[signal]))
        reached = max(row[int(0.95 * row.size)] for row in rows) / scale
        assert reached == pytest.approx(0.03, rel=0.1), name


@pytest.mark.parametrize("family", ["A", "B"])
def test_an_effect_leaves_alone_what_lies_before_it(family: str) -> None:
    rig = bench(family)
    _, plain = rig.run(Hidden())
    for name, place in PLACES.items():
        _, changed = rig.run(Hidden()._replace(**{name: place.trial or 1.0}))
        touched = {
            key for key in plain if not np.array_equal(plain[key], changed[key], True)
        }
        if place.stage == "sensor":
            assert touched == {place.signal}, name
        elif place.stage != "valve":
            assert "pressure_kPa" not in touched, name


def test_noise_has_its_standard_deviation_and_correlation() -> None:
    drawn = noise(200_000, Noise(std=2.0, correlation=0.5), np.random.default_rng(3))
    assert drawn.std() == pytest.approx(2.0, rel=0.01)
    assert np.corrcoef(drawn[1:], drawn[:-1])[0, 1] == pytest.approx(0.5, abs=0.01)
    assert np.corrcoef(drawn[2:], drawn[:-2])[0, 1] == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize("kind", ["ou", "walk", "sinusoid"])
def test_drift_is_slow_and_as_large_as_stated(kind: str) -> None:
    model = Noise(1.0, 0.0, drift_std=2.0, drift_kind=kind, drift_memory=50.0)
    clock = np.arange(0.0, 1000.0, 0.1)
    wander = drift(clock, model, np.random.default_rng(5))
    assert wander.std() == pytest.approx(2.0, rel=0.02)
    assert np.abs(np.diff(wander)).max() < 0.2


def test_textbook_effects_are_missing_from_the_model_not_from_the_rig(
    tmp_path: Path,
) -> None:
    case = make_case(
        tmp_path, seed=1, family="A", kind="single", names=("rubber_elasticity",)
    )
    assert yaml.safe_load(case.model.read_text())["effects"] == ["braid_friction"]


@pytest.mark.parametrize("name", ARTEFACTS)
def test_an_artefact_shows_in_the_files(tmp_path: Path, name: str) -> None:
    case = make_case(tmp_path, seed=2, family="A", kind="artefact", names=(name,))
    force = column(case.recording, "force_N")
    if name == "slack_clipped":
        assert force.min() == 0.0
        assert np.mean(force == 0.0) > 0.02
    if name == "quantised_8bit":
        assert np.unique(np.round(force, 1)).size <= 511
    if name == "tight_tolerances":
        muscle = yaml.safe_load(case.model.read_text())["muscle"]
        stated = muscle["diameter_mm"]
        built = case.truth["rig"]
        assert isinstance(built, dict)
        off = abs(built["diameter"] * 1e3 - stated["value"])
        assert off == pytest.approx(3 * stated["tolerance"], rel=0.01)
    assert case.truth["artefacts"] == [name]


@pytest.mark.parametrize(
    ("name", "lag"), [("offset_80ms", 0.08), ("quantised_8bit", 0)]
)
def test_force_follows_pressure_after_the_offset(
    tmp_path: Path, name: str, lag: float
) -> None:
    case = make_case(tmp_path, seed=2, family="A", kind="artefact", names=(name,))
    with case.recording.open() as file:
        rows = list(csv.DictReader(file))
    keys = ("t_s", "pressure_kPa", "force_N", "contraction")
    lags = np.arange(-0.05, 0.16, 0.005)
    left = np.zeros(lags.size)
    for run in {row["run"] for row in rows if row["run"].startswith("isometric")}:
        readings = [[float(row[k]) for k in keys] for row in rows if row["run"] == run]
        clock, pressure, force, length = np.array(readings).T
        there = np.abs(length - length[-1]) < 0.002
        for k, late in enumerate(lags):
            told = np.interp(clock - late, clock, pressure)[there]
            line = np.polynomial.Polynomial.fit(told, force[there], 1)
            left[k] += np.sum((force[there] - line(told)) ** 2)
    assert lags[left.argmin()] == pytest.approx(lag, abs=0.02)


def test_the_rig_shares_no_code_with_what_it_examines() -> None:
    for path in Path(__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and node.module:
                names.append(node.module)
            assert not any(name.split(".")[0] == "gripperd" for name in names), path
