"""One constant of the muscle is off by more than its tolerance, the others hold."""

from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from tests.diagnose.small import MODEL, MUSCLE, recording

LIBRARY = {
    name: EFFECTS[name]
    for name in (
        "threshold_pressure", "tapered_ends", "nonlinear_elasticity", "creep",
        "coulomb_friction", "force_sensor_gain",
    )
}  # fmt: skip
SHARES = {
    "rest_length": 0.0025, "diameter": 0.006, "braid_angle": 0.006,
    "wall_thickness": 0.012, "elastic_modulus": 0.045, "friction_coefficient": 0.1,
}  # fmt: skip
"""Stated tolerances, of each constant itself. [-]"""
ANGLE, MODULUS = "parameter:muscle.braid_angle", "parameter:muscle.elastic_modulus"


def _told(name: str, off: float, seed: int) -> Diagnosis:
    """The rig is off by so many tolerances from what its model file says."""
    built = getattr(MUSCLE, name)
    believed = replace(MUSCLE, **{name: built * (1 - off * SHARES[name])})
    stated = {
        f"muscle.{one}": share * getattr(believed, one) for one, share in SHARES.items()
    }
    model = replace(MODEL, muscle=believed)
    return diagnose(recording(seed=seed), model, stated, LIBRARY)


@pytest.mark.parametrize("seed", range(1, 5))
def test_it_is_told_where_the_others_could_nearly_stand_in_for_it(seed: int) -> None:
    told = _told("braid_angle", -4.4, seed)
    assert told.verdict in (Verdict.NAMED, Verdict.AMBIGUOUS)
    assert told.named[0].name == ANGLE


@pytest.mark.parametrize("seed", range(1, 5))
def test_constants_hardly_beyond_two_tolerances_are_not(seed: int) -> None:
    for name, off in (("braid_angle", 2.3), ("diameter", -2.3)):
        assert _told(name, off, seed).verdict is Verdict.NONE


@pytest.mark.parametrize("seed", range(1, 5))
def test_of_two_that_explain_as_much_the_one_that_is_off_by_less_is_told(
    seed: int,
) -> None:
    """The wall would have to be off by 14 of its tolerances."""
    told = _told("elastic_modulus", -4.0, seed)
    assert told.named[0].name == MODULUS
