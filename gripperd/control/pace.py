"""The beat of a loop: absolute deadlines, and how well they were kept."""

from collections.abc import Awaitable, Callable

from gripperd.control.timing import Histogram, Timing


class Pace:
    """Deadlines a period apart.

    Parameters
    ----------
    period
        [s]
    now
        The monotonic clock. [s]
    """

    def __init__(self, period: float, now: Callable[[], float]) -> None:
        self.overruns = 0
        """Periods that took longer than they should."""
        self._target = period
        self._now = now
        self._periods, self._lateness = Histogram(), Histogram()
        self.begin()

    def begin(self) -> None:
        """Start the beat now."""
        self._started = self._deadline = self._now()

    async def next(self, until: Callable[[float], Awaitable[None]]) -> None:
        """Wait for the next deadline.

        After one that was missed the beat starts anew: what was not measured then
        cannot be made up for.

        Parameters
        ----------
        until
            Waits until a time. [s]
        """
        self._deadline += self._target
        if missed := self._now() > self._deadline:
            self.overruns += 1
        # Also after an overrun: whoever else is in this process has a turn, too.
        await until(self._deadline)
        started = self._now()
        self._lateness.add(max(started - self._deadline, 0.0))
        self._periods.add(started - self._started)
        self._started = started
        if missed:
            self._deadline = started

    def timing(self) -> Timing:
        """All so far."""
        return Timing(
            target=self._target,
            period=self._periods.read(),
            lateness=self._lateness.read(),
            overruns=self.overruns,
        )
