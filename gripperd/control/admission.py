"""Whether a task may begin, given what the jaws hold."""

from dataclasses import dataclass

from gripperd.control.command import GraspOrder
from gripperd.control.evaluation import check
from gripperd.control.held import Held
from gripperd.control.move import current_for
from gripperd.control.profile import Mode
from gripperd.control.states import Grip
from gripperd.control.tare import check_unloaded
from gripperd.control.task import Adjust, Adopt, Move, SelfTest, Tare, Task, Vent
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Measurement


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Everything that a command finds when it begins."""

    chain: Chain
    current: float
    """Valve current asked for. [A]"""
    measured: Measurement
    grip: Grip
    held: Held | None
    """What is held, where that is known."""
    objection: str | None
    """Why moving could let go of something."""
    zero: float
    """Of the force sensor. [N]"""


def admit(task: Task, scene: Scene) -> None:
    """Refuse a task that may not begin.

    Raises
    ------
    Refused
        With what would have to be different.
    """
    match task:
        case Adjust():
            _admit_adjust(task, scene)
        case Adopt():
            _admit_adoption(scene)
        case Move():
            _check_free(scene)
            current_for(task.opening, scene.chain)
        case SelfTest():
            _check_free(scene)
            check_unloaded(scene.measured, scene.chain, scene.current)
        case Tare():
            check_unloaded(scene.measured, scene.chain, scene.current)
        case Vent():
            pass


def adjusted(task: Adjust, held: Held) -> tuple[Mode, float]:
    """What an adjustment aims at: current [A] or force per jaw [N]."""
    if task.current is not None:
        return Mode.CURRENT, task.current
    if task.force is not None:
        return Mode.FORCE, task.force
    profile = held.profile
    aim = profile.current if profile.mode is Mode.CURRENT else profile.force
    return profile.mode, aim


def _admit_adjust(task: Adjust, scene: Scene) -> None:
    held = scene.held
    if scene.grip is not Grip.HOLDING:
        message = f"there is nothing to hold harder or lighter: {scene.grip}"
        raise Refused(message, code="wrong-state", hints=("grasp first",))
    if held is None:
        message = "it is not known which limits apply to what is held"
        hints = ("give hold with a profile first",)
        raise Refused(message, code="wrong-state", hints=hints)
    mode, target = adjusted(task, held)
    check(
        GraspOrder(
            profile=held.sized, mode=mode, target=target, model=scene.chain.name
        ),
        scene.chain,
    )


def _admit_adoption(scene: Scene) -> None:
    if scene.held is not None:
        message = f"{scene.held.profile.name} is held under its profile already"
        hints = ("adjust it, or release it first",)
        raise Refused(message, code="object-held", hints=hints)
    if scene.grip is not Grip.HOLDING:
        message = f"there is nothing to be taken over: {scene.grip}"
        raise Refused(message, code="wrong-state", hints=("grasp instead",))


def _check_free(scene: Scene) -> None:
    if scene.objection is not None:
        hints = ("release first",)
        raise Refused(scene.objection, code="object-held", hints=hints)
