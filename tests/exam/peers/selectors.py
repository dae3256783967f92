"""Methods that choose among our effect columns."""

from collections.abc import Sequence

import numpy as np

from gripperd.model.track import Array
from tests.exam.peers.classes import families
from tests.exam.peers.columns import Columns, columns
from tests.exam.peers.exhibit import Exhibit, Guess
from tests.exam.peers.stlsq import stlsq

PURSUED = 4.0
"""Correlation with the whitened residual from which a column is taken. [sigma]"""
SPARSE = 8.0
"""Coefficient of a unit column below which STLSQ drops it. [sigma]"""


def pursuit(exhibit: Exhibit) -> Guess:
    """Take the one column that correlates best: orthogonal matching pursuit, one step.

    Y. C. Pati et al., "Orthogonal matching pursuit", Asilomar 1993.
    """
    known = columns(exhibit)
    table, target, _ = known.free
    scores = np.abs(table.T @ target)
    best = int(np.argmax(scores))
    return _guess(known, [best] if scores[best] > PURSUED else [])


def sparse(exhibit: Exhibit) -> Guess:
    """Drop columns with small coefficients again and again: STLSQ of PySINDy."""
    known = columns(exhibit)
    table, target, _ = known.free
    places = _leaders(known, np.abs(table.T @ target))
    sizes = np.abs(stlsq(table[:, places], target, SPARSE))
    order = np.argsort(-sizes)
    return _guess(known, [int(places[i]) for i in order if sizes[i] > 0])


def _leaders(known: Columns, scores: Array) -> list[int]:
    """Best column of each effect: several forms of one are almost collinear."""
    leaders: dict[str, int] = {}
    for place in np.argsort(-scores).tolist():
        if scores[place] > 0:
            leaders.setdefault(known.owners[place][0].name, place)
    return list(leaders.values())


def _guess(known: Columns, chosen: Sequence[int]) -> Guess:
    names = tuple(dict.fromkeys(known.owners[place][0].name for place in chosen))
    after = known.exhibit.remaining(known.explained(chosen))
    return Guess(names, families(names[0]) if names else frozenset(), after)
