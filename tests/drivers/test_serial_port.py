import errno
import fcntl
import grp
import os
import pty
from pathlib import Path

import pytest

from gripperd.drivers.address import RtuAddress
from gripperd.drivers.serial_port import complaint, latency_timer, open_port
from gripperd.errors import LinkLost


def sysfs(folder: Path, timer: str) -> Path:
    device = folder / "class/tty/ttyUSB7/device"
    device.mkdir(parents=True)
    (device / "latency_timer").write_text(timer)
    return folder


def test_a_missing_port_names_its_path(tmp_path: Path) -> None:
    with pytest.raises(LinkLost, match=f"{tmp_path}/nothing does not exist"):
        open_port(RtuAddress(port=str(tmp_path / "nothing")))


def test_a_file_is_no_serial_port(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(LinkLost, match="file cannot be opened as a serial port"):
        open_port(RtuAddress(port=str(tmp_path / "file")))


def test_a_port_that_is_locked_is_in_use() -> None:
    master, slave = pty.openpty()
    fcntl.flock(slave, fcntl.LOCK_EX)
    path = os.ttyname(slave)
    with pytest.raises(LinkLost, match=f"{path} is in use by another program"):
        open_port(RtuAddress(port=path))
    os.close(master)
    os.close(slave)


def test_an_empty_port_and_a_gone_port_read_differently() -> None:
    master, slave = pty.openpty()
    port = open_port(RtuAddress(port=os.ttyname(slave)))
    with pytest.raises(BlockingIOError):
        os.read(port.fileno(), 1)
    os.close(master)
    os.close(slave)
    assert os.read(port.fileno(), 1) == b""
    port.close()


def test_who_lacks_the_permission_is_told_the_group(tmp_path: Path) -> None:
    port = tmp_path / "port"
    port.touch()
    group = grp.getgrgid(port.stat().st_gid).gr_name
    found = complaint(str(port), PermissionError(errno.EACCES, "Permission denied"))
    assert f"add this user to the group {group} (usermod -a -G {group} USER)" in found


def test_an_adapter_tells_its_latency_whatever_it_is_called(tmp_path: Path) -> None:
    adapter = tmp_path / "by-id"
    adapter.symlink_to(tmp_path / "ttyUSB7")
    assert latency_timer(str(adapter), sysfs(tmp_path, "16\n")) == 16


def test_a_port_without_a_latency_timer_has_none(tmp_path: Path) -> None:
    assert latency_timer("/dev/ttyS0", tmp_path) is None
    assert latency_timer("/dev/ttyUSB7", sysfs(tmp_path, "?\n")) is None
