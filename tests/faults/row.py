"""One fault: what was done, what came of it, and how long that took."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field


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
    came: Mapping[str, int] = field(default_factory=dict)
    """How often each thing came of it, where a time would say nothing."""
    wrong: tuple[str, ...] = ()
    """What may not happen, and did."""

    @property
    def tries(self) -> int:
        """How often it was done."""
        return len(self.took) or sum(self.came.values())

    @property
    def kept(self) -> bool:
        """Whether all was as it must be, in time."""
        in_time = self.limit is None or max(self.took, default=0.0) <= self.limit
        return in_time and not self.wrong


def counted(fault: str, outcomes: Iterable[str], allowed: Iterable[str]) -> Row:
    """Count what came of a fault; anything that is not allowed is wrong."""
    came = Counter(outcomes)
    wrong = tuple(sorted(set(came) - set(allowed)))
    told = ", ".join(f"{what} {count}" for what, count in sorted(came.items()))
    return Row(fault=fault, noticed=told, came=came, wrong=wrong)
