"""Effects that were not tested: for what was recorded, or for what the model is."""

from dataclasses import dataclass

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import KEPT
from gripperd.diagnose.statement import reasons

ABSENT = " is not in the model"
"""End of a reason that no other recording would change."""


@dataclass(frozen=True, slots=True)
class Untested:
    """Lines such as ``leak: pressure not measured``, one a reason."""

    recording: tuple[str, ...]
    """What this recording cannot show."""
    model: tuple[str, ...]
    """What this model has already, or what acts on an effect that it has not."""


def untested(diagnosis: Diagnosis) -> Untested:
    """Tell what was not tested, the effects before the reason."""
    of_recording: list[str] = []
    of_model: list[str] = []
    for reason, names in reasons(diagnosis).items():
        lines = of_model if reason.endswith((ABSENT, KEPT)) else of_recording
        lines.append(f"{', '.join(names)}: {reason}")
    return Untested(tuple(of_recording), tuple(of_model))
