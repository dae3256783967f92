"""Keeps an object at its force: by the force, else by the pressure, else by the model.

The model gives the pressure (feed-forward); the loops correct it within bounds. Every
change of level goes on from the pressure that is asked for at that moment, so nothing
jumps.
"""

from dataclasses import dataclass

from gripperd.control.force_loop import ForceLoop, lacking
from gripperd.control.held import Held, behind_valve
from gripperd.control.pressure_loop import PressureLoop
from gripperd.control.setpoint import LONGEST_STEP
from gripperd.control.trust import Level, Trust
from gripperd.errors import DomainError
from gripperd.model import Chain, Direction
from gripperd.signals import Measurement, Quality, Reading

PERIOD = 0.01
"""Of the control loop, as shipped: the delay that the gains allow for. [s]"""
LOOPED = frozenset({Level.PRESSURE, Level.FORCE})
"""Levels at which the measured pressure counts."""
SMOOTHING = 0.1
"""Time constant of the values that a change of level starts from. [s]"""
SETTLE = 0.4
"""Time in which regulator and muscle follow the last step of the feed-forward. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegulationState:
    """How the force is kept at one moment. SI values."""

    level: Level
    quality: Quality
    """``substituted`` while the model stands in for the force sensor."""
    cause: str
    """Why the quality is not good."""
    wanted: float | None
    """Force to keep, per jaw; None with a fixed current. [N]"""
    correction: float
    """Of the pressure that the model gives. [Pa]"""
    most: float
    """Bound of the correction. [Pa]"""


class Regulation:
    """The loops around one held object.

    Parameters
    ----------
    held
        What is held, and how.
    chain
        The model of the gripper.
    current
        Valve current at the start. [A]
    felt
        Grip force per jaw at the start, None where nothing tells it. [N]
    closed
        Time constant of the force loop. [s]
    """

    def __init__(
        self,
        held: Held,
        chain: Chain,
        current: float,
        *,
        felt: float | None,
        closed: float,
    ) -> None:
        self.held = held
        self.felt = held.force if felt is None else felt
        """Grip force per jaw, smoothed. [N]"""
        self._outlet, self._line = chain.outlet, chain.regulator
        self._muscle = behind_valve(chain)
        self._force_loop = ForceLoop(PERIOD, closed)
        self._pressure_loop = PressureLoop(PERIOD)
        self._trust = Trust()
        self._pressure: float | None = None
        self._grip = Reading.bad("not measured yet")
        self._asked = float(self._outlet.pressure(current))
        self._start(self._asked, held.travel)

    @property
    def settled(self) -> bool:
        """Whether the pressure of the model is asked for, and has come."""
        return self._still > SETTLE

    @property
    def state(self) -> RegulationState:
        """Snapshot for whoever asks."""
        return RegulationState(
            level=self._level or Level.MODEL,
            quality=self._grip.quality,
            cause=self._grip.cause,
            wanted=self.held.force,
            correction=self._asked - self._feed,
            most=self._most,
        )

    def aim(self, force: float) -> None:
        """Go to another force, by as much pressure as the model says. [N].

        Raises
        ------
        DomainError
            When the muscle cannot do that at any pressure.
        """
        now = force if self.felt is None else self.felt
        travel = Direction.CONTRACTING if force >= now else Direction.EXTENDING
        rise = self._rise(now, self.held.travel, force, travel)
        # Friction must not turn a rise into a fall, nor the other way round.
        rise = max(rise, 0.0) if force >= now else min(rise, 0.0)
        before, self.held = self.held.travel, self.held.at(force, travel)
        self._start(self._asked + rise, before)

    def aim_current(self, current: float) -> None:
        """Go to a current that a client has set, and stay there. [A]."""
        goal = float(self._outlet.pressure(current))
        travel = Direction.CONTRACTING if goal >= self._asked else Direction.EXTENDING
        before, self.held = self.held.travel, self.held.at(None, travel)
        self._start(goal, before)

    def reduce(self) -> float:
        """Take the force back to the highest to aim for, at once. [A].

        Through the whole band of friction, or nothing would move; venting would drop
        the object.
        """
        most, now = self.held.most, max(self.felt or 0.0, self.held.most)
        rise = self._rise(now, Direction.CONTRACTING, most, Direction.EXTENDING)
        self._asked = self._within(self._asked + min(rise, 0.0))
        self.held = self.held.at(most, Direction.EXTENDING)
        self._start(self._asked, Direction.EXTENDING)
        return self._current()

    def step(self, measured: Measurement, dt: float) -> float:
        """Current after a period. [A].

        Parameters
        ----------
        measured
            The newest measurement.
        dt
            Time since the last step. [s]
        """
        self._note(measured, dt)
        level = self._trust.update(measured, dt)
        if self.held.force is None:
            level = Level.MANUAL
        gauged = measured.pressure.quality is Quality.GOOD
        if (level, gauged) != (self._level, self._gauged):
            self._enter(level, gauged=gauged)
        self._advance(dt)
        self._correct(measured, dt)
        asked = self._feed + self._kept + self._outer + self._inner
        self._asked = self._within(asked)
        return self._current()

    def _start(self, goal: float, travel: Direction) -> None:
        """Go on from what is asked for; corrections so far become part of it."""
        self._feed, self._goal = self._asked, self._within(goal)
        self._kept = self._outer = self._inner = 0.0
        self._still = 0.0
        self._most = self.held.profile.most_correction * max(self._feed, self._goal)
        self._ceiling = self._asked + self._headroom(travel)
        self._level: Level | None = None
        self._gauged = False

    def _headroom(self, travel: Direction) -> float:
        """Rise of pressure to the highest force to aim for. [Pa]."""
        if self.felt is None:
            return 0.0
        try:
            most = self.held.most
            rise = self._rise(self.felt, travel, most, Direction.CONTRACTING)
        except DomainError:
            # Soft and tough: no pressure squeezes it that hard.
            return self._line.pressure_high
        return max(rise, 0.0)

    def _enter(self, level: Level, *, gauged: bool) -> None:
        self._kept += self._outer + self._inner
        self._outer = self._inner = 0.0
        self._force_loop.begin()
        if self._pressure is not None:
            self._pressure_loop.begin(self._asked, self._pressure)
        self._level, self._gauged = level, gauged

    def _advance(self, dt: float) -> None:
        dt = min(dt, LONGEST_STEP)
        gap = self._goal - self._feed
        step = self.held.profile.ramp * self._line.gain * dt
        self._still = self._still + dt if gap == 0.0 else 0.0
        self._feed += min(max(gap, -step), step)

    def _correct(self, measured: Measurement, dt: float) -> None:
        low = -self._most - self._kept
        high = min(self._most, self._ceiling - self._feed) - self._kept
        high = max(high, low)
        wanted, force = self.held.force, measured.grip.value
        if (
            self._level is Level.FORCE
            and self.settled
            and wanted is not None
            and force is not None
        ):
            error = lacking(wanted, force) * self._slope(wanted)
            self._outer = self._force_loop.step(
                error, force, dt, low - self._inner, high - self._inner
            )
        pressure = measured.pressure.value
        if self._level in LOOPED and self._gauged and pressure is not None:
            asked = self._feed + self._kept + self._outer
            self._pressure_loop.follow(asked, dt)
            # On a ramp the lag is known too roughly to tell an error from it.
            if self.settled:
                self._inner = self._pressure_loop.step(
                    pressure, dt, low - self._outer, high - self._outer
                )

    def _note(self, measured: Measurement, dt: float) -> None:
        share = dt / (dt + SMOOTHING)
        self._grip = measured.grip
        self.felt = _smoothed(self.felt, measured.grip.value, share)
        self._pressure = _smoothed(self._pressure, measured.pressure.value, share)

    def _slope(self, force: float) -> float:
        """Pressure for a change of force. [Pa/N]."""
        closing = Direction.CONTRACTING
        return self._rise(force - 0.5, closing, force + 0.5, closing)

    def _rise(
        self, start: float, before: Direction, end: float, after: Direction
    ) -> float:
        """Change of pressure between two forces, each with its travel. [Pa]."""
        first = self.held.pressure(self._muscle, start, before)
        return self.held.pressure(self._muscle, end, after) - first

    def _within(self, pressure: float) -> float:
        low = float(self._outlet.pressure(self._line.current_low))
        high = float(self._outlet.pressure(self._line.current_high))
        return min(max(pressure, low), high)

    def _current(self) -> float:
        return float(self._outlet.current(self._asked))


def _smoothed(before: float | None, value: float | None, share: float) -> float | None:
    if before is None or value is None:
        return before if value is None else value
    return before + (value - before) * share
