"""What speaks against a recording itself: contradictions, and samples left out."""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.recording import Contradiction, Rejection
from gripperd.diagnose.verdict.figures import listed

SHOWN = 4
"""Sweeps named in a sentence."""


def contradicted(found: Contradiction, most: int = SHOWN) -> str:
    """Say what contradicts what, with so many sweeps by name on either side.

    Written as "force_N of a, b differs from that of c by 310 N at the same place".
    """
    runs, others = (_some(names, most) for names in (found.runs, found.others))
    said = (
        f"{found.column} of {runs} differs from that of {others} by"
        f" {abs(found.difference):.3g} {found.unit} at the same place"
    )
    if np.isfinite(found.spread):
        said += f", and repeats by {found.spread:.2g} {found.unit}"
    return said


def left_out(rejected: Sequence[Rejection]) -> list[str]:
    """Say what was left out, a line for each reason in a column.

    Written as "446 of force_N in a, b, c, d and 15 more, exactly 0 N".
    """
    groups: dict[tuple[str, str], list[Rejection]] = {}
    for one in rejected:
        groups.setdefault((one.column, one.reason), []).append(one)
    return [
        f"{sum(one.count for one in group)} of {column} in"
        f" {_some([one.run for one in group], SHOWN)}, {reason}"
        for (column, reason), group in groups.items()
    ]


def _some(names: Sequence[str], most: int) -> str:
    shown = list(names[:most])
    if more := len(names) - len(shown):
        shown.append(f"{more} more")
    return listed(shown)
