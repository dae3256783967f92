"""How long a grip lasts once air, power or bus are gone.

What happens then is decided by the hardware; this only says how long it takes until
the grip force falls under the slip limit. It is meant to be short rather than long.
"""

from dataclasses import dataclass
from enum import StrEnum
from math import inf, log, log1p

from gripperd.control.held import Held, behind_valve
from gripperd.control.tuning import CHAMBER_LAG, REGULATOR_LAG
from gripperd.effects.creep import Creep
from gripperd.effects.leak import Leak
from gripperd.errors import DomainError
from gripperd.model import Chain, Direction
from gripperd.signals import Measurement, Quality

WORST_LEAK = 1 / 66
"""Fall of pressure per pressure with the tube shut, where the model has no leak: the
worst of the real muscles that were measured. [1/s]"""
FASTEST = 1.5
"""How much faster than the slow lags a muscle may empty: as fast as it fills. [-]"""
SIGMAS = 2.0
"""Standard deviations by which a force that is only computed may be too high. [-]"""


class FailMode(StrEnum):
    """What the hardware does when power or air is lost; no software can change it."""

    VENT = "vent"
    """The muscle loses its pressure: the object is released."""
    FREEZE = "freeze"
    """The pressure is trapped: the grip decays with the leaks."""
    SPRING_CLOSE = "spring_close"
    """A spring closes the jaws: the object stays held."""


class Cause(StrEnum):
    """What ends a grip first."""

    VENT = "vent"
    LEAK = "leak"
    CREEP = "creep"


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """Seconds until the grip force is under the slip limit; infinite where it stays."""

    air: float
    """After the loss of air. [s]"""
    power: float
    """After the loss of power. [s]"""
    bus: float
    """After the loss of the bus, the module keeping its current. [s]"""
    limited_by: Cause | None
    """What ends the shortest of them; None where nothing does."""


def budget(
    held: Held,
    measured: Measurement,
    chain: Chain,
    *,
    fail_mode: FailMode,
    worst_leak: float = WORST_LEAK,
) -> Budget | None:
    r"""Predict how long a grip lasts.

    The force follows from the pressure by the model of a closing muscle, shifted down
    to what is measured where that is less; creep may yet take its whole share. So
    with the least pressure :math:`p_s` that carries the object

    .. math:: t = \frac{1}{k}\ln\frac{p}{p_s} \quad\text{(trapped, leak k; any other
              law by :meth:`Leak.lasts`)}, \qquad
              t = \tau\ln\frac{p}{p_s} \quad\text{(vented, lag } \tau\text{)}

    Parameters
    ----------
    held
        What is held.
    measured
        The newest measurement.
    chain
        The model of the gripper.
    fail_mode
        What the hardware does without air or power.
    worst_leak
        Where the model has no leak. [1/s]

    Returns
    -------
    None where force or pressure are not known, or the model has no answer.
    """
    force, pressure = measured.grip.value, measured.pressure.value
    if force is None or pressure is None or force <= 0:
        return None
    try:
        creep = _creep(chain, pressure)
        needed = held.profile.slip_force + _excess(held, force, measured, chain)
        left = _left(held, needed + creep, pressure, chain)
        without_creep = _left(held, needed, pressure, chain) if creep else left
    except DomainError:
        return None
    leak = next((each for each in chain.effects if isinstance(each, Leak)), None)
    trapped = _lasting(left, pressure, leak or Leak(rate=worst_leak))
    lost = {
        FailMode.VENT: left * (REGULATOR_LAG + CHAMBER_LAG) / FASTEST,
        FailMode.FREEZE: trapped,
        FailMode.SPRING_CLOSE: inf,
    }[fail_mode]
    bus = _fed(left, pressure, leak)
    cause = Cause.VENT if fail_mode is FailMode.VENT else Cause.LEAK
    if left <= 0 < without_creep:
        cause = Cause.CREEP
    return Budget(
        air=lost,
        power=lost,
        bus=bus,
        limited_by=cause if min(lost, bus) < inf else None,
    )


def _left(held: Held, force: float, pressure: float, chain: Chain) -> float:
    """Logarithm of the pressure over the one that gives a force, not below 0. [-]."""
    least = held.pressure(behind_valve(chain), force, Direction.CONTRACTING)
    if least <= 0:
        return inf
    return max(log(pressure / least), 0.0) if pressure > 0 else 0.0


def _excess(held: Held, force: float, measured: Measurement, chain: Chain) -> float:
    """By how much the model takes the force for higher than it may be. [N]."""
    pressure, opening = measured.pressure.value, measured.opening.value
    assert pressure is not None
    if opening is None:
        opening = held.size - force / held.profile.stiffness
    doubt = 0.0
    if measured.grip.quality is not Quality.GOOD:
        current = float(chain.outlet.current(pressure))
        doubt = SIGMAS * chain.std(current, held.pressed)
    computed = float(chain.grip_at(pressure, opening))
    return max(computed - force, 0.0) + doubt


def _creep(chain: Chain, pressure: float) -> float:
    """Grip force that creep may yet take. [N]."""
    pull = pressure * float(chain.muscle.pull_area(0.0)) / chain.linkage.ratio
    creep = (each for each in chain.static.effects if isinstance(each, Creep))
    return sum(
        pull * -min(each.fast, 0.0)
        + pull * -min(each.medium, 0.0)
        + pull * -min(each.slow, 0.0)
        for each in creep
    )


def _lasting(left: float, pressure: float, leak: Leak) -> float:
    """Time in which trapped air leaks out to where nothing is left. [s]."""
    if left <= 0:
        return 0.0
    return leak.lasts(pressure, left) if left < inf and leak.rate > 0 else inf


def _fed(left: float, pressure: float, leak: Leak | None) -> float:
    """The same while a regulator that nobody commands any more feeds the leak. [s]."""
    if left <= 0:
        return 0.0
    if leak is None:
        return inf
    drooped = pressure * (1 - leak.early)
    return _lasting(max(left + log1p(-leak.early), 0.0), drooped, leak)
