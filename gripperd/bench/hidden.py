"""What the effects of a chain do that tables and constants cannot hold."""

from collections.abc import Iterable
from dataclasses import replace
from typing import TypeGuard

import numpy as np

from gripperd.bench.active import ActiveEffects
from gripperd.model import Chain, Direction, Muscle, MuscleEffect, MuscleState
from gripperd.model.effect import (
    ROOM,
    Signal,
    StaticEffect,
    acts_in_gripper,
    acts_in_valve,
)
from gripperd.model.kinds import InMuscle
from gripperd.model.track import Track

DEAD = 1.0
"""Longest dead time of a valve: nothing may move yet, and be on its way. [s]"""


class HiddenEffects:
    """The effects that need the present and the past, stepped with the plant.

    Parameters
    ----------
    chain
        Whose effects they are; those whose force follows from pressure, contraction
        and direction alone are left to the table.
    """

    __slots__ = ("_jaws", "_last", "_muscle", "_valve", "any", "steady")

    def __init__(self, chain: Chain) -> None:
        gripper = filter(acts_in_gripper, chain.effects)
        self._valve = ActiveEffects(filter(acts_in_valve, chain.effects))
        self._muscle = ActiveEffects(lively(chain.static.effects, chain.muscle))
        self._jaws = ActiveEffects(
            effect
            for effect in gripper
            if effect.signal is Signal.OPENING and effect.rest().size
        )
        self._last: tuple[float, ...] = ()
        self.any = bool(self._valve or self._muscle or self._jaws)
        """Whether there are such effects at all."""
        self.steady = False
        """Whether the last sample changed nothing."""

    def begin(self, wanted: float, opening: float, now: Track) -> None:
        """Let the memories settle at power-up, with the muscle vented.

        Parameters
        ----------
        wanted
            Gauge pressure that the regulator's line says. [Pa]
        opening
            What the linkage says. [m]
        now
            The first sample.
        """
        self.pressure(wanted, now)
        self.pulls(0.0, 0.0, now)
        self.lost(opening, now)

    def pressure(self, wanted: float, now: Track) -> float:
        """Gauge pressure that the regulator is after. [Pa].

        Parameters
        ----------
        wanted
            What its line says. [Pa]
        now
            One sample.
        """
        return self._valve.along(wanted, now)

    def pulls(
        self, contracting: float, extending: float, now: Track
    ) -> tuple[float, float]:
        """Pull in each direction of travel. [N, N].

        Parameters
        ----------
        contracting, extending
            What the table says. [N]
        now
            One sample.
        """
        if not self._muscle:
            return contracting, extending
        # Each is asked for as if it were the direction, so that friction that grows
        # with the rate brings the jaws to rest and never turns them round.
        closing = replace(
            now,
            direction=np.array([float(Direction.CONTRACTING)]),
            rate=np.maximum(now.rate, 0.0),
        )
        opening = replace(
            now,
            direction=np.array([float(Direction.EXTENDING)]),
            rate=np.minimum(now.rate, 0.0),
        )
        # What is remembered is the way that was gone.
        if np.all(now.rate > 0):
            there = self._muscle.ahead(extending, opening)
            return self._muscle.along(contracting, closing), there
        here = self._muscle.ahead(contracting, closing)
        return here, self._muscle.along(extending, opening)

    def lost(self, opening: float, now: Track) -> float:
        """Opening of the jaws beyond that of the linkage, by play. [m].

        What they bend under the load is no play, and not in it.

        Parameters
        ----------
        opening
            What the linkage says. [m]
        now
            One sample.
        """
        return self._jaws.along(opening, now) - opening

    def settle(self, now: Track, *outcome: float) -> None:
        """Compare what came out with the sample before, for :attr:`steady`.

        Parameters
        ----------
        now
            The sample.
        outcome
            What came out of it.
        """
        waits = self._valve and now.still[-1] < DEAD
        self.steady = not waits and outcome == self._last
        self._last = outcome


def lively(effects: Iterable[StaticEffect], muscle: Muscle) -> tuple[MuscleEffect, ...]:
    """Give the effects that depend on more than pressure, contraction and direction."""

    def lives(effect: StaticEffect) -> TypeGuard[MuscleEffect]:
        if not isinstance(effect, InMuscle):
            return False
        if type(effect).along is not InMuscle.along:
            return True
        contraction = 0.1
        ratio = muscle.diameter_ratio(contraction)
        calm = MuscleState(1e5, contraction, ratio, Direction.CONTRACTING)
        stirred = calm._replace(rate=1.0, temperature=ROOM + 50.0, cycle=9.0)
        return effect.force(calm, muscle) != effect.force(stirred, muscle)

    return tuple(filter(lives, effects))
