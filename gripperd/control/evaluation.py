"""What a grasp would do, before anything moves, and whether it may."""

from dataclasses import dataclass

from gripperd.control.command import GraspOrder
from gripperd.control.profile import Mode
from gripperd.errors import DomainError, Refused
from gripperd.model import Chain, Prediction, PressedObject
from gripperd.units import KILO, MILLI

ROUNDING = 1e-9
"""A target exactly at a margin may come out this much beyond it. [-]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """A dry run of a grasp. SI values."""

    current: float
    """Valve current the grasp would end at. [A]"""
    prediction: Prediction
    slip_force: float
    """Least force per jaw that carries the object. [N]"""
    damage_force: float
    """Force per jaw that damages it. [N]"""
    slip_margin: float
    """Predicted force over `slip_force`. [-]"""
    crush_margin: float
    """`damage_force` over the predicted force. [-]"""
    reasons: tuple[str, ...]
    """Why the grasp is refused; empty when it may go ahead."""

    @property
    def feasible(self) -> bool:
        """Whether the grasp may go ahead."""
        return not self.reasons


def evaluate(order: GraspOrder, chain: Chain) -> Evaluation:
    """Predict a grasp and hold it against the limits of object and valve.

    Raises
    ------
    DomainError
        When the object does not fit between the jaws.
    """
    profile = order.profile
    chain.check_fits(profile.diameter)
    current, short = order.target, None
    if order.mode is Mode.FORCE:
        current, short = _current_for(order.target, profile.pressed, chain)
    prediction = chain.predict(current, profile.pressed)
    force = prediction.grip_force
    return Evaluation(
        current=current,
        prediction=prediction,
        slip_force=profile.slip_force,
        damage_force=profile.damage_force,
        slip_margin=force / profile.slip_force,
        crush_margin=profile.damage_force / force if force > 0 else float("inf"),
        reasons=(short,) if short else tuple(_reasons(order, chain, current, force)),
    )


def _current_for(
    force: float, pressed: PressedObject, chain: Chain
) -> tuple[float, str | None]:
    """Current for a force; the highest where none gives it, and what it does give."""
    highest = chain.regulator.current_high
    try:
        return chain.current_for(force, pressed), None
    except DomainError as beyond:
        if beyond.key != "pressure_kPa":
            raise
        return highest, f"{force:.2f} N per jaw cannot be had: {beyond}"


def _reasons(
    order: GraspOrder, chain: Chain, current: float, force: float
) -> list[str]:
    profile, regulator = order.profile, chain.regulator
    reasons = []
    most = float(chain.outlet.pressure(regulator.current_high))
    if not regulator.current_low <= current <= regulator.current_high:
        reasons.append(
            f"it takes {current / MILLI:.2f} mA, and the valve takes"
            f" {regulator.current_low / MILLI:g} to {regulator.current_high / MILLI:g}"
            f" mA (up to {most / KILO:g} kPa)"
        )
    highest = profile.damage_force / profile.crush_margin
    if force > highest * (1 + ROUNDING):
        reasons.append(
            f"{force:.2f} N per jaw is over {highest:.2f} N: {profile.name} is damaged"
            f" at {profile.damage_force:g} N, and its crush margin is"
            f" {profile.crush_margin:g}"
        )
    lowest = profile.slip_force * profile.slip_margin
    if force < lowest * (1 - ROUNDING):
        reasons.append(
            f"{force:.2f} N per jaw is under {lowest:.2f} N: {profile.name} slips at"
            f" {profile.slip_force:.2f} N, and its slip margin is"
            f" {profile.slip_margin:g}"
        )
    return reasons


def check(order: GraspOrder, chain: Chain) -> Evaluation:
    """Evaluate a grasp, and refuse it if it may not go ahead.

    Raises
    ------
    Refused
        With every reason and its numbers.
    """
    try:
        evaluation = evaluate(order, chain)
    except DomainError as error:
        raise Refused(str(error), code="infeasible") from error
    if not evaluation.feasible:
        raise Refused(
            "; ".join(evaluation.reasons),
            code="infeasible",
            hints=("evaluate the profile to see the margins before grasping",),
        )
    return evaluation
