"""What an outcome means, in a sentence with the numbers."""

from gripperd.control.command import Failure, GraspOrder, GraspResult, Outcome
from gripperd.control.profile import Mode
from gripperd.units import MILLI

DISAGREEMENT = 3.0
"""Standard deviations by which force and prediction may differ in silence. [-]"""


def failure(result: GraspResult, order: GraspOrder) -> Failure | None:
    """Why a grasp is not what was asked for; None when it is."""
    if result.outcome is Outcome.HELD:
        return None
    return Failure(
        category="outcome", code=result.outcome, message=_sentence(result, order)
    )


def doubt(result: GraspResult) -> str | None:
    """What to say when measurement and model do not agree."""
    force, predicted = result.force, result.predicted_force
    std = result.predicted_std
    if force is None or predicted is None or std is None:
        return None
    if abs(force - predicted) <= DISAGREEMENT * std:
        return None
    return (
        f"measured {force:.1f} N, predicted {predicted:.1f} ± {std:.1f} N:"
        " valve, air, sensor or model is off"
    )


def _sentence(result: GraspResult, order: GraspOrder) -> str:
    profile = order.profile
    size = _value(result.size, MILLI, "mm")
    force = _value(result.force, 1.0, "N")
    least = f"{(profile.diameter - profile.smaller) / MILLI:.1f} mm"
    most = f"{(profile.diameter + profile.larger) / MILLI:.1f} mm"
    name = profile.name
    match result.outcome:
        case Outcome.NO_OBJECT:
            return f"the jaws closed past {least} without meeting an object"
        case Outcome.TOO_SMALL:
            return f"the object has {size}, {name} at least {least}; held lightly only"
        case Outcome.TOO_LARGE:
            return f"the object has {size}, {name} at most {most}; held lightly only"
        case Outcome.FORCE_NOT_REACHED:
            return (
                f"{force} per jaw at {result.current / MILLI:.2f} mA, not {_aim(order)}"
            )
        case Outcome.SLIPPED:
            return (
                f"the object slipped at {force}: it is heavier or smoother than {name}"
            )
        case Outcome.CRUSH_LIMIT:
            return (
                f"{force} per jaw came too close to the {profile.damage_force:g} N that"
                f" damage {name}; the force was reduced"
            )
        case _:
            return "no sensor could tell what is between the jaws"


def _aim(order: GraspOrder) -> str:
    if order.mode is Mode.FORCE:
        return f"the {order.target:.1f} N that were asked for"
    needed = order.profile.slip_force * order.profile.slip_margin
    return f"the {needed:.2f} N that {order.profile.name} needs"


def _value(value: float | None, unit: float, symbol: str) -> str:
    return f"an unknown {symbol}" if value is None else f"{value / unit:.1f} {symbol}"
