"""Whether a recording shows enough of the chain to be compared with a model."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.recording import Rejection, Run
from gripperd.errors import InputError
from gripperd.protocol.live_zero import BROKEN_ABOVE, BROKEN_BELOW
from gripperd.units import MILLI

LENGTHS = ("contraction", "length")
WAYS = (*LENGTHS, "opening")
LINKS = (
    (("current",), ("pressure",)),
    (("pressure",), WAYS, ("force",)),
    (LENGTHS, ("opening",)),
    (("force", "pressure"), WAYS, ("grip",)),
)
"""What must be measured together to compare one step of the chain: one of each."""
FEWEST = 20
"""Rows; fewer do not tell an effect from noise."""
PERCENT = 0.25
"""Share of the readings of contraction above 1, from which no sensor is broken: it is
told in percent, though rest length is held in up to three sweeps of four. So of the
current above what a loop can say. [-]"""
IN_AMPERE = 0.9
"""Share of readings that would be those of a loop in ampere. [-]"""


def require_ratio(source: str, runs: Sequence[Run]) -> None:
    """Refuse a contraction in percent, before what is left of it looks like a ratio.

    Raises
    ------
    InputError
        Telling how many of its readings are above 1.
    """
    told = [run.columns["contraction"] for run in runs if run.has("contraction")]
    above = sum(int((values > 1).sum()) for values in told)
    readings = sum(int(np.isfinite(values).sum()) for values in told)
    if above > PERCENT * readings:
        detail = (
            f"{source}: column contraction is above 1 in {above} of {readings}"
            " readings; it is a ratio, counted from the rest length: 0.1 for 10 %"
        )
        raise InputError(detail)


def require_milliamperes(source: str, runs: Sequence[Run]) -> None:
    """Refuse a current in percent or ampere, before it is taken for a broken loop.

    Raises
    ------
    InputError
        Telling how many of its readings no loop gives.
    """
    told = [run.columns["current"] for run in runs if run.has("current")]
    if not told:
        return
    readings = np.concatenate(told)
    readings = readings[np.isfinite(readings)]
    above = int((readings > BROKEN_ABOVE).sum())
    loop = (readings >= BROKEN_BELOW * MILLI) & (readings <= BROKEN_ABOVE * MILLI)
    if above > PERCENT * readings.size:
        said = f"above {BROKEN_ABOVE / MILLI:g} mA in {above} of {readings.size}"
        unit = "%"
    elif loop.sum() > IN_AMPERE * readings.size:
        # As many mA as a loop has A.
        said = f"below {BROKEN_ABOVE:g} mA in {int(loop.sum())} of {readings.size}"
        unit = "A"
    else:
        return
    detail = f"{source}: column current_mA is {said} readings; is it in {unit}?"
    raise InputError(detail)


def require_enough(
    source: str,
    runs: Sequence[Run],
    dropped: Sequence[Rejection],
    rejected: Sequence[Rejection],
) -> None:
    """Refuse a recording that links no two points of the chain often enough.

    Parameters
    ----------
    source
        The file.
    runs
        Screened.
    dropped
        Rows that are in none of them.
    rejected
        Readings of them that are not believed.

    Raises
    ------
    InputError
        Naming the columns that are missing, or how few rows are left.
    """
    left_out = _left_out((*dropped, *rejected))
    there = {key for run in runs for key in run.columns if run.has(key)}
    if not any(all(there.intersection(place) for place in link) for link in LINKS):
        named = ", ".join(BY_QUANTITY[key].name for key in sorted(there - {"time"}))
        choice = "; or ".join(" and ".join(map(_one_of, link)) for link in LINKS)
        detail = (
            f"{source}: what was measured ({named or 'nothing'}) links no two points "
            f"of the chain; needed at least: {choice}{left_out}"
        )
        raise InputError(detail)
    usable = sum(int(_linked(run).sum()) for run in runs)
    if usable < FEWEST:
        rows = sum(len(run) for run in runs) + sum(one.count for one in dropped)
        detail = (
            f"{source}: {usable} of {rows} rows are usable; needed at least "
            f"{FEWEST}{left_out}"
        )
        raise InputError(detail)


def _one_of(quantities: Sequence[str]) -> str:
    names = [BY_QUANTITY[quantity].name for quantity in quantities]
    return names[0] if len(names) == 1 else f"({' or '.join(names)})"


def _left_out(rejected: Sequence[Rejection]) -> str:
    counts: Counter[str] = Counter()
    for entry in rejected:
        counts[f"{entry.column} {entry.reason}"] += entry.count
    said = ", ".join(f"{count} times {what}" for what, count in counts.most_common(3))
    return f" (left out: {said})" if said else ""


def _linked(run: Run) -> NDArray[np.bool_]:
    """Rows in which at least one link is complete."""
    linked = np.zeros(len(run), dtype=np.bool_)
    for link in LINKS:
        linked |= np.all([_known(run, place) for place in link], axis=0)
    return linked


def _known(run: Run, place: Sequence[str]) -> NDArray[np.bool_]:
    """Rows in which one of some quantities was measured."""
    known = np.zeros(len(run), dtype=np.bool_)
    for key in place:
        if key in run.columns:
            known |= np.isfinite(run.columns[key])
    return known
