"""Pictures of where a model is off, and of what is left once it is mended."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.model.track import Array
from gripperd.report.trace import (
    REGRESSORS,
    State,
    Trace,
    broken,
    elided,
    joined,
    level,
    stretches,
)
from gripperd.reproduce.drawing import BLUE, INK, MUTED, VERMILION, canvas
from gripperd.reproduce.picture import Picture

COLOURS = {
    State.NOMINAL: MUTED,
    State.RECALIBRATED: VERMILION,
    State.EXPLAINED: BLUE,
    State.NEAREST: BLUE,
}
CELLS = (22, 16)
"""Cells of a map, across and up."""
BINS = 30
"""Bins along a regressor."""
LEAST = 4
"""Samples of a bin that is shown."""
DOTS = 3000
"""Samples drawn over time; more would only make the page heavy."""
NAME = 0.04
"""Least distance of two names of sweeps, of the width."""
CLOCK = 0.07
"""Least distance of two times, of the width."""
LETTERS = 16
"""Letters of such a name; more would take the room of the picture."""
SATURATED = 98
"""Percentile of the means of the cells that has the full colour."""


def residual_map(found: tuple[Trace, ...], column: Column) -> Picture | None:
    """Mean residual by cell of two regressors, before and after."""
    axes_names = _two(found)
    if axes_names is None:
        return None
    across, up = axes_names
    x, y = level(found, across), level(found, up)
    edges = [_edges(values, count) for values, count in zip((x, y), CELLS, strict=True)]
    means = {
        state: _cells(x, y, joined(found, state), edges) for state in _shown(found)
    }
    top = float(
        np.nanpercentile(
            np.abs(np.concatenate([*means.values()], axis=None)), SATURATED
        )
    )
    drawing = canvas(9.0, 4.3)
    panels = drawing.subplots(1, len(means), sharey=True, squeeze=False)[0]
    for axes, state in zip(panels, means, strict=True):
        paint(axes, edges, means[state], top)
        axes.set_title(state.value)
        axes.set(xlabel=_label(across), xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    panels[0].set_ylabel(_label(up))
    unit = f" {column.unit}".rstrip()
    caption = (
        f"Mean of measured minus predicted in each cell. Full colour: {top:.3g}{unit};"
        " orange where the measurement is above the model, blue where it is below,"
        " empty where nothing was measured."
    )
    worst = max(means, key=lambda state: float(np.nanmax(np.abs(means[state]))))
    alt = (
        f"Maps of the residual over {across} and {up}; the strongest colour is in"
        f" the map of the model {worst.value}."
    )
    return Picture("map", "Where the model is off", caption, alt, drawing)


def over_time(found: tuple[Trace, ...], column: Column, floor: float) -> Picture:
    """Residual over the time of measurement, with the sweeps marked."""
    drawing = canvas(9.0, 3.6)
    axes = drawing.subplots()
    starts = np.cumsum([0.0, *(float(one.time[-1]) for one in found)])
    stride = max(1, sum(one.time.size for one in found) // DOTS)
    for one, start, end in zip(found, starts[:-1], starts[1:], strict=True):
        for left, right in _spans(one, float(end - start)):
            axes.axvspan(start + left, start + right, color=MUTED, alpha=0.12, lw=0)
        parts = stretches(one.time, stride)
        for state in _shown(found):
            axes.plot(
                start + broken(one.time, parts),
                broken(one.residual(state), parts),
                color=COLOURS[state],
                lw=0.9,
            )
    for edge in starts[1:-1]:
        axes.axvline(edge, color=MUTED, lw=0.5, alpha=0.6)
    _mark_runs(axes, found, starts)
    _noise(axes, floor)
    _legend(drawing, _shown(found))
    axes.set(
        xlabel="time of the recording, rests left out [s]",
        ylabel=_residual(column),
        xlim=(starts[0], starts[-1]),
    )
    caption = (
        "Measured minus predicted, sweep after sweep. What is grey took no part in the"
        " fit; lines are broken where samples are missing or passed over. The dotted"
        " lines are two standard deviations of the measurement itself."
        " Each sweep begins at the time below its left edge; where there is room, its"
        " name stands above."
    )
    alt = f"Residual over {starts[-1]:.0f} seconds in {len(found)} sweeps."
    return Picture("over_time", "Residual against time", caption, alt, drawing)


def _spans(one: Trace, whole: float) -> list[tuple[float, float]]:
    """Stretches of a sweep that took no part; all of it where no sample did. [s]."""
    if one.held_out.all():
        return [(0.0, whole)]
    edges = np.flatnonzero(np.diff(one.held_out, prepend=False, append=False))
    return [
        (float(one.time[first]), float(one.time[last - 1]))
        for first, last in edges.reshape(-1, 2).tolist()
    ]


def against_regressors(
    found: tuple[Trace, ...], column: Column, floor: float
) -> Picture:
    """Mean residual along everything it may depend on."""
    names = [name for name in REGRESSORS if _varies(level(found, name))]
    panels = [(_label(name), level(found, name)) for name in names]
    panels.append(
        ("time in the sweep [s]", np.concatenate([one.time for one in found]))
    )
    abreast = 2 if len(panels) == 4 else 3
    rows = -(-len(panels) // abreast)
    drawing = canvas(9.0, 2.8 * rows)
    grid = drawing.subplots(rows, abreast, sharey=True, squeeze=False)
    direction = np.concatenate([one.direction for one in found])
    for axes, (label, values) in zip(grid.flat, panels, strict=False):
        for state in _shown(found):
            residual = joined(found, state)
            for extends in (False, True):
                chosen = (direction < 0) == extends
                fill = "none" if extends else COLOURS[state]
                axes.plot(
                    *_means(values[chosen], residual[chosen]),
                    "o",
                    ms=3.6,
                    color=COLOURS[state],
                    markerfacecolor=fill,
                )
        _noise(axes, floor)
        axes.set_xlabel(label)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    for row in grid:
        row[0].set_ylabel(_residual(column))
    _legend(drawing, _shown(found))
    caption = (
        "Mean of measured minus predicted along each quantity: rings while the"
        " muscle extends, full dots otherwise. Dots on the line at 0 are a model"
        " that knows the quantity's part."
    )
    alt = f"Mean residual along {', '.join(names)} and time, before and after."
    return Picture("against", "Residual against each quantity", caption, alt, drawing)


def _two(found: tuple[Trace, ...]) -> tuple[str, str] | None:
    """Two regressors to map over: the driving one and, if possible, contraction."""
    varying = [name for name in REGRESSORS if _varies(level(found, name))]
    driving = next((n for n in ("pressure", "current") if n in varying), None)
    others = [n for n in ("contraction", "temperature", "current") if n in varying]
    others = [name for name in others if name != driving]
    return (driving, others[0]) if driving and others else None


def _varies(values: Array) -> bool:
    known = values[np.isfinite(values)]
    return known.size > 0 and float(np.ptp(known)) > 1e-9 * float(np.max(np.abs(known)))


def _edges(values: Array, count: int) -> Array:
    return np.linspace(float(np.nanmin(values)), float(np.nanmax(values)), count + 1)


def _cells(x: Array, y: Array, residual: Array, edges: Sequence[Array]) -> Array:
    """Mean of each cell, NaN where nothing fell, shape (across, up)."""
    good = np.isfinite(x) & np.isfinite(y)
    counts = np.histogram2d(x[good], y[good], edges)[0]
    sums = np.histogram2d(x[good], y[good], edges, weights=residual[good])[0]
    return np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)


def paint(axes: Axes, edges: Sequence[Array], means: Array, top: float) -> None:
    """Colour cells by sign and size; NaN stays empty."""
    corners, colours = [], []
    for i, (left, right) in enumerate(pairwise(edges[0])):
        for j, (low, high) in enumerate(pairwise(edges[1])):
            mean = float(means[i, j])
            if not np.isfinite(mean):
                continue
            corners.append([(left, low), (right, low), (right, high), (left, high)])
            # Strength as opacity, so that the page may be light or dark.
            alpha = 0.06 + 0.94 * min(abs(mean) / top, 1.0)
            colours.append(to_rgba(VERMILION if mean > 0 else BLUE, alpha))
    axes.add_collection(PolyCollection(corners, facecolors=colours, edgecolors="none"))
    axes.grid(visible=False)


def _means(values: Array, residual: Array) -> tuple[Array, Array]:
    """Means of a quantity and of the residual, bin by bin."""
    good = np.isfinite(values)
    if not good.any():
        return np.empty(0), np.empty(0)
    x, y = values[good], residual[good]
    place = np.digitize(x, np.linspace(x.min(), x.max(), BINS + 1)[1:-1])
    counts = np.bincount(place, minlength=BINS)
    there = counts >= LEAST
    means = [np.bincount(place, one, BINS)[there] / counts[there] for one in (x, y)]
    return means[0], means[1]


def _mark_runs(axes: Axes, found: tuple[Trace, ...], starts: Array) -> None:
    """Write when sweeps begin below them, and their names above."""
    top = axes.get_xaxis_transform()
    for index in spaced(starts[:-1], NAME * float(starts[-1])):
        axes.text(
            starts[index], 1.02, elided(found[index].run, LETTERS), transform=top,
            color=MUTED, fontsize=8, rotation=35, ha="left", va="bottom",
            parse_math=False,
        )  # fmt: skip
    shown = spaced(starts[:-1], CLOCK * float(starts[-1]))
    times = [f"{found[index].start:.0f}" for index in shown]
    axes.set_xticks(starts[shown], times)


def spaced(places: Array, least: float) -> list[int]:
    """Choose from the first place on, so that none is nearer than this to another."""
    chosen = [0]
    for index, place in enumerate(places):
        if place - places[chosen[-1]] >= least:
            chosen.append(index)
    return chosen


def _noise(axes: Axes, floor: float) -> None:
    axes.axhline(0, color=INK, lw=0.8)
    for edge in (-2 * floor, 2 * floor):
        axes.axhline(edge, color=MUTED, lw=0.9, ls=":")


def _shown(found: tuple[Trace, ...]) -> list[State]:
    return [state for state in found[0].expected if state is not State.NOMINAL]


def _legend(drawing: Figure, states: Sequence[State]) -> None:
    lines = [Line2D([], [], color=COLOURS[state], lw=2) for state in states]
    names = [state.value for state in states]
    drawing.legend(lines, names, loc="outside lower center", ncols=2, fontsize=9)


def _label(name: str) -> str:
    column = BY_QUANTITY[name]
    return f"{name} [{column.unit or '-'}]"


def _residual(column: Column) -> str:
    return f"measured - predicted [{column.unit or '-'}]"
