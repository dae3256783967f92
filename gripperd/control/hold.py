"""What the jaws hold: as commanded, as found, as lost."""

from gripperd.control.states import SIGNS, Grip, gripped
from gripperd.control.watch import GripWatch
from gripperd.signals import Measurement

MAY_HOLD = frozenset({Grip.HOLDING, Grip.UNKNOWN})
"""What is held is not lost from sight for good, such as by a lost link."""

EMPTY = frozenset({Grip.RELEASED, Grip.NO_PART})
"""Nothing is held, for sure."""


class Hold:
    """The grip state of one gripper, and whose object it is."""

    def __init__(self) -> None:
        self.grip = Grip.UNKNOWN
        self.profile: str | None = None
        """Profile of what is held, if a command of this life named it."""
        self.strongest: float | None = None
        """Highest grip force since something has been held. [N]"""
        self._watch = GripWatch()
        self._sought = False
        """Whether something was held, or missed, when the jaws were seen last."""

    def update(self, measured: Measurement, dt: float) -> None:
        """Take in the newest measurement."""
        self._watch.update(measured, dt)
        force = measured.grip.value
        if self.grip is Grip.HOLDING and force is not None:
            self.strongest = max(force, self.strongest or 0.0)

    def adopt(self, profile: str | None) -> None:
        """Go by what is seen: nobody here brought it about.

        Parameters
        ----------
        profile
            Of what was held when it was seen last, if it can only be that.
        """
        seen = self._watch.seen()
        if self._sought and seen in EMPTY:
            seen = Grip.PART_LOST
        self.settle(seen, profile)

    @property
    def unmoved(self) -> bool:
        """Whether the jaws are where they were when they were seen last."""
        return self._watch.unmoved

    def lose_sight(self) -> None:
        """Without a link, what is held may go any time."""
        self._sought = self.grip in {Grip.HOLDING, Grip.PART_LOST}
        self.settle(Grip.UNKNOWN, None)

    def settle(self, grip: Grip, profile: str | None) -> None:
        """Go by how a command began or ended."""
        self.grip = gripped(self.grip, SIGNS[grip])
        self.profile = profile if self.grip is Grip.HOLDING else None
        if self.grip not in MAY_HOLD:
            self.strongest = None
        self._watch.hold()

    @property
    def interrupted(self) -> Grip:
        """Grip when a motion is cut short now."""
        return self._watch.interrupted

    def look(self, *, adopted: bool) -> None:
        """See what was lost, and while the current is adopted, what has come."""
        if self.grip is Grip.HOLDING and self._watch.lost:
            self.settle(Grip.PART_LOST, None)
        elif adopted and self.grip not in {Grip.HOLDING, Grip.PART_LOST}:
            seen = self._watch.seen()
            if seen is not self.grip:
                self.settle(seen, None)

    def objection(self, *, vented: bool) -> str | None:
        """Why a grasp now could let go of something; None when it could not.

        Parameters
        ----------
        vented
            Whether the current is at the live zero, so that nothing can be held.
        """
        if self.grip is Grip.HOLDING:
            return f"{self.profile or 'an object'} is being held"
        if self.grip is Grip.UNKNOWN and not vented:
            return "it is not known what the jaws hold"
        return None
