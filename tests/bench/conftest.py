from math import radians

import pytest

from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Chain, Linkage, Muscle, Regulator, StaticMuscle


@pytest.fixture(scope="session")
def chain() -> Chain:
    """The reference rig: the paper's muscle on the gripper chosen for it."""
    muscle = Muscle(
        rest_length=0.25,
        diameter=0.02,
        braid_angle=radians(25),
        wall_thickness=0.002,
        elastic_modulus=1.3e6,
        friction_coefficient=0.002,
    )
    return Chain(
        name="reference",
        static=StaticMuscle(muscle, (RubberElasticity(), BraidFriction())),
        regulator=Regulator(
            current_low=0.004,
            current_high=0.020,
            pressure_low=0.0,
            pressure_high=500e3,
        ),
        linkage=Linkage(
            open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0
        ),
    )
