"""The clock in an output module that runs while its host is silent."""

from collections.abc import Callable


class HostWatchdog:
    """Trips once the host has been silent for too long, and stays so.

    Parameters
    ----------
    now
        Time of the bench. [s]
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self.tripped = False
        self.timeout: float | None = None
        """None while it is not armed. [s]"""
        self._now = now
        self._heard = 0.0

    def arm(self, timeout: float) -> None:
        """Count from now on. [s]."""
        self.timeout = timeout
        self.hear()

    def disarm(self) -> None:
        """Count no more; a trip stays."""
        self.timeout = None

    def hear(self) -> None:
        """Note a sign of the host."""
        self._heard = self._now()

    @property
    def due(self) -> float | None:
        """When it trips, if nothing is heard; None while it is not armed. [s]."""
        return None if self.timeout is None else self._heard + self.timeout

    def trip(self) -> None:
        """Trip now; it counts again only once it was cleared and armed."""
        self.tripped = True
        self.disarm()

    def clear(self) -> None:
        """Forget a trip; the outputs stay where it has taken them."""
        self.tripped = False
