"""What no physics should explain is found, reported and left out."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.dropout import dropouts
from gripperd.diagnose.readings.edge import edges
from gripperd.diagnose.readings.fault import Check, Fault
from gripperd.diagnose.readings.floors import ends_of_pressure, ends_of_scale, slack
from gripperd.diagnose.readings.frozen import frozen
from gripperd.diagnose.readings.limits import beyond_limits
from gripperd.diagnose.readings.recording import Rejection, Run
from gripperd.diagnose.readings.spikes import spikes

CHECKS: tuple[Check, ...] = (
    beyond_limits, dropouts, slack, ends_of_scale, ends_of_pressure, frozen, spikes,
    edges,
)  # fmt: skip
"""In this order: each sees only what those before it believed."""


def screened(runs: Sequence[Run]) -> tuple[tuple[Run, ...], tuple[Rejection, ...]]:
    """Blank the readings that are not believed, and say why, each of them once.

    Returns
    -------
    The runs with NaN in place of these readings, and a report of them.
    """
    believed = tuple(runs)
    rejected: list[Rejection] = []
    for check in CHECKS:
        for fault in tuple(check(believed)):
            known = ~np.isnan(believed[fault.run].columns[fault.quantity])
            fresh = replace(fault, rows=fault.rows & known)
            if fresh.rows.any():
                believed = _without(believed, fresh)
                rejected.append(_report(believed, fresh))
    return believed, _summed(rejected)


def _without(runs: tuple[Run, ...], fault: Fault) -> tuple[Run, ...]:
    run = runs[fault.run]
    values = np.where(fault.rows, np.nan, run.columns[fault.quantity])
    columns = {**run.columns, fault.quantity: values}
    changed = replace(run, columns=columns)
    return (*runs[: fault.run], changed, *runs[fault.run + 1 :])


def _report(runs: Sequence[Run], fault: Fault) -> Rejection:
    return Rejection(
        run=runs[fault.run].name,
        column=BY_QUANTITY[fault.quantity].name,
        count=int(fault.rows.sum()),
        reason=fault.reason,
    )


def _summed(rejected: Sequence[Rejection]) -> tuple[Rejection, ...]:
    """Put what has one run, column and reason into one entry."""
    counts: dict[tuple[str, str, str], int] = {}
    for entry in rejected:
        key = (entry.run, entry.column, entry.reason)
        counts[key] = counts.get(key, 0) + entry.count
    return tuple(Rejection(*key[:2], count, key[2]) for key, count in counts.items())
