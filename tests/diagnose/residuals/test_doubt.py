"""How much of what a force is off comes from a pressure that is known no better."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.doubt import own_shares
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import MODEL
from tests.diagnose.sweep import noise

FAST, QUIET = 3e3, Noise(2.0, 0.0)
"""Noise of a pressure transmitter [Pa], and of a force cell [N]."""
BLADDERLESS = replace(MODEL, effects=())
"""Of it a force is pressure times area, to be had without the model."""
TIME = np.arange(0.0, 40.0, 0.1)


def _swings() -> Array:
    """A pressure that turns every second or so, at random. [Pa]."""
    rng = np.random.default_rng(5)
    waves = [
        40e3 * np.sin(2 * np.pi * (pace * TIME + rng.random()))
        for pace in (0.31, 0.53, 0.71, 0.97)
    ]
    return np.asarray(300e3 + sum(waves))


def _held() -> Array:
    """Two dwells with one step between. [Pa]."""
    return np.where(TIME < 20.0, 200e3, 400e3)


@pytest.fixture(scope="module")
def sweeps() -> dict[str, Course]:
    rng = np.random.default_rng(6)
    runs = [
        Run(
            name,
            {
                "time": start + TIME,
                "pressure": pressure + rng.normal(0.0, FAST, TIME.size),
                "contraction": 0.08 + rng.normal(0.0, 1e-5, TIME.size),
                "force": rng.normal(0.0, QUIET.std, TIME.size),
            },
        )
        for start, (name, pressure) in zip(
            (0.0, 100.0, 200.0),
            {"swings": _swings(), "held": _held(), "held again": _held()}.items(),
            strict=True,
        )
    ]
    found, _ = courses(Recording("both", "0" * 64, tuple(runs)), 0.2)
    return {course.run: course for course in found}


def _shares(
    sweeps: Mapping[str, Course], signal: Signal, noise: Noise = QUIET
) -> dict[str, Array]:
    every = np.ones(TIME.size, dtype=bool)
    blocks = [Block(place, signal, every) for place in range(len(sweeps))]
    noises = [noise] * len(blocks)
    found = own_shares(BLADDERLESS, list(sweeps.values()), blocks, noises)
    return dict(zip(sweeps, found, strict=True))


def test_swings_as_fast_as_samples_make_a_force_as_doubtful_as_it_is(
    sweeps: Mapping[str, Course],
) -> None:
    true, course = _swings(), sweeps["swings"]
    muscle = BLADDERLESS.muscle
    area = np.pi * muscle.diameter**2 / 4 * (
        3 * 0.92**2 / np.tan(muscle.braid_angle) ** 2
        - 1 / np.sin(muscle.braid_angle) ** 2
    )  # fmt: skip
    wrong = area * (course.level("pressure") - true)
    share = _shares(sweeps, Signal.FORCE)["swings"]
    told = np.sqrt(np.mean(QUIET.std**2 * (1 / share**2 - 1)))
    assert np.std(wrong) > QUIET.std
    # Waves are smoother than a trend that may turn at any sample.
    assert np.std(wrong) < told < 2 * np.std(wrong)


def test_a_dwell_is_known_well(sweeps: Mapping[str, Course]) -> None:
    share = _shares(sweeps, Signal.FORCE)["held"]
    assert share[np.abs(TIME - 20.0) > 1.0].min() > 0.8


def test_a_pressure_is_foretold_from_a_command_that_is_known(
    sweeps: Mapping[str, Course],
) -> None:
    assert (_shares(sweeps, Signal.PRESSURE)["swings"] == 1.0).all()


def test_where_all_is_as_doubtful_the_noise_holds_it_already(
    sweeps: Mapping[str, Course],
) -> None:
    alone = _shares({"swings": sweeps["swings"]}, Signal.FORCE)["swings"]
    assert np.median(alone) == pytest.approx(1.0)
    assert np.quantile(alone, 0.1) > 0.9


LOUD = 2e-3
"""Noise of a contraction: 0.6 mm on 300 mm. [-]"""


def _lengths(memory: float = 0.0) -> dict[str, Course]:
    """One pressure: a length that goes there and back, and one that is held."""
    rng = np.random.default_rng(7)
    way = 0.15 * (1 - np.abs(TIME / 20.0 - 1))
    runs = [
        Run(
            name,
            {
                "time": start + TIME,
                "pressure": np.full_like(TIME, 300e3),
                "contraction": length + noise(TIME.size, LOUD, seed, memory),
                "force": rng.normal(0.0, QUIET.std, TIME.size),
            },
        )
        for start, name, length, seed in (
            (0.0, "travels", way, 8),
            (100.0, "held", np.full_like(TIME, 0.08), 9),
        )
    ]
    found, _ = courses(Recording("loud", "0" * 64, tuple(runs)), 0.3)
    return {course.run: course for course in found}


def test_a_length_that_travels_makes_a_force_as_doubtful_as_its_slope() -> None:
    sweeps, muscle = _lengths(), BLADDERLESS.muscle
    way = 0.15 * (1 - np.abs(TIME / 20.0 - 1))
    # The slope of eq. (4) over the contraction.
    slope = 300e3 * np.pi * muscle.diameter**2 / 4 * (
        6 * (1 - way) / np.tan(muscle.braid_angle) ** 2
    )  # fmt: skip
    share = _shares(sweeps, Signal.FORCE)["travels"]
    told = QUIET.std * np.sqrt(1 / share**2 - 1)
    wrong = slope * (sweeps["travels"].level("length") - way)
    assert np.std(wrong) > 1.5 * QUIET.std
    assert np.std(wrong) < np.sqrt(np.mean(told**2)) < 1.4 * np.std(wrong)


@pytest.mark.parametrize(("memory", "least"), [(0.0, 0.9), (0.8, 0.85)])
def test_a_length_that_is_held_is_known_well(memory: float, least: float) -> None:
    assert _shares(_lengths(memory), Signal.FORCE)["held"].min() > least


def test_noise_of_a_length_that_lasts_makes_a_mean_of_forces_as_doubtful() -> None:
    """First-order noise that keeps r is root (1+r)/(1-r) times as loud in a mean."""
    sweeps, kept = _lengths(0.8), 0.8
    lasting = ((1 + kept) / (1 - kept)) ** 0.5

    def told(noise: Noise) -> float:
        share = _shares(sweeps, Signal.FORCE, noise)["travels"]
        return float(np.sqrt(np.mean(QUIET.std**2 * (1 / share**2 - 1))))

    as_lasting = Noise(QUIET.std, kept)
    assert told(QUIET) == pytest.approx(lasting * told(as_lasting), rel=0.25)
    assert as_lasting.lasting == pytest.approx(lasting)


def test_a_length_says_nothing_of_how_well_a_pressure_is_known() -> None:
    assert (_shares(_lengths(), Signal.PRESSURE)["travels"] == 1.0).all()
