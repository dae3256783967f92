from pathlib import Path

import pytest

from gripperd.config import GripperSettings, load_settings, shipped
from gripperd.control.monitors.policy import POLICIES, Cause, Reaction
from gripperd.errors import ConfigError

FITTED = "enable: {channel: 3}\n      estop: {channel: 4}"


def settings(tmp_path: Path, interlocks: str) -> GripperSettings:
    text = shipped("gripperd.yaml").read_text()
    assert FITTED in text
    for name in ("models", "profiles"):
        text = text.replace(f": {name}", f": {shipped(name)}")
    path = tmp_path / "gripperd.yaml"
    path.write_text(text.replace(FITTED, interlocks))
    return load_settings(path, {}).grippers["g0"]


@pytest.mark.parametrize(
    ("interlocks", "complaint"),
    [
        ("estop: {channel: 2}", "estop: channel 2 is already that of grip"),
        ("estop: {channel: 9}", "estop: channel 9 is not one of waveshare_ai_8ch"),
        ("estop: {channel: 3}", "estop on channel 3: the bench has it on channel 4"),
        (
            "enable: {channel: 3}\n      estop: {channel: 3}",
            "estop: channel 3 is already that of enable",
        ),
        ("stop: {channel: 4}", "stop"),
        (
            "estop: {channel: 4, reaction: reduce}",
            "estop.reaction: an open contact says nothing of a force: hold, freeze,"
            " controlled_release, vent",
        ),
        ("estop: {channel: 4, reaction: open}", "estop.reaction"),
    ],
)
def test_a_contact_that_cannot_be_there_is_told(
    tmp_path: Path, interlocks: str, complaint: str
) -> None:
    with pytest.raises(ConfigError, match=complaint) as error:
        settings(tmp_path, interlocks)
    assert str(tmp_path / "gripperd.yaml") in str(error.value)


def test_an_open_contact_freezes_unless_told_otherwise(tmp_path: Path) -> None:
    found = settings(tmp_path, FITTED).policies
    for cause in (Cause.NOT_ENABLED, Cause.ESTOPPED):
        assert found[cause] == POLICIES[cause]
        assert found[cause].reaction is Reaction.FREEZE


def test_an_enable_that_lets_go_is_latched(tmp_path: Path) -> None:
    text = "enable: {channel: 3, reaction: vent}\n      estop: {channel: 4}"
    enable = settings(tmp_path, text).policies[Cause.NOT_ENABLED]
    assert (enable.reaction, enable.latched) == (Reaction.VENT, True)
    text = text.replace("vent", "hold")
    assert not settings(tmp_path, text).policies[Cause.NOT_ENABLED].latched
