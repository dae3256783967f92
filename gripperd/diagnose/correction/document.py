"""A correction as a document: what it depends on, how far it reaches, what it gives."""

from typing import TypeAlias

import numpy as np

from gripperd.diagnose.correction.offer import FENCE, Correction, Offer
from gripperd.diagnose.correction.table import CorrectionMap, maps
from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.verdict.key import number
from gripperd.model.track import Array

Document: TypeAlias = dict[str, object]

PLACES = 5
"""Along each quantity of a table, at least."""
RULE = (
    "nothing outside these ranges, nor where the posterior variance is above"
    f" {FENCE:g} of the prior"
)

ADDS_TO = "the prediction of the model with its constants as they were fitted"


def correction_document(offer: Offer) -> Document:
    """Write a correction in the units of its keys; a length of null is no dependence.

    What to add to the prediction of the model with its constants as they were fitted
    stands in ``tables``, null outside the fence. It is a smooth curve through what was
    measured, no physics.
    """
    found, worth = offer.correction, offer.worth
    column = BY_QUANTITY[found.signal.value]
    return {
        "signal": column.name,
        "unit": column.unit,
        "kernel": "squared exponential",
        "adds_to": ADDS_TO,
        "amplitude": number(found.amplitude / column.scale),
        "wander": number(found.wander / column.scale),
        "lengthscales": {
            one.name: None if length is None else number(length / one.scale)
            for one, length in zip(found.regressors, found.lengths, strict=True)
        },
        "fence": _fence(found),
        "heldout": {
            "rmse_without": number(worth.without / column.scale),
            "rmse_with": number(worth.corrected / column.scale),
            "gain": number(worth.gain / column.scale**2),
            "gain_std": number(worth.std / column.scale**2),
            "share_inside_fence": number(worth.inside),
        },
        "tables": [_table(one, column) for one in maps(found, PLACES)],
    }


def _fence(found: Correction) -> Document:
    ends = dict(zip(found.regressors, found.reach.T, strict=True))
    ends |= {one: np.array(held) for one, held in found.held.items()}
    ranges = {one.name: _numbers(one.written(end)) for one, end in ends.items()}
    return {"rule": RULE, "ranges": ranges}


def _table(drawn: CorrectionMap, column: Column) -> Document:
    return {
        **{
            axis.name: _numbers(axis.written(places))
            for axis, places in zip(drawn.axes, drawn.places, strict=True)
        },
        "held": {
            one.name: number((value - one.zero) / one.scale)
            for one, value in drawn.held.items()
        },
        "values": _rows(column.written(drawn.values)),
        "std": _rows(drawn.stds / column.scale),
    }


def _rows(values: Array) -> list[object]:
    return [_numbers(row) if row.ndim else number(float(row)) for row in values]


def _numbers(values: Array) -> list[float | None]:
    return [number(value) for value in values.tolist()]
