"""The jaws against the pressure: something keeps them from moving."""

from collections import deque
from collections.abc import Iterator

from gripperd.control.force import ForceSense
from gripperd.control.grasp import CLOSED
from gripperd.control.monitors.part import CERTAIN
from gripperd.control.monitors.policy import Cause
from gripperd.control.monitors.sight import Lasting, Sight, Symptom
from gripperd.errors import DomainError
from gripperd.model import Direction
from gripperd.units import KILO, MILLI

STILL_FOR = 0.15
"""How long the jaws are watched to tell whether they move. [s]"""
STILL = 0.3e-3
"""Motion in that time that counts as none, if noise is not more. [m]"""
STOPS = 2.0
"""The jaws may rest against a stop: so many times the opening that is closed. [-]"""


class JawBlocked:
    """Muscle or spring should move the jaws, no object holds them, and they stand."""

    def __init__(self) -> None:
        self._force = ForceSense()
        self._openings: deque[tuple[float, float]] = deque()
        self._clock = 0.0
        self._present = Lasting()

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in the symptom."""
        self._clock += dt
        measured = sight.measured
        self._force.update(measured, dt)
        opening, pressure = measured.opening.value, measured.pressure.value
        policy = sight.policies[Cause.JAW_BLOCKED]
        blocked = False
        unmet = 0.0
        if opening is None or pressure is None:
            self._openings.clear()
        elif self._still(opening, sight.scatter.opening) and self._feels_nothing:
            unmet = _unmet(sight, pressure, opening)
            blocked = abs(unmet) > (policy.limit or 0.0)
        if self._present.update(blocked, dt) >= policy.after:
            assert opening is not None
            assert pressure is not None
            way = "close" if unmet > 0 else "open"
            yield Symptom(
                Cause.JAW_BLOCKED,
                f"the jaws do not {way}: they stand at {opening / MILLI:.1f} mm and"
                f" press on nothing, although {pressure / KILO:.0f} kPa leave"
                f" {abs(unmet):.0f} N per jaw to {way} them",
            )

    @property
    def _feels_nothing(self) -> bool:
        return self._force.measured and not self._force.touching

    def _still(self, opening: float, scatter: float) -> bool:
        self._openings.append((self._clock, opening))
        while self._clock - self._openings[0][0] > STILL_FOR:
            self._openings.popleft()
        seen = [each for _, each in self._openings]
        return max(seen) - min(seen) < max(STILL, CERTAIN * scatter)


def _unmet(sight: Sight, pressure: float, opening: float) -> float:
    """Force per jaw that ought to move them; above 0 to close, 0 for none. [N]."""
    chain = sight.chain
    reach = STOPS * CLOSED
    try:
        closing = float(chain.grip_at(pressure, opening))
        opens = float(chain.grip_at(pressure, opening, Direction.EXTENDING))
    except DomainError:
        return 0.0
    if closing > 0 and opening > reach:
        return closing
    if opens < 0 and opening < chain.linkage.open_width - reach:
        return opens
    return 0.0
