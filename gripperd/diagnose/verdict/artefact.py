"""Artefacts: no effects of the library, but what looks like one.

An artefact is fitted as an effect is. It is never named; an explanation that it beats
is not believed either.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar, TypeAlias

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.rival import larger
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.price import SEEN, acts_on, size_of
from gripperd.diagnose.search.rivalry import SURE, Contest
from gripperd.diagnose.verdict.ageing import Ageing
from gripperd.model.effect import ROOM, Effect, Signal
from gripperd.model.kinds import InMuscle, InSensor, InValve
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track

FORCE: frozenset[str] = frozenset({"force"})
NEAR = 0.5
"""Share of what the names explain that one must in a first step, to be fitted. [-]"""
VENTED = 0.01
"""Share of the line below which a regulator vents, and keeps nothing. [-]"""

KEPT = 3.0
"""Range of temperature within which a room is kept: what goes with it there and what is
the same throughout are not to be told apart. [K]"""


class _OfCell(InSensor, ABC):
    """Something is added to the reading of the force."""

    __slots__ = ()
    needs: ClassVar[frozenset[str]] = FORCE
    confused_with: ClassVar[tuple[str, ...]] = ("force_sensor_drift",)

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    @abstractmethod
    def error(self, track: Track) -> Array:
        """Reading minus truth. [N]."""

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return np.asarray(value + self.error(track))

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return np.asarray(reading - self.error(track))


@dataclass(frozen=True, slots=True)
class Jump(_OfCell):
    """A mount slipped, a cable was moved: readings after a moment are off alike."""

    name: ClassVar[str] = "jump"
    shows: ClassVar[str] = "the measured force is off from one moment on"
    remedy: ClassVar[str] = "look what moved then"

    size: float = amplitude(unit="N", scale=10.0, low=-1e4, high=1e4)
    """Reading minus truth after the jump. [N]"""
    at: float = 0.0
    """Since the start of the recording. [s]"""

    def error(self, track: Track) -> Array:
        """All of it after the moment. [N]."""
        return np.where(track.time > self.at, self.size, 0.0)

    def told(self, start: float) -> str:
        """Say what it does, by a clock that began some time before. [s]."""
        return f"jumps by {self.size:+.1f} N at {start + self.at:.0f} s, and stays"


@dataclass(frozen=True, slots=True)
class WarmCell(_OfCell):
    """The zero of the cell goes with its temperature, whatever the muscle does."""

    name: ClassVar[str] = "warm_cell"
    shows: ClassVar[str] = "cold and warm sweeps differ by the same force everywhere"
    remedy: ClassVar[str] = "take the zero of the cell at the temperature of each sweep"

    rate: float = amplitude(unit="N_per_K", scale=0.5, low=-1e3, high=1e3)
    """Reading minus truth for each kelvin above 20 °C. [N/K]"""

    def error(self, track: Track) -> Array:
        """In proportion to the temperature; none where that is not known. [N]."""
        return self.rate * np.nan_to_num(track.temperature - ROOM)

    def told(self, _start: float) -> str:
        """Say what it does."""
        return f"is off by {self.rate:+.2f} N for each kelvin, alike everywhere"


@dataclass(frozen=True, slots=True)
class Snap(InMuscle):
    """Strands broke: after a moment the muscle pulls less, in proportion."""

    name: ClassVar[str] = "snap"
    needs: ClassVar[frozenset[str]] = FORCE
    shows: ClassVar[str] = "the muscle pulls less from one sweep on"
    confused_with: ClassVar[tuple[str, ...]] = ("fatigue",)
    remedy: ClassVar[str] = "look at the braid"

    loss: float = amplitude(unit=None, scale=0.02, low=-0.5, high=0.5)
    """Share of the ideal pull that is lost. [-]"""
    at: float = 0.0
    """Since the start of the recording. [s]"""

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pull that is left. [N]."""
        ideal = track.pressure * track.pull_area
        return np.asarray(value - self.loss * ideal * (track.time > self.at))

    def told(self, start: float) -> str:
        """Say what it does, by a clock that began some time before. [s]."""
        way = "weaker" if self.loss > 0 else "stronger"
        at = f"from {start + self.at:.0f} s on"
        return f"{way} by {abs(self.loss):.1%} of the ideal pull {at}"


@dataclass(frozen=True, slots=True)
class SetPoint(InValve):
    """What a regulator keeps goes with its supply, by as much at any current.

    A poppet that the supply presses on is a balance of areas, and no ceiling [1]_.

    References
    ----------
    .. [1] ISO 6953-2, "Compressed air pressure regulators and filter-regulators: test
           methods": pressure regulation is how the outlet goes with the inlet.
    """

    name: ClassVar[str] = "set_point"
    needs: ClassVar[frozenset[str]] = frozenset({"pressure", "current", "supply"})
    shows: ClassVar[str] = "the pressure goes with the supply, alike at any current"
    confused_with: ClassVar[tuple[str, ...]] = ("supply_saturation",)
    remedy: ClassVar[str] = "put a first regulator before it"

    rate: float = amplitude(unit=None, scale=0.1, low=-2.0, high=2.0)
    """Pressure lost per loss of supply. [Pa/Pa]"""
    offset: float = amplitude(unit="kPa", scale=5e3, low=-1e5, high=1e5)
    """Pressure on top at the highest supply, which it was not set at. [Pa]"""

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that is kept; a vented muscle has none to lose. [Pa]."""
        low, high = track.span
        kept = value > low + VENTED * (high - low)
        return value + (self.offset - self.rate * track.supply_drop) * kept

    def told(self, _start: float) -> str:
        """Say what it does."""
        rate = f"{self.rate:+.2f} kPa for each kPa"
        return f"goes with the supply by {rate}, alike at any current"


Artefact: TypeAlias = Jump | WarmCell | Snap | SetPoint | Ageing


def artefact(found: Found, best: Contest) -> Artefact | None:
    """Give the artefact that explains more than the best, if one does.

    One that is ahead by less than a rival that could be true refutes nothing. One that
    is no larger than sensors drift is a drift. Where no name acts where it does,
    nothing could be taken for one.

    Parameters
    ----------
    found, best
        The search and its outcome.
    """
    problem, named = found.problem, best.best.candidates
    acted = {signal for one in named for signal in acts_on(problem, one)}
    suspects = *_artefacts(problem), *_jumps_amid(problem, found.null.fit.point)
    listed = [Candidate(one.name, one) for one in suspects if one.signal in acted]
    if not listed:
        return None
    around = design(problem, found.null.fit.point, listed)
    base = around.fit().evidence
    gains = {one: around.fit(one).evidence - base for one in around.members}
    if not gains:
        return None
    first = max(gains, key=lambda one: gains[one])
    if gains[first] < NEAR * (best.best.evidence - found.null.evidence):
        return None
    leader = first.candidate
    (told,) = larger(problem, found.null, [leader])
    # Of those with a moment one was chosen among many.
    alike = sum(one.name == leader.name for one in listed)
    if told.evidence - np.log(alike) < best.best.evidence + SURE:
        return None
    (seen,) = told.fit.point.effects
    assert isinstance(seen, Artefact)
    return seen if size_of(problem, told, [seen.name], [seen.signal]) > SEEN else None


def _artefacts(problem: Problem) -> Iterator[Effect]:
    warmth = np.concatenate([course.level("temperature") for course in problem.courses])
    known = warmth[np.isfinite(warmth)]
    if known.size and np.ptp(known) > KEPT:
        yield WarmCell(rate=0.5)
    if any(course.supply_drop.any() for course in problem.courses):
        yield SetPoint(rate=0.1, offset=5e3)
    travels = any(course.direction.any() for course in problem.courses)
    if travels and not is_table(problem.courses):
        yield from forms(Ageing)
    in_turn = sorted(problem.courses, key=lambda course: float(course.time[0]))
    over = [float(course.cycle[0]) for course in in_turn]
    once = next((count for count in over if count > 0), np.inf)
    for (before, after), count in zip(pairwise(in_turn), over[1:], strict=True):
        at = float(before.time[-1] + after.time[0]) / 2 - before.start
        yield Jump(size=10.0, at=at)
        # What is weaker once it was inflated for the first time is run in.
        if count != once:
            yield Snap(loss=0.02, at=at)


def _jumps_amid(problem: Problem, point: Point) -> Iterator[Effect]:
    """Give the jump in each sweep that its forces have, if any: at most one has it.

    It lies where the sum of what is left of them, about its mean, is furthest from 0.
    """
    pairs = zip(problem.blocks, problem.residuals(point), strict=True)
    for (block, left), time in zip(pairs, problem.times, strict=True):
        if block.signal is Signal.FORCE:
            start = problem.courses[block.course].start
            last = int(np.argmax(np.abs(np.cumsum(left - np.mean(left))[:-1])))
            at = float(time[last] + time[last + 1]) / 2 - start
            yield Jump(size=10.0, at=at)
