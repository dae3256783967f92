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

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.rival import larger
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.price import SEEN, acts_on, size_of
from gripperd.diagnose.search.rivalry import Contest
from gripperd.model.effect import ROOM, Signal
from gripperd.model.kinds import InMuscle, InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track

FORCE: frozenset[str] = frozenset({"force"})


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
    shows: ClassVar[str] = "the measured force is off from one sweep on"
    remedy: ClassVar[str] = "look what moved between the two sweeps"

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


Artefact: TypeAlias = Jump | WarmCell | Snap


def artefact(found: Found, best: Contest) -> Artefact | None:
    """Give the artefact that explains more than the best, if one does.

    One that is no larger than sensors drift is a drift. Where no name acts on the
    force, nothing could be taken for one.

    Parameters
    ----------
    found, best
        The search and its outcome.
    """
    problem, named = found.problem, best.best.candidates
    if not any(Signal.FORCE in acts_on(problem, one) for one in named):
        return None
    listed = [Candidate(one.name, one) for one in _artefacts(problem)]
    around = design(problem, found.null.fit.point, listed)
    gains = {one: around.fit(one).evidence for one in around.members}
    if not gains:
        return None
    leader = max(gains, key=lambda one: gains[one]).candidate
    (told,) = larger(problem, found.null, [leader])
    # A moment was chosen among many.
    if told.evidence - np.log(len(listed)) <= best.best.evidence:
        return None
    (seen,) = told.fit.point.effects
    assert isinstance(seen, Artefact)
    return seen if size_of(problem, told, [seen.name], [Signal.FORCE]) > SEEN else None


def _artefacts(problem: Problem) -> Iterator[Artefact]:
    if any(np.isfinite(c.level("temperature")).any() for c in problem.courses):
        yield WarmCell(rate=0.5)
    in_turn = sorted(problem.courses, key=lambda course: float(course.time[0]))
    over = [float(course.cycle[0]) for course in in_turn]
    once = next((count for count in over if count > 0), np.inf)
    for (before, after), count in zip(pairwise(in_turn), over[1:], strict=True):
        at = float(before.time[-1] + after.time[0]) / 2 - before.start
        yield Jump(size=10.0, at=at)
        # What is weaker once it was inflated for the first time is run in.
        if count != once:
            yield Snap(loss=0.02, at=at)
