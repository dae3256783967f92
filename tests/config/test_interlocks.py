from pathlib import Path

import pytest

from gripperd.config import load_settings, shipped
from gripperd.errors import ConfigError

FITTED = "enable: {channel: 3}\n      estop: {channel: 4}"


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
    ],
)
def test_a_contact_that_cannot_be_there_is_told(
    tmp_path: Path, interlocks: str, complaint: str
) -> None:
    text = shipped("gripperd.yaml").read_text()
    assert FITTED in text
    for name in ("models", "profiles"):
        text = text.replace(f": {name}", f": {shipped(name)}")
    path = tmp_path / "gripperd.yaml"
    path.write_text(text.replace(FITTED, interlocks))
    with pytest.raises(ConfigError, match=complaint) as error:
        load_settings(path, {})
    assert str(path) in str(error.value)
