"""Play in a linkage, wherever in it the jaws lie when a sweep begins."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import LINKAGE, MODEL, altered, moments, recording, with_jaws

RIVALS = (
    "linkage_backlash", "linkage_friction", "jaw_compliance", "series_compliance",
    "length_datum", "channel_delay",
)  # fmt: skip
HALF = 2e-3
"""Of the opening that is lost. [m]"""


def _parked_open(told: Array) -> Array:
    """Every sweep, be it from rest length or not, begins with the jaws pushed open."""
    found, held = [], told[0] + HALF
    for wide in told:
        held = min(max(held, wide - HALF), wide + HALF)
        found.append(held)
    return np.array(found)


def test_where_jaws_are_parked_is_not_held_against_their_play() -> None:
    told = altered(with_jaws(recording()), moments().keys(), "opening", _parked_open)
    library = {name: EFFECTS[name] for name in RIVALS}
    found = diagnose(told, replace(MODEL, linkage=LINKAGE), {}, library)
    assert [entry.name for entry in found.named] == ["linkage_backlash"]
    assert found.verdict is Verdict.NAMED
    gap = found.gaps[Signal.OPENING]
    assert gap.after < min(1.4 * gap.noise_floor, 0.3 * gap.recalibrated)
