"""The plain way: fit each effect with scipy, rank by BIC, take noise for white.

Constants are refitted with every effect, within their tolerances. They are linear to
first order, so they are projected out and only the numbers of the effect are searched
(G. Golub, V. Pereyra, "Separable nonlinear least squares", Inverse Problems 19, 2003).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import Base, change, sensitivities
from gripperd.model.effect import Effect
from gripperd.model.parameter import parameters
from gripperd.model.track import Array
from tests.exam.peers.classes import families
from tests.exam.peers.exhibit import Exhibit, Guess

DECISIVE = 10.0
"""Difference of BIC that counts as very strong (R. E. Kass, A. E. Raftery, J. Am. Stat.
Assoc. 90, 1995)."""
TRIALS = 10
"""Evaluations of an effect, slopes apart."""


@dataclass(frozen=True, slots=True)
class Fitted:
    """One effect at its best."""

    effect: Effect | None
    """None for constants alone."""
    score: float
    """BIC. [-]"""
    shifts: Array
    """Of the constants, from the point of the exhibit. [sigma]"""


@dataclass(frozen=True)
class Start:
    """Sweeps without any effect, to compare with."""

    problem: Problem
    base: Base

    @classmethod
    def of(cls, problem: Problem, point: Point) -> "Start":
        """Evaluate a problem at a point."""
        return cls(problem, Base.of(problem, point))

    def change(self, effect: Effect) -> list[Array]:
        """Change of every block by an effect. [SI]."""
        there = self.base.explanation.with_effect(effect)
        return change(self.problem, self.base, there, effect, step=1.0)


class Fits:
    """Fits of one exhibit."""

    def __init__(self, exhibit: Exhibit) -> None:
        self._exhibit = exhibit
        self._start = Start.of(exhibit.train, exhibit.point)
        train, point = exhibit.train, exhibit.point
        residuals = train.residuals(point)
        self._weights = _weights(train, residuals)
        table = [self._stack(column) for column in sensitivities(train, point)]
        self._constants = np.vstack([np.column_stack(table), np.eye(len(table))])
        self._target = np.concatenate([self._stack(residuals), -point.shifts])
        self._basis, _ = np.linalg.qr(self._constants)

    def fitted(self, candidate: Candidate | None) -> Fitted:
        """Fit one effect beside the constants, or the constants alone."""
        if candidate is None or candidate.effect is None:
            return self._scored(None, self._target, 0)
        start, names, units, bounds = _coordinates(candidate.effect)
        if not names:
            return self._scored(start, self._target - self._response(start), 0)

        def effect_at(x: Array) -> Effect:
            values = dict(zip(names, (x * units).tolist(), strict=True))
            return replace(start, **values)

        def misfit(x: Array) -> Array:
            left = self._target - self._response(effect_at(x))
            return np.asarray(left - self._basis @ (self._basis.T @ left))

        first = np.array([getattr(start, name) for name in names]) / units
        best = least_squares(misfit, first, bounds=bounds, max_nfev=TRIALS).x
        effect = effect_at(best)
        left = self._target - self._response(effect)
        return self._scored(effect, left, len(names))

    def explained(self, fit: Fitted) -> list[Array]:
        """Give what a fit adds to the test, block by block."""
        test, point = self._exhibit.test, self._exhibit.point
        total = [np.zeros_like(values) for values in test.measured]
        if fit.effect is not None:
            total = [part.copy() for part in Start.of(test, point).change(fit.effect)]
        for factor, column in zip(
            fit.shifts.tolist(), sensitivities(test, point), strict=True
        ):
            for part, values in zip(total, column, strict=True):
                part += factor * values
        return total

    def _response(self, effect: Effect) -> Array:
        change = self._stack(self._start.change(effect))
        return np.concatenate([change, np.zeros(self._constants.shape[1])])

    def _stack(self, blocks: Sequence[Array]) -> Array:
        return np.concatenate(
            [b * w for b, w in zip(blocks, self._weights, strict=True)]
        )

    def _scored(self, effect: Effect | None, left: Array, numbers: int) -> Fitted:
        found = np.linalg.lstsq(self._constants, left, rcond=None)[0]
        shifts: Array = np.asarray(found, np.float64)
        residual = left - self._constants @ shifts
        blocks = self._exhibit.train.blocks
        ends = np.cumsum([int(block.good.sum()) for block in blocks])
        pieces: dict[str, list[Array]] = {}
        for block, piece in zip(blocks, np.split(residual, ends), strict=False):
            pieces.setdefault(str(block.signal), []).append(piece)
        columns = [np.concatenate(parts) for parts in pieces.values()]
        score = sum(one.size * np.log(np.mean(one**2)) for one in columns)
        price = numbers * np.log(ends[-1])
        return Fitted(effect, float(score + price), shifts)


def baseline(exhibit: Exhibit) -> Guess:
    """Fit every effect alone and take the one with the least BIC, if decisive."""
    fits = Fits(exhibit)
    plain = fits.fitted(None)
    tried = [fits.fitted(one) for one in _first_forms(exhibit.listed)]
    best = min(tried, key=lambda fit: fit.score)
    if plain.score - best.score < DECISIVE or best.effect is None:
        return Guess((), frozenset(), exhibit.remaining(fits.explained(plain)))
    name = best.effect.name
    return Guess((name,), families(name), exhibit.remaining(fits.explained(best)))


def _first_forms(listed: Sequence[Candidate]) -> list[Candidate]:
    """One start for each effect."""
    forms: dict[str, Candidate] = {}
    for candidate in listed:
        if candidate.effect is not None:
            forms.setdefault(candidate.name, candidate)
    return list(forms.values())


def _coordinates(
    effect: Effect,
) -> tuple[Effect, list[str], Array, tuple[Array, Array]]:
    """Start, numbers to fit, their units, and their bounds in units."""
    known = {
        name: one
        for name, one in parameters(effect).items()
        if not one.choices and one.high > one.low
    }
    units = np.array([one.scale or 0.1 * one.high for one in known.values()])
    low = np.array([one.low for one in known.values()]) / units
    high = np.array([one.high for one in known.values()]) / units
    inside = {
        name: min(max(getattr(effect, name), one.low), one.high)
        for name, one in known.items()
    }
    return replace(effect, **inside), list(known), units, (low, high)


def _weights(problem: Problem, residuals: Sequence[Array]) -> list[float]:
    """One over the root mean square of each signal's residual, block by block."""
    pieces: dict[str, list[Array]] = {}
    for block, residual in zip(problem.blocks, residuals, strict=True):
        pieces.setdefault(str(block.signal), []).append(residual)
    spread = {
        signal: float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))
        for signal, parts in pieces.items()
    }
    return [1 / spread[str(block.signal)] for block in problem.blocks]
