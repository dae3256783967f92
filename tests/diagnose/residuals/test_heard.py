"""How much of the noise of a length the force bears out."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.setup import problem_of
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, MUSCLE, altered, moments, nothing, recording

LOUD = 2e-3
TRAVELS, HELD = ("d", "e", "f"), ("vented", "a", "b", "c", "b2")


def _doubt(told: Recording, *runs: str, heard: bool = True) -> float:
    """One sigma of the length in some sweeps, as it looks or as it is taken for."""
    sweeps, _ = courses(told, MUSCLE.rest_length)
    found = problem_of(told, MODEL, {}).courses if heard else sweeps
    return float(
        np.mean([np.mean(one.doubt("length")) for one in found if one.run in runs])
    )


def test_a_noise_that_the_force_has_is_noise_of_the_length() -> None:
    rng = np.random.default_rng(21)

    def read(true: Array) -> Array:
        return true + rng.normal(0.0, LOUD, true.size)

    loud = altered(recording(nothing), moments(), "contraction", read)
    assert _doubt(loud, *TRAVELS) == pytest.approx(LOUD, rel=0.2)


def test_lengths_that_were_set_and_not_measured_have_none() -> None:
    """The steps between them are no noise, though no reading tells them apart."""
    whole = altered(recording(nothing), moments(), "contraction", lambda h: h.round(2))
    few = replace(whole, runs=tuple(run for run in whole.runs if run.name in HELD))
    # Lengths 0.08 apart, as if by steps (0.08 / root 12), in a mean of 60 to 100.
    assert _doubt(few, *HELD, heard=False) > 2e-3
    assert _doubt(few, *HELD) == 0.0
