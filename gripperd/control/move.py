"""Bringing the empty jaws to an opening."""

from gripperd.control.command import Failure
from gripperd.control.ending import Ending
from gripperd.control.force import ForceSense
from gripperd.control.setpoint import LONGEST_STEP, Ramp, reached, within
from gripperd.control.states import Grip
from gripperd.control.task import Moved
from gripperd.errors import DomainError, Refused
from gripperd.model import Chain, Direction
from gripperd.signals import Measurement
from gripperd.units import MILLI

RATE = 8e-3
"""Of the valve current, as that of an approach: 2 s over the whole span. [A/s]"""
SETTLE = 0.5
"""Time in which free jaws come to rest. [s]"""
TOLERANCE = 2e-3
"""Distance from the wanted opening that still counts as there. [m]"""


def current_for(opening: float, chain: Chain) -> float:
    """Current at which free, closing jaws stand at an opening. [A].

    Raises
    ------
    Refused
        They cannot stand there.
    """
    line = chain.regulator
    if not 0 <= opening <= chain.linkage.open_width:
        message = (
            f"opening_mm = {opening / MILLI:g}: the jaws open 0 to"
            f" {chain.linkage.open_width / MILLI:g} mm"
        )
        raise Refused(message, code="infeasible")
    try:
        current = float(chain.current(0.0, opening, Direction.CONTRACTING))
    except DomainError as beyond:
        raise Refused(str(beyond), code="infeasible") from beyond
    if current > line.current_high:
        message = (
            f"an opening of {opening / MILLI:g} mm takes {current / MILLI:.2f} mA, and"
            f" the valve takes up to {line.current_high / MILLI:g} mA"
        )
        raise Refused(message, code="infeasible")
    return within(line, current)


class Travel:
    """A move from its first step to its end.

    Parameters
    ----------
    opening
        Where to. [m]
    chain
        The model of the gripper.
    current
        Valve current at the start. [A]

    Raises
    ------
    Refused
        The jaws cannot stand there.
    """

    def __init__(self, opening: float, chain: Chain, current: float) -> None:
        self.ramp = Ramp(current)
        self._opening = opening
        self._chain = chain
        self._goal = current_for(opening, chain)
        self._force = ForceSense()
        self._dwell = 0.0

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period; touching something ends it."""
        self.ramp.tick(dt)
        self._force.update(measured, dt)
        if self._force.touching:
            self.rest(measured)
            failure = Failure(
                category="outcome",
                code="object_met",
                message="the jaws met something on their way; it is held lightly",
            )
            return Ending(Grip.HOLDING, failure=failure, finding=self._found(measured))
        if not self.ramp.towards(self._goal, RATE, dt):
            return None
        self._dwell += min(dt, LONGEST_STEP)
        return self._ended(measured) if self._dwell > SETTLE else None

    def rest(self, measured: Measurement) -> None:
        """Let the jaws rest where they are."""
        self.ramp.rest(reached(measured, self._chain))

    def _ended(self, measured: Measurement) -> Ending:
        found, failure = self._found(measured), None
        if found.error is not None and abs(found.error) > TOLERANCE:
            message = (
                f"the jaws stand {abs(found.error) / MILLI:.1f} mm off the"
                f" {self._opening / MILLI:g} mm that were asked for"
            )
            failure = Failure(
                category="outcome", code="opening_not_reached", message=message
            )
        return Ending(Grip.RELEASED, failure=failure, finding=found)

    def _found(self, measured: Measurement) -> Moved:
        opening = measured.opening.value
        error = None if opening is None else opening - self._opening
        return Moved(opening=opening, error=error, current=self.ramp.current)
