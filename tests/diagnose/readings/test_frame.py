"""Muscles that are held by a frame, which may yield less than its reading is noisy."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.cutting import courses
from tests.diagnose.held import COMPLIANCE, SIZE, STEP, held, lengths, up_and_down
from tests.diagnose.sweep import noise, run


def test_the_length_goes_with_the_force_of_a_frame_that_yields() -> None:
    speed = COMPLIANCE * 1e3 / (STEP * SIZE / 2)
    for place, found in enumerate(courses(held(COMPLIANCE), 0.25)[0]):
        assert found.yields
        for name in ("contraction", "length"):
            off = found.level(name) - lengths(place, COMPLIANCE)
            # A mean over the sweep alone would be off by 9e-4 (rms).
            assert np.sqrt(np.mean(off**2)) < 1.5e-4
        rate = np.median(np.abs(found.rate("contraction")))
        assert rate == pytest.approx(speed, rel=0.15)
        assert not found.direction.any()


def test_of_a_rigid_frame_noise_moves_nothing() -> None:
    for found in courses(held(0.0), 0.25)[0]:
        assert not found.yields
        assert np.ptp(found.level("contraction")) == 0.0


def test_one_sweep_that_sets_out_on_its_way_is_no_frame_that_yields() -> None:
    """It is longer by 0.3 % for its first 2.5 s, while its force is least."""
    rigid = held(0.0)
    first, *others = rigid.runs
    late = np.where(first.columns["time"] < 2.5, -3e-3, 0.0)
    columns = {**first.columns, "contraction": first.columns["contraction"] + late}
    told = replace(rigid, runs=(replace(first, columns=columns), *others))
    assert not any(found.yields for found in courses(told, 0.25)[0])


def test_sweeps_that_all_go_to_their_length_first_have_no_frame_that_yields() -> None:
    """From 0.4 % off within 1 s, while their force is least."""
    rigid = held(0.0)
    told = []
    for one in rigid.runs:
        since = one.columns["time"] - one.columns["time"][0]
        there = one.columns["contraction"] - 4e-3 * np.maximum(1 - since, 0.0)
        told.append(replace(one, columns={**one.columns, "contraction": there}))
    found = courses(replace(rigid, runs=tuple(told)), 0.25)[0]
    assert not any(course.yields for course in found)


def test_a_clearance_that_is_read_well_is_not_made_a_spring() -> None:
    """Taken up by the first 100 N: 0.3 %, read to 0.003 %."""
    rigid = held(0.0)
    told = []
    for place, one in enumerate(rigid.runs):
        taken_up = 3e-3 * np.minimum(up_and_down() / 100.0, 1.0)
        read = lengths(place, 0.0) + taken_up + noise(SIZE, 3e-5, 40 + place)
        told.append(replace(one, columns={**one.columns, "contraction": read}))
    found = courses(replace(rigid, runs=tuple(told)), 0.25)[0]
    assert not any(course.yields for course in found)


def test_a_muscle_that_is_filled_before_it_travels_goes_with_its_force() -> None:
    """Up to 150 N in 6 s at one length, and then by 10 % of contraction."""
    place = np.arange(SIZE, dtype=float)
    force = np.interp(place, [0, SIZE // 2, SIZE], [0.0, 150.0, 75.0])
    moved = 0.1 * np.clip(2.0 * place / SIZE - 1.0, 0.0, 1.0)
    length = moved + COMPLIANCE * force
    filled = run(
        "filled",
        time=400.0 + STEP * place,
        pressure=np.minimum(5e2 * place, 6e4) + noise(SIZE, 1e3, 50),
        contraction=length + noise(SIZE, 8e-4, 51),
        force=force + noise(SIZE, 3.0, 52),
    )
    told = held(COMPLIANCE)
    course = courses(replace(told, runs=(*told.runs, filled)), 0.25)[0][-1]
    assert not course.yields
    gone, rate = course.level("contraction"), course.rate("contraction")
    assert gone[110] - gone[10] == pytest.approx(COMPLIANCE * 125.0, rel=0.1)
    assert np.median(rate[10:110]) == pytest.approx(COMPLIANCE * 25.0, rel=0.1)
    np.testing.assert_allclose(gone[:110], length[:110], atol=1e-4)
