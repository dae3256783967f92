"""Opening a serial port, and saying what a person can do when it does not open."""

import errno
import grp
import termios
from pathlib import Path

import serial

from gripperd.drivers.address import SerialAddress
from gripperd.errors import LinkLost

VMIN = 6
"""Place of the control characters in what `termios.tcgetattr` returns."""
IN_USE = "is in use by another program"
SYSFS = Path("/sys")
"""Where the kernel tells about its devices."""


def open_port(address: SerialAddress) -> serial.Serial:
    """Open and configure a port for this process alone; nothing waits on it.

    Raises
    ------
    LinkLost
        It is missing, busy, not permitted or no serial port.
    """
    try:
        port = serial.Serial(
            address.port,
            baudrate=address.baud,
            bytesize=address.data_bits,
            parity=address.parity,
            stopbits=address.stop_bits,
            timeout=0,
            exclusive=True,
        )
        _tell_hang_up_from_silence(port)
    except (OSError, ValueError, termios.error) as error:
        raise LinkLost(complaint(address.port, error)) from error
    return port


def _tell_hang_up_from_silence(port: serial.Serial) -> None:
    """Let a read of nothing raise, so that an empty read is a port that has gone.

    pyserial sets VMIN to 0, with which both read empty (termios(3)).
    """
    settings = termios.tcgetattr(port.fileno())
    settings[VMIN][termios.VMIN] = 1
    termios.tcsetattr(port.fileno(), termios.TCSANOW, settings)


def complaint(path: str, error: Exception) -> str:
    """What a person can do about a port that does not open."""
    number = getattr(error, "errno", None)
    if number == errno.ENOENT:
        return f"{path} does not exist; is the adapter plugged in?"
    if number == errno.EACCES:
        return f"{path} may not be opened: {_remedy(path)}"
    if number in {errno.EBUSY, errno.EWOULDBLOCK}:
        return f"{path} {IN_USE}"
    return f"{path} cannot be opened as a serial port: {error}"


def _remedy(path: str) -> str:
    try:
        group = grp.getgrgid(Path(path).stat().st_gid).gr_name
    except (OSError, KeyError):
        return "this user lacks the permission"
    return f"add this user to the group {group} (usermod -a -G {group} USER)"


def latency_timer(port: str, sysfs: Path) -> int | None:
    """How long a USB adapter gathers octets before it passes them on, if it says so.

    [ms]; FTDI adapters gather for 16 ms unless told otherwise (FTDI AN232B-04).
    """
    name = Path(port).resolve().name
    try:
        text = (sysfs / "class/tty" / name / "device/latency_timer").read_text()
        return int(text)
    except (OSError, ValueError):
        return None
