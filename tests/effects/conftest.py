import math

import pytest
from hypothesis import settings

from gripperd.model import Muscle

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
