from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.control.profile import Profile


def test_two_pads_carry_weight_and_acceleration(
    profiles: Mapping[str, Profile],
) -> None:
    # 2 · 0.5 · N = 0.180 kg · (9.80665 + 5) m/s².
    assert profiles["apple"].slip_force == pytest.approx(2.6652, abs=1e-4)


def test_a_smoother_pad_needs_more_force(profiles: Mapping[str, Profile]) -> None:
    apple = profiles["apple"]
    smooth = replace(apple, pad_friction=apple.pad_friction / 2)
    assert smooth.slip_force == pytest.approx(2 * apple.slip_force)


def test_the_model_sees_size_and_stiffness(profiles: Mapping[str, Profile]) -> None:
    pressed = profiles["raw_egg"].pressed
    assert (pressed.diameter, pressed.stiffness) == (0.041, 1e5)
