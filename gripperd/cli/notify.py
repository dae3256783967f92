"""The readiness protocol of systemd, both ends.

References
----------
.. [1] sd_notify(3): datagrams of ``NAME=value`` lines to ``$NOTIFY_SOCKET``.
"""

import os
import socket
from collections.abc import Mapping
from pathlib import Path

import structlog

from gripperd.errors import ConfigError

VARIABLE = "NOTIFY_SOCKET"
REPORT_WITHIN = 5.0
"""How long a report waits for a listener that has no time; a sign of life never does.
[s]"""

log = structlog.get_logger()


def notify(**facts: str | int) -> None:
    """Tell whoever started this process; nobody is told when nobody asked.

    This process goes on when they are gone or do not listen: whether it is to end is
    for them to say. Signs of life are many, and nothing is logged of those.

    Parameters
    ----------
    facts
        Such as ``READY=1`` or ``STATUS="holding"``.
    """
    address = os.environ.get(VARIABLE)
    if not address:
        return
    # A leading @ stands for the abstract namespace.
    if address.startswith("@"):
        address = "\0" + address[1:]
    message = "\n".join(f"{name}={value}" for name, value in facts.items())
    sign_of_life = "WATCHDOG" in facts
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
            # A listener that is stalled must not stall who reports to it.
            sender.settimeout(0.0 if sign_of_life else REPORT_WITHIN)
            sender.connect(address)
            sender.sendall(message.encode())
    except OSError as error:
        if not sign_of_life:
            reason = error.strerror or str(error)
            log.warning("nobody hears the report", told=message, reason=reason)


def listen(path: Path) -> socket.socket:
    """Socket on which the processes started here report.

    Raises
    ------
    ConfigError
        Something else is in the way.
    """
    receiver = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        path.unlink(missing_ok=True)
        receiver.bind(str(path))
    except OSError as error:
        receiver.close()
        message = f"{path} cannot be listened on: {error.strerror or error}"
        raise ConfigError(message) from error
    receiver.setblocking(False)
    return receiver


def parse(datagram: bytes) -> Mapping[str, str]:
    r"""Facts in one datagram.

    >>> parse(b"READY=1\nADDRESS=127.0.0.1:15020")["ADDRESS"]
    '127.0.0.1:15020'
    """
    lines = (line.partition("=") for line in datagram.decode().splitlines())
    return {name: value for name, _, value in lines}
