"""The force jumps once and stays: a mount that slipped, a cable that was moved.

It is no effect of any library, but several together imitate it. So it is fitted as a
foil: an explanation that it beats is not believed.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import design
from gripperd.diagnose.fit.rival import larger
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.price import SEEN, acts_on
from gripperd.diagnose.search.rivalry import Contest
from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class Jump(InSensor):
    """Every reading after a moment is off by the same."""

    name: ClassVar[str] = "jump"
    needs: ClassVar[frozenset[str]] = frozenset({"force"})
    shows: ClassVar[str] = "the measured force is off from one sweep on"
    confused_with: ClassVar[tuple[str, ...]] = ("force_sensor_drift",)
    remedy: ClassVar[str] = "look what moved between the two sweeps"

    size: float = amplitude(unit="N", scale=10.0, low=-1e4, high=1e4)
    """Reading minus truth after the jump. [N]"""
    at: float = 0.0
    """Since the start of the recording. [s]"""

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return np.asarray(value + self.size * (track.time > self.at))

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return np.asarray(reading - self.size * (track.time > self.at))


def jump(found: Found, best: Contest) -> Jump | None:
    """Give the jump between two sweeps that explains more than the best, if one does.

    Parameters
    ----------
    found, best
        The search and its outcome.
    """
    problem, named = found.problem, best.best.candidates
    if not any(Signal.FORCE in acts_on(problem, one) for one in named):
        return None
    spans = sorted(
        (float(c.time[0] - c.start), float(c.time[-1] - c.start))
        for c in problem.courses
    )
    moments = [(end + start) / 2 for (_, end), (start, _) in pairwise(spans)]
    listed = [Candidate(Jump.name, Jump(size=10.0, at=moment)) for moment in moments]
    around = design(problem, found.null.fit.point, listed)
    if not around.members:
        return None
    leader = max(around.members, key=lambda one: around.fit(one).evidence).candidate
    (foil,) = larger(problem, found.null, [leader])
    if foil.evidence <= best.best.evidence:
        return None
    (told,) = foil.fit.point.effects
    assert isinstance(told, Jump)
    # One that is no more than sensors drift is a drift.
    return told if abs(told.size) > SEEN * problem.full_scale[Signal.FORCE] else None
