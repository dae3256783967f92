"""Tension that is not seen: a slack muscle, or a converter at its end."""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.fault import Fault
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.stretches import resolution, stretches
from gripperd.model.track import Array

FORCE = BY_QUANTITY["force"]
FEWEST_ZEROS = 3
"""Exact zeros that are no coincidence."""
SHORTEST = 10
"""Samples; a channel that is read more often than it converts repeats fewer."""
RESOLUTIONS = 10.0
"""Movement that the pressure asked for meanwhile, in steps of the force channel."""


def slack(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find forces of exactly 0 N where nothing is below: no tension, so censored."""
    zeros = {
        index: run.columns["force"] == 0.0
        for index, run in enumerate(runs)
        if run.has("force") and np.nanmin(run.columns["force"]) == 0.0
    }
    if sum(int(rows.sum()) for rows in zeros.values()) >= FEWEST_ZEROS:
        for index, rows in zeros.items():
            yield Fault(index, "force", rows, "no tension: exactly 0 N")


def ends_of_scale(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find forces that stay at the least or greatest value while pressure moves.

    A held muscle is asked for: a free one that lifts a weight pulls with one force.
    """
    pulled = [(index, run) for index, run in enumerate(runs) if run.has("force")]
    if not any(run.has("pressure") for _, run in pulled):
        return
    force = _all(runs, "force")
    span = np.ptp(force)
    moved = np.ptp(_all(runs, "pressure"))
    if span == 0.0 or moved == 0.0:
        return
    enough = RESOLUTIONS * resolution(force) * moved / span
    for end, name in ((force.min(), "floor"), (force.max(), "ceiling")):
        if not any(_stays(run, float(end), float(enough)) for _, run in pulled):
            continue
        reason = f"at the {name} of the channel, {FORCE.shown(float(end))}"
        for index, run in pulled:
            yield Fault(index, "force", run.columns["force"] == end, reason)


def _stays(run: Run, end: float, enough: float) -> bool:
    return any(
        stretch.value == end
        and stretch.travel(run, "pressure") >= enough
        and stretch.held(run)
        for stretch in stretches(run.columns["force"], SHORTEST)
    )


def _all(runs: Sequence[Run], quantity: str) -> Array:
    values = np.concatenate([run.columns.get(quantity, np.empty(0)) for run in runs])
    measured: Array = values[np.isfinite(values)]
    return measured
