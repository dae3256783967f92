"""What of an effect is no curve of pressure and contraction, whatever its form.

References
----------
.. [1] R. Frisch, F. V. Waugh, "Partial time regressions as compared with individual
       trends", Econometrica 1(4), 387-401, 1933: what others explain is taken from
       what is asked for.
"""

from collections.abc import Sequence

import numpy as np
from numpy.polynomial.legendre import legvander2d

from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Effect
from gripperd.model.track import Array

DEGREE = 8
"""Of the polynomials that stand for any curve, in both together: 45 of them. [-]"""
FAINT = 0.02
"""Share of the largest sum of polynomials below which one is no curve: it follows what
little a pressure varies that is held, and tells the time by it. [-]"""
MISSED = 0.002
"""Share of a curve with a corner that they may miss, in squares. [-]"""


def beyond_curves(problem: Problem, point: Point, effect: Effect) -> float:
    """By how much likelier readings are with what of an effect no curve gives. [nat].

    In each signal any polynomial of pressure and contraction may take its place, so
    that nothing counts but the way by which a muscle came there: how near the form of
    an effect is to that of nature does not.

    Parameters
    ----------
    problem, point
        What was fitted, with the effect.
    effect
        One of those at the point.
    """
    given = problem.expected(problem.explanation(point))
    without = problem.expected(problem.explanation(point.without(effect.name)))
    along = size = whole = 0.0
    for signal in problem.signals:
        places = [
            place
            for place, block in enumerate(problem.blocks)
            if block.signal is signal and np.any(given[place] != without[place])
        ]
        if places:
            changes = [given[place] - without[place] for place in places]
            left = [problem.measured[place] - without[place] for place in places]
            plain, own, rest = _beside_curves(problem, places, changes, left)
            whole += float(plain @ plain)
            along += float(own @ rest)
            size += float(own @ own)
    gain = max(along, 0.0) ** 2 / size if size else 0.0
    return 0.5 * (gain - MISSED * whole)


def _beside_curves(
    problem: Problem,
    places: Sequence[int],
    changes: Sequence[Array],
    left: Sequence[Array],
) -> tuple[Array, Array, Array]:
    """Whitened changes of some blocks; those and residuals less what a curve gives."""
    curves = _curves(
        *(
            [
                problem.courses[block.course].level(name)[block.good]
                for block in (problem.blocks[place] for place in places)
            ]
            for name in ("pressure", "contraction")
        )
    )
    white = np.concatenate(
        [
            problem.white([change, rest, *curve.T], place)
            for place, change, rest, curve in zip(
                places, changes, left, curves, strict=True
            )
        ]
    )
    basis, sizes, _ = np.linalg.svd(white[:, 2:], full_matrices=False)
    basis = basis[:, sizes > FAINT * sizes[0]]
    both = white[:, :2] - basis @ (basis.T @ white[:, :2])
    return white[:, 0], both[:, 0], both[:, 1]


def _curves(pressures: Sequence[Array], lengths: Sequence[Array]) -> list[Array]:
    """Polynomials of both that span all of a degree, block by block, (n, k)."""
    sizes = np.cumsum([one.size for one in pressures])
    pressure, length = (_scaled(np.concatenate(one)) for one in (pressures, lengths))
    terms = legvander2d(pressure, length, [DEGREE, DEGREE])
    orders = np.add.outer(np.arange(DEGREE + 1), np.arange(DEGREE + 1)).ravel()
    return np.split(terms[:, orders <= DEGREE], sizes[:-1])


def _scaled(values: Array) -> Array:
    """From -1 to 1; 0 where nothing varies. [-]."""
    low, high = float(values.min()), float(values.max())
    return 2 * (values - low) / (high - low) - 1 if high > low else 0.0 * values
