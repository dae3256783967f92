"""What is known of a pressure in a band where a regulator sleeps."""

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.whitening import clock_of, innovations, law_of
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.dead_band import SAW, UNIFORM, within_band
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.cycled import cut
from tests.diagnose.small import REGULATOR
from tests.diagnose.sweep import noise, run

BAND = 30e3
QUIET = Noise(1e3, 0.0, drift=400.0, memory=50.0)


def _sleeping(command: Array, pressure: Array | None = None) -> Block:
    current = 0.004 + 0.016 * command / 500e3 + noise(command.size, 3e-6)
    read = command if pressure is None else pressure
    (course,) = cut(run(current=current, pressure=read))
    block = Block(0, Signal.PRESSURE, np.arange(command.size) % 6 != 3)
    return within_band(block, course, REGULATOR, QUIET, BAND)


def _correlation(block: Block, first: int, last: int) -> float:
    assert block.ages is not None
    return float(np.exp(block.ages[first] - block.ages[last]))


def test_it_is_as_likely_anywhere_in_the_band() -> None:
    known = _sleeping(np.full(60, 2e5)).noise
    assert known is not None
    spread = np.std(np.linspace(0.0, BAND, 100_001))
    assert spread == pytest.approx(UNIFORM * BAND, rel=1e-4)
    assert known.drift == pytest.approx(np.hypot(spread, 400.0), rel=1e-4)
    assert (known.std, known.correlation) == (1e3, 0.0)


def test_where_the_command_rests_it_stays_but_for_the_drift_of_the_sensor() -> None:
    block = _sleeping(np.full(100, 2e5))
    # Five of six samples are left; ten a second.
    assert _correlation(block, 0, 75) == pytest.approx(np.exp(-9.0 / 50.0), rel=0.01)


def test_it_forgets_as_a_saw_does_while_the_command_goes_on() -> None:
    block = _sleeping(np.linspace(0.0, 500e3, 1001))
    saw = (np.arange(100_000) % 1000) / 1000 - 0.4995
    # 500 Pa a sample: a tenth of the band in six, of which five are left.
    known = np.mean(saw * np.roll(saw, 100)) / np.mean(saw**2)
    assert _correlation(block, 400, 405) == pytest.approx(known, abs=0.1)


def test_a_command_that_was_not_read_at_first_makes_nothing_unknown() -> None:
    command = np.linspace(0.0, 500e3, 101)
    whole = _sleeping(command).ages
    command[[0, 1, 40]] = np.nan
    holed = _sleeping(command, command[2:].max() * np.ones(101)).ages
    assert whole is not None
    assert holed is not None
    # But for the way of the first two steps.
    lost = SAW * 2 * 5e3 / BAND
    assert (whole - holed)[-1] == pytest.approx(lost, rel=0.1)


def test_stairs_in_a_band_look_like_its_noise() -> None:
    """Of unit variance, whatever the speed; and a rest has but one level."""
    rng = np.random.default_rng(5)
    squares = []
    for speed in (2e3, 5e3, 12e3):
        command = 40e3 + speed * np.r_[np.arange(30), np.full(60, 30.0)]
        off = ((command - rng.uniform(0, BAND)) % BAND) - BAND / 2
        block = _sleeping(command)
        assert block.noise is not None
        time = 0.1 * np.arange(command.size)[block.good]
        left = (off + rng.normal(0.0, 1e3, command.size))[block.good]
        law = law_of(clock_of(time), block.noise, block.ages)
        squares.append(innovations(left[:, None], law).ravel() ** 2)
    assert np.mean(np.concatenate(squares)) == pytest.approx(1.0, abs=0.35)
