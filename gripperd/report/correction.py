"""Picture of a correction: what it adds, and where it adds nothing."""

import numpy as np

from gripperd.diagnose.correction.offer import Offer
from gripperd.diagnose.correction.table import CorrectionMap, maps
from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.residuals.regressors import DIRECTION
from gripperd.model.track import Array
from gripperd.report.where import paint
from gripperd.reproduce.drawing import BLUE, INK, canvas
from gripperd.reproduce.picture import Picture

PLACES = 24
"""Along each quantity, at least."""
WAYS = {1.0: "contracting", -1.0: "extending"}


def picture(offer: Offer) -> Picture:
    """Draw what a correction adds, travelling either way where that matters."""
    found = offer.correction
    column = BY_QUANTITY[found.signal.value]
    drawn = maps(found, PLACES)
    values = [column.written(one.values) for one in drawn]
    known = np.abs(np.concatenate(values, axis=None))
    top = float(np.max(known[np.isfinite(known)], initial=0.0)) or 1.0
    drawing = canvas(9.0, 4.0)
    panels = drawing.subplots(1, len(drawn), sharey=True, squeeze=False)[0]
    for axes, one, seen in zip(panels, drawn, values, strict=True):
        x = one.axes[0].written(one.places[0])
        if len(one.axes) == 1:
            axes.axhline(0, color=INK, lw=0.8)
            axes.plot(x, seen, color=BLUE)
        else:
            edges = [_edges(x), _edges(one.axes[1].written(one.places[1]))]
            paint(axes, edges, seen, top)
            axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
        axes.set_xlabel(_label(one.axes[0]))
        axes.set_title(WAYS.get(one.held.get(DIRECTION, 0.0), ""))
    up = _label(drawn[0].axes[1] if len(drawn[0].axes) > 1 else column)
    panels[0].set_ylabel(up)
    unit = f" {column.unit}".rstrip()
    caption = (
        "What it adds to the prediction with the constants as they were fitted"
        f"{_held(drawn[0])}. Full colour:"
        f" {top:.3g}{unit}; orange adds, blue takes away, empty is outside the fence."
    )
    over = " and ".join(axis.quantity for axis in drawn[0].axes)
    alt = f"Map of the correction of the {found.signal.value} over {over}."
    title = f"Correction of the {found.signal.value}"
    return Picture(f"correction_{found.signal.value}", title, caption, alt, drawing)


def _edges(places: Array) -> Array:
    """Borders halfway between places."""
    half = (places[1] - places[0]) / 2
    return np.append(places - half, places[-1] + half)


def _held(drawn: CorrectionMap) -> str:
    held = [
        f"{one.quantity} {one.shown(value)}"
        for one, value in drawn.held.items()
        if one is not DIRECTION
    ]
    return f", at {', '.join(held)}" if held else ""


def _label(column: Column) -> str:
    return f"{column.quantity} [{column.unit or '-'}]"
