"""How long the present grip lasts, as a document."""

from pydantic import Field

from gripperd.config import GripperSettings
from gripperd.control.budget import Cause, budget
from gripperd.control.held import Held
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Grip
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.service.assumption import unnamed_held
from gripperd.service.rendering import Document, known


class BudgetDocument(Document):
    """Seconds until the grip force is under the slip limit; null: it stays above."""

    air_s: float | None = Field(description="After the loss of air.")
    power_s: float | None = Field(description="After the loss of power.")
    bus_s: float | None = Field(description="After the loss of the bus.")
    limited_by: Cause | None
    assumed: bool = Field(
        description="Nobody has said what is held: it is taken for an object that may"
        " slip at two thirds of the highest force since."
    )


def hold_budget(
    state: GripperState, settings: GripperSettings
) -> BudgetDocument | None:
    """The budget by the last measurement, less the time since."""
    if state.measured is None or state.age is None:
        return None
    if state.model_digest != settings.chain.digest:
        return None
    held = state.held or _assumed(state, settings.chain)
    if held is None:
        return None
    found = budget(
        held,
        state.measured,
        settings.chain,
        fail_mode=settings.fail_mode,
        worst_leak=settings.worst_leak,
    )
    if found is None:
        return None
    return BudgetDocument(
        air_s=known("s", max(found.air - state.age, 0.0)),
        power_s=known("s", max(found.power - state.age, 0.0)),
        bus_s=known("s", max(found.bus - state.age, 0.0)),
        limited_by=found.limited_by,
        assumed=state.held is None,
    )


def _assumed(state: GripperState, chain: Chain) -> Held | None:
    """What is held, if all that is known of it is how hard it was held."""
    if state.grip is not Grip.HOLDING or not state.strongest or state.measured is None:
        return None
    try:
        return unnamed_held(state.measured.opening.value, state.strongest, chain)
    except DomainError:
        return None
