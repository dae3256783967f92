"""Muscles that are held by a frame, which may yield less than its reading is noisy."""

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run

SIZE = 240
STEP = 0.05
COMPLIANCE = 3e-6
"""A thousand newtons shorten the muscle by 0.3 %. [1/N]"""


def _up_and_down() -> Array:
    return np.interp(np.linspace(0.0, 2.0, SIZE), [0.0, 1.0, 2.0], [0.0, 1e3, 0.0])


def _sweep(force: Array, compliance: float) -> Course:
    """The second of three sweeps that are held; the others go up and down."""
    found = []
    for place, pull in enumerate((_up_and_down(), force, _up_and_down())):
        way = 0.04 + 0.02 * place + compliance * pull
        found.append(
            run(
                str(place),
                time=60.0 * place + STEP * np.linspace(0, SIZE - 1, SIZE),
                pressure=500.0 * pull + noise(SIZE, 1e3, 10 + place),
                contraction=way + noise(SIZE, 8e-4, 20 + place),
                force=pull + noise(SIZE, 3.0, 30 + place),
            )
        )
    return courses(Recording("held", "", tuple(found)), 0.25)[0][1]


def test_the_length_goes_with_the_force_of_a_frame_that_yields() -> None:
    force = _up_and_down()
    found = _sweep(force, COMPLIANCE)
    for name in ("contraction", "length"):
        off = found.level(name) - (0.06 + COMPLIANCE * force)
        # A mean over the sweep alone would be off by 9e-4 (rms).
        assert np.sqrt(np.mean(off**2)) < 1.5e-4
    speed = COMPLIANCE * 1e3 / (STEP * SIZE / 2)
    assert np.median(np.abs(found.rate("contraction"))) == pytest.approx(speed, rel=0.1)


def test_what_rubs_turns_round_with_it() -> None:
    found = _sweep(_up_and_down(), COMPLIANCE)
    middle = SIZE // 2
    assert np.all(found.direction[20 : middle - 10] == 1.0)
    assert np.all(found.direction[middle + 30 :] == -1.0)


def test_of_a_rigid_frame_noise_moves_nothing() -> None:
    found = _sweep(_up_and_down(), 0.0)
    assert np.ptp(found.level("contraction")) == 0.0
    assert not found.direction.any()


def test_under_a_steady_load_nothing_turns() -> None:
    force = np.full(SIZE, 700.0)
    force[: SIZE // 2] += 20.0
    found = _sweep(force, COMPLIANCE)
    assert not found.direction.any()
