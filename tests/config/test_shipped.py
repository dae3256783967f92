from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.config import FailMode, load_chain, load_profile, load_settings, shipped
from gripperd.config.module_library import load_module
from gripperd.drivers.bus import TcpAddress

LOADERS: dict[str, Callable[[Path], object]] = {
    "": load_settings,
    "models": load_chain,
    "profiles": load_profile,
    "modules": load_module,
}
FILES = sorted(path for path in shipped().rglob("*") if path.is_file())


def test_something_is_shipped() -> None:
    assert {path.name for path in FILES} >= {"gripperd.yaml", "hardware.yaml"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_shipped_file_loads(path: Path) -> None:
    folder = "" if path.parent == shipped() else path.parent.name
    LOADERS[folder](path)


def test_the_example_for_hardware_waits_for_a_person() -> None:
    (gripper,) = load_settings(shipped("hardware.yaml"), {}).grippers.values()
    assert gripper.bus == TcpAddress(host="192.168.0.7", port=502, timeout=0.2)
    assert gripper.auto_enable is False
    assert gripper.fail_mode is FailMode.VENT
    assert gripper.rate == 10.0
