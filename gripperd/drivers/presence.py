"""Whether a peer is there, as the log has it."""

import structlog

log = structlog.get_logger()


class Presence:
    """Logs that a peer answers, or that it is lost: once, until it is otherwise.

    Parameters
    ----------
    bus
        Address of the bus.
    """

    def __init__(self, bus: str) -> None:
        self._bus = bus
        self._there: bool | None = None

    def answers(self) -> None:
        """Note that something on the bus has answered."""
        if self._there is not True:
            log.info("bus answers", bus=self._bus)
        self._there = True

    def lost(self, cause: str) -> None:
        """Note that the connection is gone, or cannot be made."""
        if self._there is not False:
            log.warning("bus is lost", bus=self._bus, cause=cause)
        self._there = False
