"""The valve output: what was asked for, what was written, what someone else set."""

from gripperd.control.command import Failure
from gripperd.units import MILLI

WRITE_STEP = 0.5e-6
"""Half a count of a µA module: a smaller change of current is none. [A]"""
FOREIGN_STEP = 20e-6
"""A read-back that differs by more was written by someone else. [A]"""


class Output:
    """The valve current of one gripper. [A]."""

    def __init__(self) -> None:
        self.current = 0.0
        """What is asked for."""
        self.written = 0.0
        """What the module was last told, or was found to do."""
        self.adopted = False
        """Whether the present current was found, not commanded."""
        self._strange = 0
        self._read: float | None = None
        self._overruled: tuple[float, float] | None = None

    def adopt(self, found: float) -> bool:
        """Take over what the module does; whether it still does what it did for us."""
        # A write that was lost with the link leaves the module as it was read before.
        known = [] if self._read is None else [self._read, self.written]
        ours = any(abs(found - each) <= FOREIGN_STEP for each in known)
        if known and not ours:
            self._overruled = self.written, found
        self._read = found
        self.current = self.written = found
        self.adopted = True
        self._strange = 0
        return ours

    def foreign(self, found: float) -> bool:
        """Whether the read-backs show that someone else wrote.

        Two in a row: one may have been on its way while the current was written.
        """
        differs = abs(found - self.written) > FOREIGN_STEP
        self._strange = self._strange + 1 if differs else 0
        if not differs:
            self._read = found
        return self._strange >= 2

    def take_overruled(self) -> tuple[float, float] | None:
        """Give once what was told and what was found instead. [A, A]."""
        change, self._overruled = self._overruled, None
        return change

    def dispute(self, found: float) -> Failure:
        """What it means for a command that someone else wrote."""
        message = (
            f"the output reads {found / MILLI:.3f} mA, not the"
            f" {self.written / MILLI:.3f} mA that were written"
        )
        return Failure(category="fault", code="output-changed", message=message)

    def change(self) -> float | None:
        """What to write now, None while the module does what is asked."""
        if abs(self.current - self.written) < WRITE_STEP:
            return None
        self.written = self.current
        self.adopted = False
        return self.current
