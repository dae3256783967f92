from dataclasses import replace
from pathlib import Path

import pytest

from gripperd.config import GripperSettings, load_settings, shipped
from gripperd.config.zero_file import keep_zero, kept_zero
from gripperd.control.zero import UNTARED, Zero
from gripperd.protocol.live_zero import LoopScale

NOON = 1_770_000_000.0
DAY = 86400.0


@pytest.fixture(scope="module")
def gripper() -> GripperSettings:
    return load_settings(shipped("gripperd.yaml"), {}).grippers["g0"]


def with_span(gripper: GripperSettings, high: float) -> GripperSettings:
    assert gripper.input is not None
    grip = gripper.input.sensors["grip"]
    other = replace(grip, scale=LoopScale(value_low=0.0, value_high=high))
    sensors = {**gripper.input.sensors, "grip": other}
    return replace(gripper, input=replace(gripper.input, sensors=sensors))


def test_without_a_tare_nothing_is_said(
    tmp_path: Path, gripper: GripperSettings
) -> None:
    found = kept_zero(tmp_path, gripper, NOON)
    assert (found.zero, found.remark) == (UNTARED, None)


def test_a_zero_comes_back_as_it_was_taken(
    tmp_path: Path, gripper: GripperSettings
) -> None:
    zero = Zero(1.0 / 3.0, NOON + 0.25)
    keep_zero(tmp_path, gripper, zero)
    found = kept_zero(tmp_path, gripper, NOON + DAY)
    assert found.zero == zero
    assert found.remark == (
        "adopted the zero of the force sensor, 0.33 N, taken at 2026-02-02 02:40:00 UTC"
    )


def test_the_last_one_counts(tmp_path: Path, gripper: GripperSettings) -> None:
    for force in (1.0, 2.0):
        keep_zero(tmp_path, gripper, Zero(force, NOON))
    assert kept_zero(tmp_path, gripper, NOON).zero.force == 2.0


@pytest.mark.parametrize(
    ("later", "said"),
    [(8 * DAY, "8 days ago: tare again"), (-60.0, "yet to come: look at the clock")],
)
def test_a_stale_one_counts_and_is_told(
    tmp_path: Path, gripper: GripperSettings, later: float, said: str
) -> None:
    keep_zero(tmp_path, gripper, Zero(1.0, NOON))
    found = kept_zero(tmp_path, gripper, NOON + later)
    assert found.zero == Zero(1.0, NOON)
    assert said in (found.remark or "")


def test_that_of_another_sensor_does_not_count_and_is_told(
    tmp_path: Path, gripper: GripperSettings
) -> None:
    keep_zero(tmp_path, with_span(gripper, 50.0), Zero(1.0, NOON))
    found = kept_zero(tmp_path, gripper, NOON)
    assert found.zero == UNTARED
    assert "is not tared" in (found.remark or "")
    assert "0 to 50 N, not of channel 2" in (found.remark or "")


@pytest.mark.parametrize(
    ("was", "now", "said"),
    [
        ("zero_N: 1.0", "zero_N: 5.1", "zero_N"),
        ("zero_N: 1.0", "zero_N: .nan", "zero_N"),
        ("zero_N: 1.0", "zero: 1.0", "zero"),
        ("taken_at: ", "taken_at: x", "taken_at"),
        ("zero_N: 1.0", "\0", "zeros/g0.yaml"),
    ],
)
def test_one_that_was_damaged_does_not_count_and_is_told(
    tmp_path: Path, gripper: GripperSettings, was: str, now: str, said: str
) -> None:
    keep_zero(tmp_path, gripper, Zero(1.0, NOON))
    path = tmp_path / "zeros" / "g0.yaml"
    text = path.read_text()
    assert was in text
    path.write_text(text.replace(was, now))
    found = kept_zero(tmp_path, gripper, NOON)
    assert found.zero == UNTARED
    assert (found.remark or "").startswith("the force sensor is not tared: ")
    assert said in (found.remark or "")


def test_a_file_where_the_folder_should_be_is_told(
    tmp_path: Path, gripper: GripperSettings
) -> None:
    (tmp_path / "zeros").write_text("")
    found = kept_zero(tmp_path, gripper, NOON)
    assert found.zero == UNTARED
    assert "zeros/g0.yaml" in (found.remark or "")
    with pytest.raises(OSError, match="zeros"):
        keep_zero(tmp_path, gripper, Zero(1.0, NOON))
