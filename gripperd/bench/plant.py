"""The simulated gripper: valve current in, pressure, motion and grip force out."""

from dataclasses import replace
from math import isfinite

import numpy as np

from gripperd.bench.air import Air
from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.hidden import HiddenEffects, lively
from gripperd.bench.jaws import Jaws
from gripperd.bench.logbook import Logbook, Moment
from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState, PlacedObject
from gripperd.bench.pull import PullTable
from gripperd.bench.settings import PlantSettings
from gripperd.errors import InputError
from gripperd.model import Chain, Direction, StaticMuscle
from gripperd.model.effect import acts_in_gripper
from gripperd.model.loaded import LoadedLinkage
from gripperd.model.track import Track
from gripperd.units import MILLI

BLOCKED = 1e6
"""Friction that nothing here overcomes. [N]"""


class Plant:
    """Regulator, air, muscle, jaws and the object between them, stepped in time.

    It starts without current and pressure, the jaws open. It knows no clock and no
    chance: the same calls give the same states.

    Parameters
    ----------
    chain
        The static physics, with whatever effects act in it; those of the sensors are
        the business of the rig.
    settings
        The dynamics.
    """

    def __init__(self, chain: Chain, settings: PlantSettings) -> None:
        self._chain = chain
        self._settings = settings
        self._air = Air(settings)
        linkage, muscle = chain.linkage, chain.muscle
        gripper = tuple(filter(acts_in_gripper, chain.effects))
        self._jaws = Jaws(linkage, settings, gripper)
        loaded = LoadedLinkage(linkage, gripper)
        self._stretching = loaded if loaded.inside(0.0, 1.0) else None
        shut = float(linkage.contraction(0.0, muscle.rest_length))
        hidden = lively(chain.static.effects, muscle)
        tabled = (each for each in chain.static.effects if each not in hidden)
        static = StaticMuscle(muscle, tuple(tabled))
        self._pull = PullTable(static, chain.regulator.pressure_high, shut)
        effects = HiddenEffects(chain)
        self._hidden = effects if effects.any else None
        self._logbook = Logbook(chain, settings)
        self._placed: PlacedObject | None = None
        self._faults = HEALTHY
        self._current = 0.0
        self._drag = 0.0
        self._supply = 0.0
        self._wanted = 0.0
        self._target = 0.0
        self._at_rest = False
        self._resume()
        self.time = 0.0
        """Since power-up. [s]"""
        if self._hidden:
            self._hidden.begin(self._wanted, self._jaws.straight, self.track(0.0))

    @property
    def current(self) -> float:
        """Valve current, 0 after power-up. [A]."""
        return self._current

    @current.setter
    def current(self, current: float) -> None:
        if not (isfinite(current) and current >= 0):
            message = f"current_mA = {current / MILLI:g}: must be finite, not below 0"
            raise InputError(message, key="current_mA")
        if current != self._current:
            if self._at_rest and self._hidden:
                # Nothing was noted at rest: until now it was the old command.
                self._hidden.pressure(self._wanted, self.track(0.0))
            self._current = current
            self._resume()

    @property
    def faults(self) -> BenchFaults:
        """What is wrong with it; assign to change it at any time."""
        return self._faults

    @faults.setter
    def faults(self, faults: BenchFaults) -> None:
        self._faults = faults
        drag = BLOCKED if faults.jaws_blocked else faults.jaw_friction
        self._drag = drag * self._chain.linkage.ratio
        self._disturb()
        self._resume()

    @property
    def outlet_pressure(self) -> float:
        """Gauge pressure at the regulator outlet. [Pa]."""
        return self._air.outlet

    @property
    def pressure(self) -> float:
        """Gauge pressure in the muscle. [Pa]."""
        return self._air.chamber

    @property
    def contraction(self) -> float:
        """Shortening of the muscle relative to rest. [-]."""
        return self._jaws.shortening / self._chain.muscle.rest_length

    @property
    def velocity(self) -> float:
        """Rate at which the muscle shortens. [m/s]."""
        return self._jaws.velocity

    @property
    def direction(self) -> Direction:
        """Direction of travel, or of the last travel when at rest."""
        return self._jaws.direction

    @property
    def opening(self) -> float:
        """Distance between the jaws. [m]."""
        return self._jaws.opening

    @property
    def grip(self) -> float:
        """Force of each jaw on the object. [N]."""
        return self._jaws.grip

    @property
    def placed(self) -> PlacedObject | None:
        """The object that was put between the jaws, even when it is lost by now."""
        return self._placed

    @property
    def at_rest(self) -> bool:
        """Whether nothing will change until somebody interferes."""
        return self._at_rest

    def place(self, kind: BenchObject) -> None:
        """Put an object on the support between the jaws.

        Raises
        ------
        InputError
            When it is wider than the jaws are open, or another one is in the way.
        """
        if self._placed and self._placed.state is not ObjectState.LOST:
            there = self._placed.kind.diameter / MILLI
            message = f"an object of {there:g} mm is still between the jaws"
            raise InputError(message)
        self.check_fits(kind)
        self._placed = PlacedObject(kind, self._settings)
        self._disturb()
        self._jaws.face(kind.diameter, kind.stiffness)
        self._resume()

    def check_fits(self, kind: BenchObject) -> None:
        """Refuse an object that is wider than the jaws are open now.

        Raises
        ------
        InputError
            With both sizes.
        """
        if kind.diameter > self.opening:
            message = (
                f"an object of {kind.diameter / MILLI:g} mm does not fit between the"
                f" jaws: they are {self.opening / MILLI:g} mm apart"
            )
            raise InputError(message, key="diameter_mm")

    def remove(self) -> None:
        """Take out by hand whatever is there; the jaws close on nothing."""
        self._placed = None
        self._jaws.face(0.0, 0.0)
        self._resume()

    def step(self, dt: float) -> None:
        """Let time pass. At rest any time is one cheap step. [s]."""
        self.time += dt
        if self._at_rest:
            return
        air, jaws = self._air, self._jaws
        hidden = self._hidden
        now = self.track(dt) if hidden else None
        if hidden and now and not self._faults.valve_stuck:
            self._target = self._within_supply(hidden.pressure(self._wanted, now))
        if self._faults.tube_shut:
            air.leak(self._faults.leak_rate, dt)
        else:
            air.step(self._target, self._faults.leak_rate, dt)
        inside = self._inside
        contracting, extending = self._pull.at(air.chamber, inside)
        if hidden and now:
            within = replace(now, contraction=np.array([inside]))
            contracting, extending = hidden.pulls(contracting, extending, within)
        # A muscle cannot push; the friction of the linkage is there all the same.
        jaws.step(
            max(0.0, contracting) - self._drag,
            max(0.0, extending) + self._drag,
            dt,
        )
        if hidden and now:
            jaws.lose(hidden.lost(jaws.straight, now))
            hidden.settle(now, self._target, contracting, extending)
        placed = self._placed
        if placed:
            before = placed.width, placed.stiffness
            placed.step(jaws.grip, dt)
            if (placed.width, placed.stiffness) != before:
                jaws.face(placed.width, placed.stiffness)
                return
        self._at_rest = (
            air.settled
            and jaws.velocity == 0.0
            and (not placed or placed.at_rest)
            and (not hidden or hidden.steady)
        )

    def track(self, step: float) -> Track:
        """The present as effects see it, one sample after a time step. [s]."""
        jaws = self._jaws
        contraction, length = self.contraction, self._chain.muscle.rest_length
        moment = Moment(
            time=self.time,
            step=step,
            command=self._wanted,
            pressure=self._air.chamber,
            contraction=contraction,
            rate=jaws.velocity / length,
            direction=float(jaws.direction),
            force=jaws.pull,
            grip=jaws.grip,
            supply=self._supply,
        )
        return self._logbook.track(moment)

    @property
    def _inside(self) -> float:
        """Contraction of the muscle itself, where its mount stretches. [-]."""
        if not self._stretching:
            return self.contraction
        return float(self._stretching.inside(self.contraction, self._jaws.pull))

    def _disturb(self) -> None:
        """Let the faults act on what is carried."""
        if self._placed:
            self._placed.disturb(self._faults.pad_friction, self._faults.pull)

    def _resume(self) -> None:
        """Find out what the regulator is after, and move on."""
        regulator, faults = self._chain.regulator, self._faults
        wanted = float(regulator.pressure(self._current))
        # A regulator keeps inside its span, and vents below the live zero.
        wanted = min(max(wanted, regulator.pressure_low), regulator.pressure_high)
        supply = faults.supply_pressure
        if supply is None:
            supply = self._settings.supply_pressure
        self._wanted, self._supply = wanted, supply
        if not faults.valve_stuck:
            self._target = self._within_supply(wanted)
        self._at_rest = False

    def _within_supply(self, pressure: float) -> float:
        """What the supply allows of a pressure that the regulator is after. [Pa]."""
        return max(0.0, min(pressure + self._faults.valve_offset, self._supply))
