"""One recording against one model: residuals and how they answer to every parameter."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.constants import NUISANCE, Constant, moved
from gripperd.diagnose.course import Course
from gripperd.diagnose.noise import Noise
from gripperd.diagnose.stages import (
    Explanation,
    passed_on,
    predictable,
    predicted,
    track_of,
)
from gripperd.diagnose.usable import usable
from gripperd.diagnose.whitening import whitened
from gripperd.model.effect import Effect, Signal, Stage, acts_in_gripper
from gripperd.model.parameter import parameters
from gripperd.model.track import Array, Track

FREED = 12.0
"""Prior of a wrong constant, in its stated sigma."""

STEP = 0.25
"""Step of a difference quotient, in sigma of a constant or scales of an amplitude."""


Mask: TypeAlias = NDArray[np.bool_]


class Block(NamedTuple):
    """One signal in one sweep."""

    course: int
    signal: Signal
    good: Mask
    """Samples to explain, shape ``(n,)``."""


@dataclass(frozen=True, slots=True)
class Point:
    """Where the search stands: constants, and effects added to the model."""

    shifts: Array
    """Of the constants from nominal, in sigma."""
    effects: tuple[Effect, ...] = ()
    freed: frozenset[int] = frozenset()
    """Constants found to be wrong: their tolerance no longer holds them."""

    @property
    def widths(self) -> Array:
        """Prior of each constant, in its stated sigma."""
        widths = np.ones_like(self.shifts)
        widths[list(self.freed)] = FREED
        return widths

    def with_effect(self, effect: Effect) -> "Point":
        """Put an effect in, in the place of one of its name if there is."""
        others = tuple(one for one in self.effects if one.name != effect.name)
        return replace(self, effects=(*others, effect))

    def without(self, name: str) -> "Point":
        """Take an effect out."""
        return replace(
            self, effects=tuple(one for one in self.effects if one.name != name)
        )


@dataclass(frozen=True)
class Problem:
    """What was measured, what the model says, and how loud the noise is."""

    courses: tuple[Course, ...]
    model: Explanation
    constants: tuple[Constant, ...]
    noises: Mapping[Signal, Noise]
    slack: float = -np.inf
    """Force below which the muscle may be slack and tells nothing. [N]"""
    temperature: float = 1.0
    """How much louder the noise is taken than it was measured, in squares. [-]"""
    kept: tuple[Mask, ...] = ()
    """Samples of each course that take part; all when empty."""

    @cached_property
    def blocks(self) -> tuple[Block, ...]:
        """Every signal of every sweep that has samples to explain."""
        found = []
        for index, course in enumerate(self.courses):
            for signal in predictable(course):
                if signal not in self.noises or not self._has_part(signal):
                    continue
                good = usable(course, signal, self.noises[signal].std)
                if signal is Signal.FORCE:
                    good &= course.level("force") > self.slack
                if self.kept:
                    good &= self.kept[index]
                if good.sum() >= 4:
                    found.append(Block(index, signal, good))
        return tuple(found)

    def _has_part(self, signal: Signal) -> bool:
        if signal is Signal.PRESSURE:
            return self.model.regulator is not None
        if signal in (Signal.OPENING, Signal.GRIP):
            return self.model.linkage is not None
        return True

    @property
    def signals(self) -> tuple[Signal, ...]:
        """Those explained anywhere."""
        return tuple(dict.fromkeys(block.signal for block in self.blocks))

    def reach(self, point: Point) -> Array:
        """How far each constant may be off, in widths of its prior."""
        reach = np.array([constant.reach for constant in self.constants])
        reach[list(point.freed)] = NUISANCE
        return reach

    def explanation(self, point: Point) -> Explanation:
        """Give the model at a point."""
        model = moved(self.model, self.constants, point.shifts.tolist())
        for effect in point.effects:
            model = model.with_effect(effect)
        return model

    def tracks(self, explanation: Explanation) -> tuple[Track, ...]:
        """What happened in each sweep, as the explanation has it."""
        return tuple(
            track_of(explanation, course, index)
            for index, course in enumerate(self.courses)
        )

    def expected(
        self,
        explanation: Explanation,
        signals: frozenset[Signal] | None = None,
        tracks: Sequence[Track] | None = None,
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
        out: list[Array] = []
        for course, blocks in self._by_course:
            wanted = [b.signal for b in blocks if not signals or b.signal in signals]
            if not wanted:
                out += [_NOTHING] * len(blocks)
                continue
            sweep = self.courses[course]
            track = tracks[course] if tracks else track_of(explanation, sweep, course)
            found = predicted(explanation, sweep, wanted, track)
            out += [
                found[block.signal][block.good] if block.signal in found else _NOTHING
                for block in blocks
            ]
        return out

    @cached_property
    def _by_course(self) -> list[tuple[int, list[Block]]]:
        return [
            (index, [block for block in self.blocks if block.course == index])
            for index in dict.fromkeys(block.course for block in self.blocks)
        ]

    @cached_property
    def measured(self) -> list[Array]:
        """Readings block by block, less what smooth inputs leave out. [SI]."""
        tracks = self.tracks(self.model)
        found: list[Array] = []
        for block in self.blocks:
            course, track = self.courses[block.course], tracks[block.course]
            passed = passed_on(self.model, course, track, block.signal)
            found.append((course.column(block.signal.value) - passed)[block.good])
        return found

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

    def residuals(self, point: Point) -> list[Array]:
        """Measured minus expected, block by block. [SI]."""
        expected = self.expected(self.explanation(point))
        return [y - f for y, f in zip(self.measured, expected, strict=True)]

    def white(self, columns: Sequence[Array], index: int) -> Array:
        """Whiten columns of one block, shape ``(n, k)``."""
        noise = self.noises[self.blocks[index].signal]
        return whitened(np.column_stack(columns), self.times[index], noise)

    def sensitivities(self, point: Point) -> list[list[Array]]:
        """Change of every block for one sigma of each constant; constants first."""
        base = self.expected(self.explanation(point))
        # Constants of one sweep each are moved together: none feels the others.
        own = [i for i, one in enumerate(self.constants) if one.course is not None]
        apart = self._slope(point, own, base) if own else []
        found: list[list[Array]] = []
        for index, constant in enumerate(self.constants):
            if constant.course is None:
                found.append(self._slope(point, [index], base))
            else:
                found.append(self._of_course(apart, constant.course))
        return found

    def _slope(
        self, point: Point, indices: list[int], base: list[Array]
    ) -> list[Array]:
        shifts = point.shifts.copy()
        shifts[indices] += STEP
        there = self.explanation(replace(point, shifts=shifts))
        moved_on = frozenset[Signal]().union(
            *(self.constants[i].moves for i in indices)
        )
        return self._quotient(self.expected(there, moved_on), base, STEP)

    def _of_course(self, columns: list[Array], course: int) -> list[Array]:
        return [
            column if block.course == course else zero
            for column, block, zero in zip(
                columns, self.blocks, self._zeros, strict=True
            )
        ]

    def responses(self, point: Point, effect: Effect) -> list[list[Array]]:
        """Change of every block for one scale of each amplitude of an effect.

        For an effect that already acts at the point, the slope there; for a new one
        its response at one scale, so that an effect with a threshold is seen.
        """
        here = self.explanation(point)
        acts = any(one.name == effect.name for one in point.effects)
        base = self.explanation(point.without(effect.name)) if not acts else here
        tracks = self.tracks(base)
        start = self.expected(base, None, tracks)
        return [
            self.change(base.with_effect(one), start, one, tracks, size)
            for one, size in _nudged(effect, acts=acts)
        ]

    def change(
        self,
        there: Explanation,
        here: list[Array],
        effect: Effect,
        tracks: Sequence[Track],
        step: float,
    ) -> list[Array]:
        """Difference quotient of every block when one effect changes.

        Parameters
        ----------
        there, here
            The explanation with the change, and what is expected without.
        effect
            What changed.
        tracks
            What happened, without the change.
        step
            Its size.
        """
        # A sensor changes what is thought to have happened; nothing else does.
        known = None if effect.stage is Stage.SENSOR else tracks
        expected = self.expected(there, moves(effect), known)
        return self._quotient(expected, here, step)

    def _quotient(
        self, there: list[Array], here: list[Array], step: float
    ) -> list[Array]:
        """Difference quotient block by block; 0 where nothing was asked."""
        return [
            (a - b) / step if a.size else zero
            for a, b, zero in zip(there, here, self._zeros, strict=True)
        ]

    @cached_property
    def _zeros(self) -> list[Array]:
        return [np.zeros(int(block.good.sum())) for block in self.blocks]


_NOTHING: Array = np.empty(0)


def moves(effect: Effect) -> frozenset[Signal] | None:
    """Signals an effect changes; all for a sensor."""
    if effect.stage is Stage.SENSOR:
        return None
    stretches = acts_in_gripper(effect) and effect.hidden_contraction(1.0) != 0
    return frozenset({effect.signal, Signal.FORCE} if stretches else {effect.signal})


def _nudged(effect: Effect, *, acts: bool) -> Iterator[tuple[Effect, float]]:
    """Give the effect with one amplitude moved at a time, and by how many scales."""
    known = parameters(effect)
    amplitudes = [name for name, one in known.items() if one.is_amplitude]
    if not amplitudes and not acts:
        yield effect, 1.0
    for name in amplitudes:
        scale = known[name].scale
        if acts:
            value = getattr(effect, name) + STEP * scale
            yield replace(effect, **{name: value}), STEP
        else:
            silent = dict.fromkeys(amplitudes, 0.0)
            yield replace(effect, **(silent | {name: scale})), 1.0
