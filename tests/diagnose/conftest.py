import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from tests.diagnose.small import MODEL, recording, threshold

FEW = (
    "threshold_pressure",
    "coulomb_friction",
    "tapered_ends",
    "creep",
    "pressure_sensor_bias",
)


@pytest.fixture(scope="session")
def blank() -> Problem:
    """The small rig without anything hidden."""
    return problem_of(recording(), MODEL, {})


@pytest.fixture(scope="session")
def told() -> Diagnosis:
    """What is found where a threshold of 25 kPa is hidden, among five effects."""
    library = {name: EFFECTS[name] for name in FEW}
    return diagnose(recording(threshold(25.0)), MODEL, {}, library)
