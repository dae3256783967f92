"""What is not seen: a slack muscle, or more than a converter can tell."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.fault import Fault
from gripperd.diagnose.readings.frozen import noisy
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.stretches import resolution, stretches
from gripperd.model.track import Array

FORCE, PRESSURE = BY_QUANTITY["force"], BY_QUANTITY["pressure"]
FOLLOWED = ("current", "contraction", "length", "force")
"""What moves, one of them at least, while a pressure rises."""
GONE_ON = 0.05
"""Share of its range by which that moves at least. [-]"""
NOTHING = 0.02
"""Share of the highest pressure up to which a channel ends at no pressure. [-]"""
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


def ends_of_pressure(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find pressures that stay at an end of the channel while something else goes on.

    A supply that gives no more gives it with its noise. So a channel is asked for that
    is noisy between: of one that repeats itself nobody can tell. One that ends at
    nothing reads a vented muscle as it is.
    """
    pressure = _all(runs, "pressure")
    if not pressure.size:
        return
    low, high = float(pressure.min()), float(pressure.max())
    yield from _end(runs, high, "ceiling")
    if low > NOTHING * high:
        yield from _end(runs, low, "floor")


def _end(runs: Sequence[Run], end: float, name: str) -> Iterator[Fault]:
    read = [(index, run) for index, run in enumerate(runs) if run.has("pressure")]
    inside = np.concatenate([run.columns["pressure"] for _, run in read])
    if not noisy(inside[inside != end]):
        return
    enough = {
        name: GONE_ON * float(np.ptp(_all(runs, name)))
        for name in FOLLOWED
        if any(run.has(name) for run in runs)
    }
    if any(_goes_on(run, end, enough) for _, run in read):
        reason = f"at the {name} of the channel, {PRESSURE.shown(end)}"
        for index, run in read:
            yield Fault(index, "pressure", run.columns["pressure"] == end, reason)


def _goes_on(run: Run, end: float, enough: Mapping[str, float]) -> bool:
    return any(
        stretch.value == end and stretch.travel(run, name) > least
        for stretch in stretches(run.columns["pressure"], SHORTEST)
        for name, least in enough.items()
    )


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
