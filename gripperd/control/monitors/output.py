"""The valve current as the module reads back, against what it was told."""

from collections.abc import Iterator

from gripperd.control.monitors.policy import Cause
from gripperd.control.monitors.sight import Sight, Symptom
from gripperd.control.output import FOREIGN_STEP, Output
from gripperd.units import MILLI


def overruled(output: Output, sight: Sight) -> Iterator[Symptom]:
    """Say once that the module was found to do something else than it was told."""
    change = output.take_overruled()
    if change is None:
        return
    told, found = (f"{current / MILLI:.3f} mA" for current in change)
    lowest = sight.chain.regulator.current_low + FOREIGN_STEP
    if change[1] <= lowest < change[0]:
        text = (
            f"the output module reads {found} where {told} were set: it was restarted,"
            " or another master wrote; nothing is written until this is reset"
        )
        yield Symptom(Cause.MODULE_RESTARTED, text)
        return
    text = f"the output reads {found} where {told} were set: something else wrote"
    yield Symptom(Cause.OUTPUT_CHANGED, text)
