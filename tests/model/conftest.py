import math

import pytest
from hypothesis import settings

from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Chain, Linkage, Muscle, Regulator, StaticMuscle

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def muscle() -> Muscle:
    """The paper's muscle."""
    return Muscle(
        rest_length=0.250,
        diameter=0.020,
        braid_angle=math.radians(25),
        wall_thickness=0.002,
        elastic_modulus=1.3e6,
        friction_coefficient=0.002,
    )


@pytest.fixture(scope="session")
def static(muscle: Muscle) -> StaticMuscle:
    """The paper's static model with eq. (6) rebraced."""
    return StaticMuscle(muscle, (RubberElasticity(), BraidFriction()))


@pytest.fixture(scope="session")
def chain(static: StaticMuscle) -> Chain:
    """The reference rig."""
    return Chain(
        name="reference",
        static=static,
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
