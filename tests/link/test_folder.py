import os
import socket
import stat
from pathlib import Path

import pytest

from gripperd.errors import ConfigError
from gripperd.link.folder import private_folder


def permissions(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_a_folder_is_made_for_the_user_alone(tmp_path: Path) -> None:
    private_folder(tmp_path / "a" / "run", "s")
    assert permissions(tmp_path / "a" / "run") == 0o700


def test_a_folder_that_others_may_enter_is_closed(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    folder.chmod(0o777)
    private_folder(folder, "s")
    assert permissions(folder) == 0o700


def test_a_link_is_not_followed(tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir(mode=0o755)
    (tmp_path / "run").symlink_to(elsewhere)
    with pytest.raises(ConfigError, match="run is not a directory; nor is a link"):
        private_folder(tmp_path / "run", "s")
    assert permissions(elsewhere) == 0o755


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("")
    with pytest.raises(ConfigError, match="run is not a directory"):
        private_folder(tmp_path / "run", "s")


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder away")
def test_a_folder_of_somebody_else_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir(mode=0o700)
    os.chown(folder, 12345, 12345)
    with pytest.raises(ConfigError, match="belongs to user 12345, not to 0"):
        private_folder(folder, "s")


def test_the_longest_path_is_what_the_system_takes(tmp_path: Path) -> None:
    folder = tmp_path / ("d" * (107 - len(os.fsencode(tmp_path)) - 3))
    private_folder(folder, "s")
    with socket.socket(socket.AF_UNIX) as fits:
        fits.bind(str(folder / "s"))
    with pytest.raises(ConfigError, match="would have 108 octets, at most 107"):
        private_folder(folder, "s", "so")
