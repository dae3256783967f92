import pytest

from gripperd.bench.object import BenchObject
from gripperd.errors import InputError


def test_an_object_without_weight_is_refused_in_the_unit_it_was_given() -> None:
    with pytest.raises(InputError, match=r"mass_g = 0: must be above 0") as refusal:
        BenchObject(
            diameter=0.041, stiffness=3e4, mass=0.0, friction=0.4, damage_force=35.0
        )
    assert refusal.value.key == "mass_g"


@pytest.mark.parametrize("diameter", [-0.01, float("nan"), float("inf")])
def test_a_size_that_is_none_is_refused(diameter: float) -> None:
    with pytest.raises(InputError, match="diameter_mm"):
        BenchObject(
            diameter=diameter, stiffness=3e4, mass=0.06, friction=0.4, damage_force=35.0
        )
