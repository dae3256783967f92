"""A quick search on the small rig, among three effects and with few constants open."""

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.threshold_pressure import ThresholdPressure
from tests.diagnose.small import MODEL, Hidden, pinned, recording

LISTED = (
    Candidate("threshold_pressure", ThresholdPressure(pressure=20e3)),
    Candidate("coulomb_friction", CoulombFriction(magnitude=20.0)),
    Candidate("force_sensor_bias", ForceSensorBias(bias=5.0)),
)
OPEN = ("muscle.diameter", "muscle.elastic_modulus", "zero.force")


def searched(hidden: Hidden, seed: int = 0) -> Found:
    """What is found where something is hidden."""
    problem = pinned(problem_of(recording(hidden), MODEL, {}), *OPEN)
    return search(problem, LISTED, np.random.default_rng(seed))
