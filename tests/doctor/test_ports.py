import os
import tty
from pathlib import Path

from gripperd.doctor.finding import Verdict
from gripperd.doctor.ports import serial_port


def system(folder: Path, latency_ms: str) -> tuple[Path, Path]:
    """A root with one adapter, and the adapter's device."""
    device = folder / "dev/ttyUSB0"
    for place in ("dev/serial/by-id", "sys/class/tty/ttyUSB0/device", "proc"):
        (folder / place).mkdir(parents=True)
    device.touch()
    (folder / "dev/serial/by-id/usb-FTDI_A50285BI").symlink_to(device)
    timer = folder / "sys/class/tty/ttyUSB0/device/latency_timer"
    timer.write_text(latency_ms)
    return folder, device


def test_a_port_goes_by_the_name_that_survives_a_restart(tmp_path: Path) -> None:
    root, device = system(tmp_path, "1\n")
    port = serial_port(device, root)
    assert port.path == str(root / "dev/serial/by-id/usb-FTDI_A50285BI")
    assert [each.result.verdict for each in port.findings] == [Verdict.OK, Verdict.OK]


def test_a_slow_adapter_is_a_warning(tmp_path: Path) -> None:
    root, device = system(tmp_path, "16\n")
    *_, latency = serial_port(device, root).findings
    assert latency.result.verdict is Verdict.WARNING
    assert "16 ms" in latency.result.said


def test_who_has_a_port_open_is_told() -> None:
    master, slave = os.openpty()
    tty.setraw(slave)
    try:
        port = serial_port(Path(os.ttyname(slave)))
        assert os.getpid() in port.users
        found = {each.check: each.result for each in port.findings}
        assert found["exclusive use"].verdict is Verdict.WARNING
    finally:
        os.close(master)
        os.close(slave)


def test_a_port_that_is_not_there_fails(tmp_path: Path) -> None:
    (permission,) = serial_port(tmp_path / "ttyUSB9").findings
    assert permission.result.verdict is Verdict.FAILED
    assert "is the adapter plugged in?" in permission.result.said
