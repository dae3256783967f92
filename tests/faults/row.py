"""One fault: what was done, what came of it, and how long that took."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A line of the table."""

    fault: str
    noticed: str
    """What tells of it; with a number in it, as it was."""
    took: tuple[float, ...] = ()
    """From the fault to that, of every try. [s]"""
    limit: float | None = None
    """The longest that is allowed. [s]"""

    @property
    def kept(self) -> bool:
        return self.limit is None or max(self.took, default=0.0) <= self.limit
