"""What comes of a command that leaves the object where it is: between the jaws."""

from gripperd.control.command import GraspOrder, GraspResult, Outcome
from gripperd.control.ending import Ending
from gripperd.control.held import Held
from gripperd.control.meaning import failure
from gripperd.control.profile import Mode
from gripperd.control.states import Grip
from gripperd.errors import DomainError
from gripperd.model import Chain, PressedObject
from gripperd.signals import Measurement

GRIP_AFTER = {Outcome.SLIPPED: Grip.PART_LOST, Outcome.UNKNOWN: Grip.UNKNOWN}
"""What the jaws hold when it is not what they held before."""


def kept(
    held: Held,
    outcome: Outcome,
    measured: Measurement,
    chain: Chain,
    *,
    current: float,
    duration: float,
) -> Ending:
    """End with what is held, how hard, and how far that is from both limits.

    Parameters
    ----------
    held
        What is held, and how it was to be held.
    outcome
        What came of it.
    measured
        The newest measurement.
    chain
        The model of the gripper.
    current
        Valve current asked for. [A]
    duration
        From start to verdict. [s]
    """
    force, profile = measured.grip.value, held.profile
    predicted, std = _expected(held, measured, chain, current)
    result = GraspResult(
        outcome=outcome,
        size=held.size,
        opening=measured.opening.value,
        force=force,
        force_quality=measured.grip.quality,
        predicted_force=predicted,
        predicted_std=std,
        current=current,
        pressure=measured.pressure.value,
        slip_margin=force / profile.slip_force if force else None,
        crush_margin=profile.damage_force / force if force else None,
        duration=duration,
    )
    grip = GRIP_AFTER.get(outcome, Grip.HOLDING)
    return Ending(
        grip,
        result,
        failure(result, _order(held, current, chain)),
        held=held if grip is Grip.HOLDING else None,
    )


def _order(held: Held, current: float, chain: Chain) -> GraspOrder:
    """The grasp that would have led to the same."""
    mode = Mode.CURRENT if held.force is None else Mode.FORCE
    target = current if held.force is None else held.force
    return GraspOrder(profile=held.profile, mode=mode, target=target, model=chain.name)


def _expected(
    held: Held, measured: Measurement, chain: Chain, current: float
) -> tuple[float | None, float | None]:
    """What the model says about this object, and its standard deviation. [N, N]."""
    opening = measured.opening.value
    if opening is None:
        return None, None
    try:
        force = float(chain.grip_force(current, opening, held.travel))
        std = chain.std(current, PressedObject(opening), held.travel)
    except DomainError:
        return None, None
    return max(force, 0.0), std
