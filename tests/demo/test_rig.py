import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from gripperd.demo.files import HEADER, write_rig
from gripperd.demo.hidden import Hidden
from gripperd.demo.programme import programmes
from gripperd.demo.rig import ANGLE, DIAMETER, Rig
from gripperd.errors import InputError


def rig(hidden: Hidden) -> Rig:
    return Rig(DIAMETER, ANGLE, 500e3, hidden)


def test_without_travel_nothing_of_the_loop_is_seen() -> None:
    time = np.arange(5.0)
    pressure = np.full(5, 400e3)
    pull = rig(Hidden.HYSTERESIS).force(time, pressure, np.zeros(5))
    # 400 kPa on 314.16 mm² of a 25 degree braid: 13.7968 - 5.5989 = 8.1979 times.
    assert pull == pytest.approx(400e3 * 3.14159265e-4 * 8.1979, rel=1e-4)


def test_creep_goes_on_after_a_step_and_comes_to_the_pull_of_the_braid() -> None:
    time = np.arange(0.0, 200.0, 0.5)
    pressure = np.where(time < 5, 0.0, 400e3)
    pull = rig(Hidden.CREEP).force(time, pressure, np.zeros_like(time))
    after = pull[time >= 5]
    assert (np.diff(after) > 0).all()
    # One step of 0.5 s after it: 1 - 0.025 exp(-0.5/2.5) - 0.03 exp(-0.5/20).
    assert after[0] == pytest.approx(0.95027 * after[-1], rel=1e-4)


def test_well_above_the_threshold_its_pressure_is_lost() -> None:
    hidden = rig(Hidden.THRESHOLD)
    one, other = hidden.force(
        np.arange(2.0), np.array([200e3, 218e3]), np.array([0.1, 0.1])
    )
    plain = rig(Hidden.HYSTERESIS).force(
        np.arange(2.0), np.array([182e3, 200e3]), np.array([0.1, 0.1])
    )
    assert [one, other] == pytest.approx(plain.tolist(), rel=1e-6)


def test_the_loop_remembers_which_way_the_muscle_went() -> None:
    way = np.concatenate([np.linspace(0, 0.16, 200), np.linspace(0.16, 0, 200)])
    pull = rig(Hidden.HYSTERESIS).force(np.arange(400.0), np.full(400, 3e5), way)
    # Same length, in the middle of either way: twice the half height of the loop.
    assert pull[300] - pull[99] == pytest.approx(2 * 22.0, abs=0.3)


def test_a_muscle_is_built_nearly_as_drawn() -> None:
    built = [Rig.built(Hidden.CREEP, np.random.default_rng(n)) for n in range(50)]
    off = [each.diameter / DIAMETER - 1 for each in built]
    assert max(map(abs, off)) <= 0.015 + 1e-12
    assert np.std(off) == pytest.approx(0.01, rel=0.3)


def test_the_noise_is_as_loud_as_stated() -> None:
    draws = np.random.default_rng(0)
    hold = next(one for one in programmes(0.002) if one.name == "hold_vented")
    force = rig(Hidden.CREEP).run(hold, draws).force
    assert np.std(force) == pytest.approx(3.0, rel=0.03)
    assert np.corrcoef(force[1:], force[:-1])[0, 1] == pytest.approx(0.3, abs=0.03)


def test_one_sweep_is_run_again() -> None:
    found = {one.name: one for one in programmes(0.2)}
    once, again = found["isobaric_1"], found["isobaric_1_again"]
    assert (once.contraction == again.contraction).all()
    assert (once.pressure == again.pressure).all()


def test_the_recording_is_one_a_person_could_have_made(tmp_path: Path) -> None:
    write_rig(tmp_path, Hidden.CREEP, 1)
    with (tmp_path / "rig.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert tuple(rows[0]) == HEADER
    assert 2000 < len(rows) < 3000
    times = [float(row[1]) for row in rows[1:]]
    assert all(one < other for one, other in pairwise(times))


def test_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        (tmp_path / name).mkdir()
        write_rig(tmp_path / name, Hidden.HYSTERESIS, seed, 0.5)
    one, same, other = ((tmp_path / n / "rig.csv").read_bytes() for n in "abc")
    assert one == same
    assert one != other


@pytest.mark.parametrize(
    "own", ["model.yaml", "rig.yaml", "rig.csv", "report.html", "diagnosis.json"]
)
def test_what_somebody_else_wrote_is_not_replaced(tmp_path: Path, own: str) -> None:
    (tmp_path / own).write_text("mine")
    with pytest.raises(InputError, match=f"{own}: is of no earlier demonstration"):
        write_rig(tmp_path, Hidden.CREEP, 1, 0.5)
    assert (tmp_path / own).read_text() == "mine"
    assert [one.name for one in tmp_path.iterdir()] == [own]


def test_a_model_that_was_edited_since_is_not_replaced(tmp_path: Path) -> None:
    write_rig(tmp_path, Hidden.CREEP, 1, 0.5)
    model, recording = tmp_path / "model.yaml", tmp_path / "rig.csv"
    edited = model.read_text().replace("diameter_mm: 20.0", "diameter_mm: 21.0")
    model.write_text(edited)
    before = recording.read_bytes()
    with pytest.raises(InputError, match=r"model\.yaml: is of no earlier") as refused:
        write_rig(tmp_path, Hidden.THRESHOLD, 2, 0.5)
    assert refused.value.key == "--out"
    assert model.read_text() == edited
    assert recording.read_bytes() == before


def test_a_demonstration_takes_the_place_of_an_earlier_one(tmp_path: Path) -> None:
    write_rig(tmp_path, Hidden.CREEP, 1, 0.5)
    before = (tmp_path / "rig.csv").read_bytes()
    write_rig(tmp_path, Hidden.THRESHOLD, 2, 0.5)
    assert (tmp_path / "rig.csv").read_bytes() != before
