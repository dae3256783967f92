"""What a command sets in motion."""

from typing import Protocol

from gripperd.control.adjust import Adjustment
from gripperd.control.admission import Scene, adjusted
from gripperd.control.adoption import Adoption
from gripperd.control.ending import Ending
from gripperd.control.move import Travel
from gripperd.control.release import Release
from gripperd.control.self_test import Trial
from gripperd.control.setpoint import Ramp
from gripperd.control.states import Grip
from gripperd.control.tare import Zeroing
from gripperd.control.task import Adjust, Adopt, Move, Tare, Task, Vent
from gripperd.signals import Measurement


class Motion(Protocol):
    """A command in progress that says by itself how it ends."""

    ramp: Ramp

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period; ``ramp.current`` is to be written."""

    def rest(self, measured: Measurement) -> None:
        """Let the jaws rest where they are."""


def begin(task: Task, scene: Scene) -> tuple[Motion | Release, Grip]:
    """Set a task in motion; gives the grip meanwhile, too.

    Raises
    ------
    GripperdError
        The model has no answer.
    """
    chain, current = scene.chain, scene.current
    match task:
        case Adjust():
            assert scene.held is not None
            aim = adjusted(task, scene.held)
            return Adjustment(aim, scene.held, chain, current), Grip.HOLDING
        case Adopt():
            return Adoption(task.profile, chain, current), scene.grip
        case Move():
            return Travel(task.opening, chain, current), Grip.MOVING
        case Vent():
            return Release(chain, current, float("inf")), Grip.RELEASING
        case Tare():
            return Zeroing(scene.zero, current), scene.grip
        case _:
            return Trial(chain, current), scene.grip
