"""One recording against one model: what it says, and what is left."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.whitening import Law, clock_of, innovations, law_of
from gripperd.diagnose.readings.course import Course, joined
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.residuals.block import Block, Group
from gripperd.diagnose.residuals.constants import NUISANCE, Constant, moved
from gripperd.diagnose.residuals.dead_band import within_band
from gripperd.diagnose.residuals.doubt import own_shares
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.runs import Runs
from gripperd.diagnose.residuals.stages import passed_on, predictable, predicted
from gripperd.diagnose.residuals.track import track_of
from gripperd.diagnose.residuals.usable import usable
from gripperd.model.effect import Signal
from gripperd.model.track import Array

_NOTHING: Array = np.empty(0)


@dataclass(frozen=True)
class Problem:
    """What was measured, what the model says, and how loud the noise is."""

    courses: tuple[Course, ...]
    model: Explanation
    constants: tuple[Constant, ...]
    noises: Mapping[Signal, Noise]
    slack: float = -np.inf
    """Force below which the muscle may be slack and tells nothing. [N]"""
    zero: float = 0.0
    """What a cell reads of a muscle that is slack. [N]"""
    inflations: Mapping[Signal, float] = field(default_factory=dict)
    """How much louder noises are taken than they were measured, in squares. [-]"""
    kept: tuple[Mask, ...] = ()
    """Samples of each course that take part; all when empty."""
    dwells: tuple[Block, ...] = ()
    """Stretches that are judged once more, each about a level of its own."""
    band: float = 0.0
    """Width within which the regulator sleeps: there its pressure is anywhere. [Pa]"""
    processes: int = 1
    """How many fit side by side."""

    @cached_property
    def blocks(self) -> tuple[Block, ...]:
        """Every signal of every sweep that has samples to explain, then the dwells."""
        found = []
        for index, course in enumerate(self.courses):
            for signal in predictable(course):
                if signal not in self.noises or not self.model.tells(signal):
                    continue
                good = usable(course, signal)
                if signal is Signal.FORCE:
                    good &= course.level("force") > self.slack
                    # Where a force sets in, a trend may be off by more than the noise.
                    good &= course.column("force") > (self.slack + self.zero) / 2
                if self.kept:
                    good &= self.kept[index]
                if good.sum() >= 4:
                    found.append(self._resting(Block(index, signal, good)))
        return (*found, *self.dwells)

    def _resting(self, block: Block) -> Block:
        """Give pressures the noise of a regulator that sleeps in its dead band."""
        regulator = self.model.regulator
        if block.signal is not Signal.PRESSURE or regulator is None or not self.band:
            return block
        noise, course = self.noises[block.signal], self.courses[block.course]
        return within_band(block, course, regulator, noise, self.band)

    @cached_property
    def is_blind(self) -> bool:
        """Whether the pull of the muscle is known but by a grip, in some sweep."""
        return any(
            block.signal is Signal.GRIP and self.courses[block.course].is_blind
            for block in self.blocks
        )

    def shown(self, moved: frozenset[Signal]) -> frozenset[Signal]:
        """Signals explained in which a change of some signals shows."""
        felt = self.model.felt(moved, is_blind=self.is_blind)
        return felt & frozenset(self.signals)

    @property
    def signals(self) -> tuple[Signal, ...]:
        """Those explained anywhere."""
        return tuple(dict.fromkeys(block.signal for block in self.blocks))

    def inflation(self, signals: Iterable[Signal]) -> float:
        """Give the highest of some signals; 1 where the noise is reached. [-]."""
        return max((self.inflations.get(one, 1.0) for one in signals), default=1.0)

    @property
    def is_inflated(self) -> bool:
        """Whether misfit, not noise, is what explanations are weighed against."""
        return self.inflation(self.signals) > 1

    def reach(self, point: Point) -> Array:
        """How far each constant may be off, in widths of its prior."""
        reach = np.array([constant.reach for constant in self.constants])
        # Tolerances that were loosened were searched no further than that.
        if not point.looser:
            reach[list(point.freed)] = NUISANCE
        return reach

    def ends(self, point: Point) -> tuple[Array, Array]:
        """Between which each constant may be off, in widths of its prior.

        Past what could be made at all nothing changes, and no slope leads back.
        """
        reach = self.reach(point)
        low, high = -reach, reach.copy()
        for place, one in enumerate(self.constants):
            width = one.sigma * float(point.widths[place])
            least, most = ((end - one.nominal) / width for end in one.limits)
            low[place] = max(low[place], min(least, 0.0))
            high[place] = min(high[place], max(most, 0.0))
        return low, high

    def explanation(self, point: Point) -> Explanation:
        """Give the model at a point."""
        model = moved(self.model, self.constants, point.shifts.tolist())
        model = replace(model, stiction=point.stiction)
        for effect in point.effects:
            model = model.with_effect(effect)
        return model

    def tracks(self, explanation: Explanation) -> tuple[Runs, ...]:
        """What happened, as the explanation has it, in the order of the groups."""
        return tuple(
            track_of(explanation, group.whole, *group.places) for group in self.groups
        )

    def expected(
        self,
        explanation: Explanation,
        signals: frozenset[Signal] | None = None,
        tracks: Sequence[Runs] | None = None,
    ) -> list[Array]:
        """Predicted readings block by block; an empty array for what is not asked.

        Parameters
        ----------
        explanation
            What is thought to act.
        signals
            Those asked for; none for all.
        tracks
            What happened, when at hand.
        """
        felt = self.shown(signals) if signals else frozenset()
        found: dict[tuple[int, Signal], Array] = {}
        for number, (places, shown, whole) in enumerate(self.groups):
            wanted = [one for one in shown if not signals or one in felt]
            if not wanted:
                continue
            track = tracks[number] if tracks else track_of(explanation, whole, *places)
            for signal, value in predicted(explanation, whole, wanted, track).items():
                for place, piece in zip(places, whole.slices, strict=True):
                    found[place, signal] = value[piece]
        return [
            found[block.course, block.signal][block.good]
            if (block.course, block.signal) in found
            else _NOTHING
            for block in self.blocks
        ]

    @cached_property
    def groups(self) -> tuple[Group, ...]:
        """Sweeps that explain some signals, to be predicted at once."""
        shown: dict[Signal, dict[int, None]] = {}
        for block in self.blocks:
            shown.setdefault(block.signal, {})[block.course] = None
        signals: dict[tuple[int, ...], list[Signal]] = {}
        for signal, places in shown.items():
            signals.setdefault(tuple(places), []).append(signal)
        return tuple(
            Group(places, tuple(own), joined([self.courses[place] for place in places]))
            for places, own in signals.items()
        )

    @cached_property
    def measured(self) -> list[Array]:
        """Readings block by block, less what smooth inputs leave out. [SI]."""
        found: list[Array] = []
        for block in self.blocks:
            course = self.courses[block.course]
            track = track_of(self.model, course, block.course)
            passed = passed_on(self.model, course, track, block.signal)
            found.append((course.column(block.signal.value) - passed)[block.good])
        return found

    @cached_property
    def readings(self) -> list[Array]:
        """The same as they are judged, a force as it was read. [SI]."""
        return [
            self.courses[block.course].column(block.signal.value)[block.good]
            if block.signal is Signal.FORCE
            else measured
            for block, measured in zip(self.blocks, self.measured, strict=True)
        ]

    @cached_property
    def times(self) -> list[Array]:
        """Times block by block. [s]."""
        return [self.courses[b.course].time[b.good] for b in self.blocks]

    @cached_property
    def full_scale(self) -> dict[Signal, float]:
        """Largest reading of each signal. [SI]."""
        found: dict[Signal, float] = {}
        for block, values in zip(self.blocks, self.measured, strict=True):
            top = float(np.max(np.abs(values)))
            found[block.signal] = max(found.get(block.signal, 0.0), top)
        return found

    @cached_property
    def lowest(self) -> dict[Signal, float]:
        """Lowest level of each signal that was measured, explained or not. [SI]."""
        return {signal: float(np.min(values)) for signal, values in self._levels()}

    @cached_property
    def highest(self) -> dict[Signal, float]:
        """Highest magnitude of the same. [SI]."""
        return {s: float(np.max(np.abs(values))) for s, values in self._levels()}

    def _levels(self) -> Iterator[tuple[Signal, Array]]:
        for signal in Signal:
            levels = [course.level(signal.value) for course in self.courses]
            known = np.concatenate(levels)
            known = known[np.isfinite(known)]
            if known.size:
                yield signal, known

    def residuals(self, point: Point) -> list[Array]:
        """Measured minus expected, block by block. [SI]."""
        expected = self.expected(self.explanation(point))
        return [y - f for y, f in zip(self.measured, expected, strict=True)]

    def judged(self, point: Point) -> list[Array]:
        """Readings minus what smooth inputs foretell, block by block. [SI].

        A fit takes a length as it was read, for its corners: its noise weighs less in
        many samples than a corner that a trend cuts off. A prediction knows better.
        """
        expected = self.expected(self.explanation(point))
        return [y - f for y, f in zip(self.readings, expected, strict=True)]

    def white(self, columns: Sequence[Array], index: int) -> Array:
        """Whiten columns of one block, shape ``(n, k)``."""
        shared = self.shares[index][:, None] * np.column_stack(columns)
        return innovations(shared, self._laws[index])

    @cached_property
    def _laws(self) -> list[Law]:
        """Law of the noise block by block."""
        return [
            law_of(clock_of(time), block.noise or self.noises[block.signal], block.ages)
            for block, time in zip(self.blocks, self.times, strict=True)
        ]

    @cached_property
    def shares(self) -> list[Array]:
        """What :func:`own_shares` gives, block by block."""
        noises = [block.noise or self.noises[block.signal] for block in self.blocks]
        return own_shares(self.model, self.courses, self.blocks, noises)

    def floor(self, signal: Signal) -> float:
        """Root mean square of a signal about a model that misses nothing. [SI]."""
        noise = self.noises[signal]
        blocks = [block for block in self.blocks if block.signal is signal]
        known = [noise] * len(blocks)
        shares = own_shares(self.model, self.courses, blocks, known, "contraction")
        stds = [noise.std / share for share in shares]
        return float(np.hypot(np.sqrt(np.mean(np.concatenate(stds) ** 2)), noise.drift))

    @cached_property
    def zeros(self) -> list[Array]:
        """No change, block by block."""
        return [np.zeros(int(block.good.sum())) for block in self.blocks]
