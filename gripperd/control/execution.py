"""The command that runs: its motion, and what its end means."""

from collections.abc import Mapping
from dataclasses import replace

from gripperd.control.adjust import Adjustment
from gripperd.control.admission import Scene
from gripperd.control.command import (
    Command,
    Failure,
    Outcome,
    Status,
)
from gripperd.control.ending import Ending
from gripperd.control.grasp import Grasp
from gripperd.control.held import Held
from gripperd.control.meaning import doubt, failure
from gripperd.control.motion import Motion, begin
from gripperd.control.release import Release
from gripperd.control.states import Grip
from gripperd.model import Direction
from gripperd.signals import Measurement
from gripperd.units import MILLI

GRIP_AFTER: Mapping[Outcome, Grip | None] = {
    Outcome.HELD: Grip.HOLDING,
    Outcome.TOO_SMALL: Grip.HOLDING,
    Outcome.TOO_LARGE: Grip.HOLDING,
    Outcome.FORCE_NOT_REACHED: None,
    Outcome.CRUSH_LIMIT: Grip.HOLDING,
    Outcome.NO_OBJECT: Grip.NO_PART,
    Outcome.SLIPPED: Grip.PART_LOST,
    Outcome.UNKNOWN: Grip.UNKNOWN,
}
"""What the jaws hold after a grasp; an unwanted object is not let go of unasked.

None: a force too small may be that of an object, or of none that was ever touched.
"""


class Execution:
    """One command while it runs."""

    def __init__(self, command: Command, scene: Scene, wall: float) -> None:
        chain, current = scene.chain, scene.current
        order = command.order and replace(command.order, model=chain.name)
        self.command = replace(
            command, status=Status.RUNNING, started_at=wall, order=order
        )
        self._before = scene.held
        self.motion: Grasp | Release | Motion
        if command.task is not None:
            self.motion, self.grip = begin(command.task, scene)
        elif order is not None:
            self.motion = Grasp(order, chain, current)
            self.grip = Grip.CLOSING
        else:
            self.motion = Release(chain, current)
            self.grip = Grip.RELEASING

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period; write ``motion.ramp.current`` afterwards."""
        if isinstance(self.motion, Grasp):
            outcome = self.motion.step(measured, dt)
            self._note(self.motion)
            return None if outcome is None else self._grasped(outcome, measured)
        if not isinstance(self.motion, Release):
            return self.motion.step(measured, dt)
        opened = self.motion.step(measured, dt)
        return None if opened is None else _released(opened=opened)

    @property
    def held(self) -> Held | None:
        """What is held if it is cut short now, where that is known."""
        if isinstance(self.motion, Adjustment):
            return self.motion.held
        if isinstance(self.motion, Grasp):
            return self.motion.held(Outcome.UNKNOWN)
        # What was held before, with the current as it is by now.
        return self._before and self._before.at(None, Direction.EXTENDING)

    def _note(self, grasp: Grasp) -> None:
        """Keep a line for each phase, for whoever reads the command later."""
        if grasp.phase == self.command.phase:
            return
        current = grasp.ramp.current / MILLI
        line = f"{grasp.elapsed:.2f} s: {grasp.phase} from {current:.2f} mA"
        log = (*self.command.log, line)
        self.command = replace(self.command, phase=grasp.phase, log=log)

    def _grasped(self, outcome: Outcome, measured: Measurement) -> Ending:
        assert isinstance(self.motion, Grasp)
        result = self.motion.result(outcome, measured)
        line = f"{self.motion.elapsed:.2f} s: {outcome}"
        log = (*self.command.log, line, *filter(None, [doubt(result)]))
        self.command = replace(self.command, log=log)
        return Ending(
            GRIP_AFTER[outcome],
            result,
            failure(result, self.motion.order),
            held=self.motion.held(outcome),
        )


def _released(*, opened: bool) -> Ending:
    if opened:
        return Ending(Grip.RELEASED)
    stuck = Failure(
        category="outcome",
        code="not_released",
        message="the current is at the live zero, but pressure or force remain",
    )
    return Ending(Grip.UNKNOWN, failure=stuck)
