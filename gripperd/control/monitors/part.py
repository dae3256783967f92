"""The held part: gone, slipping, held less or more than it was, held too hard."""

from collections.abc import Iterator

from gripperd.control.monitors.policy import Cause
from gripperd.control.monitors.sight import Lasting, Sight, Smooth, Symptom
from gripperd.control.states import Grip
from gripperd.signals import Quality
from gripperd.units import MILLI

CERTAIN = 6.0
"""Standard deviations that noise does not reach in years at 100 Hz. [-]"""
SETTLED = 0.5
"""After a motion the jaws have come to rest. [s]"""


class PartLost:
    """What was held is gone; seen by the watch of the grip."""

    def __init__(self) -> None:
        self._held: tuple[float | None, float | None] = (None, None)
        self._taken = False
        self._name = "the part"

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in the symptom."""
        measured = sight.measured
        if sight.grip is Grip.HOLDING:
            self._name = sight.profile.name if sight.profile else "the part"
            # A motion that ends has changed how it is held.
            if sight.idle and not self._taken:
                self._held = measured.grip.value, measured.opening.value
            self._taken = sight.idle
        elif sight.grip is Grip.PART_LOST:
            force, opening = self._held
            was = f"{_newtons(force)} at {_millimetres(opening)}"
            now_force, now_opening = measured.grip.value, measured.opening.value
            now = f"{_newtons(now_force)} at {_millimetres(now_opening)}"
            text = f"{self._name} is gone from the jaws: {was} became {now}"
            yield Symptom(Cause.PART_LOST, text)
        else:
            self._taken = False


class Slip:
    """The jaws close although nobody tells them to: the part moves between the pads."""

    FAST, SLOW = 0.03, 0.5
    """Time constants; the difference sees what happens in between. [s]"""
    SHARE = 0.41
    """Of the noise that is left behind the fast low pass at 100 Hz. [-]"""
    DROP = 0.15
    """Share of the force whose sudden loss makes a third of the closing enough. [-]"""

    def __init__(self) -> None:
        self._begin()

    def _begin(self) -> None:
        self._opening = Smooth(self.FAST), Smooth(self.SLOW)
        self._force = Smooth(self.FAST), Smooth(self.SLOW)
        self._held, self._present = Lasting(), Lasting()

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in the symptom."""
        held = self._held.update(sight.holding, dt)
        if held < 0:
            self._begin()
            return
        measured, policy = sight.measured, sight.policies[Cause.SLIP]
        limit = policy.limit or 0.0
        now, before = (s.update(measured.opening.value, dt) for s in self._opening)
        felt, was = (s.update(measured.grip.value, dt) for s in self._force)
        closing = 0.0 if now is None or before is None else before - now
        gain = 0.0 if felt is None or was is None else felt - was
        sure = CERTAIN * self.SHARE * sight.scatter.opening
        if was and gain < -max(self.DROP * was, CERTAIN * sight.scatter.grip):
            limit /= 3
        # A pressure that rises closes the jaws too, and presses harder.
        slips = (
            held > SETTLED
            and closing > max(limit, sure)
            and gain < CERTAIN * self.SHARE * sight.scatter.grip
        )
        if self._present.update(slips, dt) >= policy.after:
            yield Symptom(
                Cause.SLIP,
                f"the part slips: the jaws closed by {closing / MILLI:.2f} mm to"
                f" {_millimetres(now)} within {self.SLOW:g} s, and {_newtons(was)}"
                f" became {_newtons(felt)}",
            )


class ForceDrift:
    """The grip force goes away slowly from what it was at the beginning."""

    SMOOTHING = 1.0
    """Time constant. [s]"""
    REFERENCE = 2.0
    """When the force of the beginning is taken. [s]"""

    def __init__(self) -> None:
        self._begin(None)

    def _begin(self, quality: Quality | None) -> None:
        self._quality = quality
        self._force = Smooth(self.SMOOTHING)
        self._first: float | None = None
        self._held, self._present = Lasting(), Lasting()

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in the symptom."""
        force = sight.measured.grip
        # A model that takes over from a sensor is off by its own error, not adrift.
        if not sight.holding or force.quality is not self._quality:
            self._begin(force.quality)
        held = self._held.update(sight.holding, dt)
        if held < SETTLED:
            return
        now = self._force.update(force.value, dt)
        if held < self.REFERENCE or now is None:
            return
        if self._first is None:
            self._first = now
        policy = sight.policies[Cause.FORCE_DRIFT]
        limit = max((policy.limit or 0.0) * self._first, sight.scatter.grip)
        away = abs(now - self._first) > limit
        if self._present.update(away, dt) >= policy.after:
            yield Symptom(
                Cause.FORCE_DRIFT,
                f"{_newtons(self._first)} per jaw became {_newtons(now)} in"
                f" {held:.0f} s of holding; {limit:.1f} N are allowed",
            )


class OverForce:
    """The part is held harder than it can bear for sure."""

    SMOOTHING = 0.03
    """Time constant: one spike is no force. [s]"""

    def __init__(self) -> None:
        self._force = Smooth(self.SMOOTHING)
        self._present = Lasting()

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in the symptom."""
        now = self._force.update(sight.measured.grip.value, dt)
        profile = sight.profile if sight.holding else None
        policy = sight.policies[Cause.OVER_FORCE]
        limit = (policy.limit or 0.0) * profile.damage_force if profile else None
        over = limit is not None and now is not None and now > limit
        if self._present.update(over, dt) >= policy.after and profile and limit:
            yield Symptom(
                Cause.OVER_FORCE,
                f"{_newtons(now)} per jaw on {profile.name} is over {limit:.1f} N; it"
                f" is damaged at {profile.damage_force:g} N",
            )


def _newtons(force: float | None) -> str:
    return "an unknown force" if force is None else f"{round(force, 1) + 0.0:.1f} N"


def _millimetres(opening: float | None) -> str:
    return "an unknown opening" if opening is None else f"{opening / MILLI:.1f} mm"
