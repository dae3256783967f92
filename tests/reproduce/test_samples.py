from dataclasses import replace

import pytest

from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.reproduce import SAMPLES, table_1


def test_the_samples_are_those_of_table_1() -> None:
    sizes = {sample.name: sample.diameter for sample in SAMPLES}
    assert sizes == {"apple": 0.065, "peach": 0.058, "raw egg": 0.041, "grape": 0.022}


def test_one_current_holds_all_four(chain: Chain) -> None:
    grips = [grasp.prediction.grip_force for grasp in table_1(chain)]
    assert grips == pytest.approx([47.6, 39.8, 22.5, 5.6], abs=0.05)
    assert all(grasp.sample.reported == "clamped" for grasp in table_1(chain))


def test_a_gripper_too_small_for_the_apple_says_so(chain: Chain) -> None:
    small = replace(chain, linkage=replace(chain.linkage, open_width=0.060))
    with pytest.raises(DomainError, match="65 mm does not fit"):
        table_1(small)
