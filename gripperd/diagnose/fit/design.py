"""All candidates beside each other: whitened, scaled by their priors, as a Gram."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.fit.candidates import Candidate, amplitudes, side, surprise
from gripperd.diagnose.fit.gram import Fit, Gram
from gripperd.diagnose.residuals.constants import NUISANCE
from gripperd.diagnose.residuals.point import FREED, Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import Base, responses, sensitivities
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.effect import Effect, Signal, Stage
from gripperd.model.parameter import parameters
from gripperd.model.track import Array

TYPICAL = 0.04
"""Root mean square of an effect before any measurement, of full scale. [-]"""
BROKEN = 0.065
"""Largest bias of a transmitter in use, of full scale. [-]"""
STROKE = 0.25
"""Contraction of a fluidic muscle: the full scale of its length. [-]"""
VENTED = 0.01
"""Pressure below that of the air that a wrong zero and noise may feign, of full scale:
a regulator blows and does not suck. [-]"""
SPOILT = 0.08
"""The same of its gain. [-]"""
BIASES = ("N", "kPa")
FAINT = 1e-5
"""A response below this share of full scale cannot be seen. [-]"""


@dataclass(frozen=True, slots=True, eq=False)
class Member:
    """A candidate and its columns in the Gram."""

    candidate: Candidate
    columns: NDArray[np.intp]


@dataclass(frozen=True)
class Design:
    """Everything that could explain a recording, linear around a point."""

    point: Point
    gram: Gram
    nuisance: NDArray[np.intp]
    """Columns of the constants."""
    acting: tuple[Member, ...]
    """Effects that already act at the point."""
    members: tuple[Member, ...]
    """Candidates that can be seen here."""
    faint: tuple[str, ...]
    """Names whose every form leaves no trace in this recording."""

    def columns(self, *chosen: Member) -> NDArray[np.intp]:
        """Columns of the constants, of what acts, and of some candidates."""
        return np.concatenate(
            [
                self.nuisance,
                *(one.columns for one in self.acting),
                *(one.columns for one in chosen),
            ]
        )

    def fit(self, *chosen: Member) -> Fit:
        """Fit the constants, what acts, and some candidates."""
        columns = self.columns(*chosen)
        start = np.zeros(columns.size)
        start[: self._alone.coefficients.size] = self._alone.coefficients
        fit = self.gram.fit(columns, start)
        effects = (one.candidate.effect for one in chosen)
        unusual = sum(surprise(effect) for effect in effects if effect is not None)
        return replace(fit, evidence=fit.evidence - unusual) if unusual else fit

    @cached_property
    def _alone(self) -> Fit:
        """The constants and what acts, without any candidate."""
        return self.gram.fit(self.columns())


def design(problem: Problem, point: Point, listed: Sequence[Candidate]) -> Design:
    """Evaluate and whiten the response of everything, around a point."""
    base = Base.of(problem, point)
    slopes = sensitivities(problem, point, base)
    build = _Builder(problem, base.expected)
    starts = (point.shifts / point.widths).tolist()
    lows, highs = (each.tolist() for each in problem.ends(point))
    for start, width, low, high, response in zip(
        starts, point.widths.tolist(), lows, highs, slopes, strict=True
    ):
        build.add(response, width, start, (low, high))
    nuisance = np.arange(build.width, dtype=np.intp)
    acting = tuple(
        _acting(problem, point, effect, base, build) for effect in point.effects
    )
    members: list[Member] = []
    idle = [one for one in listed if not _acts(one, point)]
    effects = [one.effect for one in idle if one.effect is not None]
    answers = iter(
        side_by_side(
            lambda effect: responses(problem, point, effect, base),
            effects,
            problem.processes,
        )
    )
    for candidate in idle:
        if candidate.constant is not None:
            response = slopes[candidate.constant]
            columns = [build.add(response, FREED, 0.0, (-NUISANCE, NUISANCE))]
        else:
            assert candidate.effect is not None
            columns = _response(problem, candidate.effect, next(answers), build)
        if columns:
            members.append(Member(candidate, np.array(columns, np.intp)))
    faint = {one.name for one in listed} - {one.candidate.name for one in members}
    return Design(
        point, build.gram(), nuisance, acting, tuple(members), tuple(sorted(faint))
    )


def _acts(candidate: Candidate, point: Point) -> bool:
    """Whether a point has it already."""
    if candidate.effect is None:
        return candidate.constant in point.freed
    return candidate.name in {effect.name for effect in point.effects}


def _acting(
    problem: Problem, point: Point, effect: Effect, base: Base, build: "_Builder"
) -> Member:
    known = parameters(effect)
    columns = []
    names = amplitudes(effect)
    for name, response in zip(
        names, responses(problem, point, effect, base), strict=True
    ):
        prior = problem_prior(problem, effect, response) or 1.0
        start = getattr(effect, name) / known[name].scale / prior
        low, high = (
            bound / known[name].scale / prior for bound in limits(problem, effect, name)
        )
        columns.append(build.add(response, prior, start, (low, high)))
    return Member(Candidate(effect.name, effect), np.array(columns, np.intp))


def _response(
    problem: Problem, effect: Effect, answers: Sequence[list[Array]], build: "_Builder"
) -> list[int]:
    known = parameters(effect)
    columns = []
    names = amplitudes(effect) or [""]
    for name, response in zip(names, answers, strict=True):
        prior = problem_prior(problem, effect, response)
        if prior is None:
            continue
        low, high = 0.0, np.inf
        if name:
            size = known[name].scale * prior
            low, high = (bound / size for bound in limits(problem, effect, name))
        columns.append(build.add(response, prior, 0.0, (low, high)))
    return columns


def problem_prior(
    problem: Problem, effect: Effect, response: Sequence[Array]
) -> float | None:
    """Prior sigma of an amplitude, in its scales; none when it leaves no trace.

    It is told from the signal in which the effect is loudest. A sensor is wrong by a
    share of its own full scale, however small what is made of its readings: the grip
    is what the spring leaves of a pull several times as large. So is a muscle of which
    nothing but the grip is known.
    """
    scales = problem.full_scale
    if problem.is_blind and effect.stage is Stage.MUSCLE:
        scales = scales | {Signal.GRIP: _pull_of_grip(problem)}
    squares: dict[Signal, float] = {}
    counts: dict[Signal, int] = {}
    for block, column in zip(problem.blocks, response, strict=True):
        squares[block.signal] = squares.get(block.signal, 0.0) + float(column @ column)
        counts[block.signal] = counts.get(block.signal, 0) + column.size
    loud = {s: (squares[s] / counts[s]) ** 0.5 / scales[s] for s in squares}
    loudest = max(loud.values())
    if effect.stage is Stage.SENSOR:
        loudest = loud.get(effect.signal) or loudest
    return TYPICAL / loudest if np.isfinite(loudest) and loudest > FAINT else None


def _pull_of_grip(problem: Problem) -> float:
    """Largest pull behind a grip, as each jaw would have it without a spring. [N]."""
    linkage, length = problem.model.linkage, problem.model.muscle.rest_length
    assert linkage is not None
    ways = [
        problem.courses[block.course].level("contraction")[block.good]
        for block in problem.blocks
        if block.signal is Signal.GRIP
    ]
    spring = np.max(linkage.spring_force(np.concatenate(ways), length))
    return problem.full_scale[Signal.GRIP] + float(spring) / linkage.ratio


def limits(problem: Problem, effect: Effect, name: str) -> tuple[float, float]:
    """Bounds of a parameter: those of physics, and of what a sensor in use may be off.

    SI. A transmitter that is off by more than :data:`BROKEN` is no candidate for a bias
    any more: somebody would have noticed. Nor may one of pressure read so much too high
    that a vented muscle would have been sucked empty.
    """
    known = parameters(effect)[name]
    if effect.one_sided and known.is_amplitude:
        return (known.low, 0.0) if side(effect) < 0 else (0.0, known.high)
    highest = problem.highest.get(effect.signal)
    scale = problem.full_scale.get(effect.signal, highest)
    if effect.stage is Stage.SENSOR and name == "error":
        return max(known.low, -SPOILT), min(known.high, SPOILT)
    if effect.signal is Signal.CONTRACTION and known.unit is None:
        scale = STROKE
    elif effect.stage is not Stage.SENSOR or known.unit not in BIASES or scale is None:
        return known.low, known.high
    high = min(known.high, BROKEN * scale)
    if effect.signal is Signal.PRESSURE and name == "bias":
        vented = problem.lowest[Signal.PRESSURE] + VENTED * scale
        high = min(high, max(vented, 0.0))
    return max(known.low, -BROKEN * scale), high


class _Builder:
    """Gathers responses and turns them into inner products, block by block."""

    def __init__(self, problem: Problem, expected: Sequence[Array]) -> None:
        self._problem = problem
        self._targets = [y - f for y, f in zip(problem.measured, expected, strict=True)]
        self._responses: list[tuple[Sequence[Array], float]] = []
        self._bounds: list[tuple[float, float]] = []

    @property
    def width(self) -> int:
        return len(self._responses)

    def add(
        self,
        response: Sequence[Array],
        prior: float,
        start: float,
        bounds: tuple[float, float],
    ) -> int:
        """Take in a column; what already acts is put back into the target."""
        self._responses.append((response, prior))
        self._bounds.append(bounds)
        if start:
            for target, column in zip(self._targets, response, strict=True):
                target += start * prior * column
        return self.width - 1

    def gram(self) -> Gram:
        problem, m = self._problem, self.width
        products, moments, square = np.zeros((m, m)), np.zeros(m), 0.0
        for index in range(len(problem.blocks)):
            columns = {
                place: response[index] * prior
                for place, (response, prior) in enumerate(self._responses)
                if response[index] is not problem.zeros[index] and response[index].any()
            }
            places = np.array(list(columns), dtype=np.intp)
            white = problem.white([*columns.values(), self._targets[index]], index)
            z, y = white[:, :-1], white[:, -1]
            products[np.ix_(places, places)] += z.T @ z
            moments[places] += z.T @ y
            square += float(y @ y)
        low, high = np.array(self._bounds).T
        return Gram(products, moments, square, low, high)
