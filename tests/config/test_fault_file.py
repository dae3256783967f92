from pathlib import Path

import pytest

from gripperd.config.fault_file import keep_faults, kept_faults
from gripperd.control.fault import Fault
from gripperd.control.monitors.policy import Cause, Reaction
from gripperd.errors import ConfigError

BURST = Fault(
    id="f1",
    gripper="g0",
    cause=Cause.BURST,
    subject="",
    message="the muscle burst",
    reaction=Reaction.HOLD,
    latched=True,
    raised_at=1e9 + 1 / 3,
)
SEEN = Fault(
    id="f2",
    gripper="g0",
    cause=Cause.ESTOPPED,
    subject="found open",
    message='the emergency stop is pressed, or its wire is "cut"',
    reaction=Reaction.VENT,
    latched=True,
    raised_at=1e9,
    cleared_at=1e9 + 1,
    acknowledged_at=1e9 + 2,
    acknowledged_by="Åda",
)


def test_nothing_was_latched_before_the_first_start(tmp_path: Path) -> None:
    assert kept_faults(tmp_path, "g0") == ()


def test_what_is_latched_comes_back_as_it_was(tmp_path: Path) -> None:
    keep_faults(tmp_path, "g0", (BURST, SEEN))
    assert kept_faults(tmp_path, "g0") == (BURST, SEEN)
    assert kept_faults(tmp_path, "g1") == ()


def test_what_was_reset_does_not_come_back(tmp_path: Path) -> None:
    keep_faults(tmp_path, "g0", (BURST,))
    keep_faults(tmp_path, "g0", ())
    assert kept_faults(tmp_path, "g0") == ()


@pytest.mark.parametrize("content", [b"", b"[", b"\xff", b'[{"id": 1}]', b"{}"])
def test_a_file_that_is_not_ours_is_one_clear_line(
    tmp_path: Path, content: bytes
) -> None:
    (tmp_path / "faults").mkdir()
    (tmp_path / "faults" / "g0.json").write_bytes(content)
    with pytest.raises(ConfigError, match=r"faults/g0.json: is not as it was written"):
        kept_faults(tmp_path, "g0")


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    (tmp_path / "faults" / "g0.json").mkdir(parents=True)
    with pytest.raises(ConfigError, match=r"faults/g0.json: cannot be read"):
        kept_faults(tmp_path, "g0")
