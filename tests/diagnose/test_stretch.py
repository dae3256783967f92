"""What bends under the grip, and what stretches under the pull of the muscle.

The two differ by the return spring alone, so that a wrong curve of one looks like the
other.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.readings.recording import Recording
from gripperd.effects import EFFECTS
from gripperd.model.effect import acts_in_gripper
from gripperd.model.track import Array
from tests.diagnose.small import LINKAGE, MODEL, recording, with_grip, with_jaws

RIVALS = (
    "jaw_compliance", "series_compliance", "linkage_backlash", "linkage_friction",
    "length_datum", "force_sensor_bias",
)  # fmt: skip
WIDER = 3e-3
"""Opening at the largest load. [m]"""


def _hertz(load: Array) -> Array:
    """K. L. Johnson, "Contact Mechanics", 1985, eq. (4.23): a round pad. [-]."""
    return np.maximum(load / np.nanmax(load), 0.0) ** (2 / 3)


def _parallel(load: Array) -> Array:
    """A finger of steel: R. J. Roark's cantilever. [-]."""
    return np.maximum(load / np.nanmax(load), 0.0)


def _wider(plain: Recording, load: str, curve: Callable[[Array], Array]) -> Recording:
    loads = np.concatenate([run.columns[load] for run in plain.runs])
    cuts = np.cumsum([run.columns[load].size for run in plain.runs])[:-1]
    runs = [
        replace(run, columns={**run.columns, "opening": run.columns["opening"] + more})
        for run, more in zip(
            plain.runs, np.split(WIDER * curve(loads), cuts), strict=True
        )
    ]
    return replace(plain, runs=tuple(runs))


@pytest.mark.parametrize(
    ("load", "name"), [("grip", "jaw_compliance"), ("force", "series_compliance")]
)
@pytest.mark.parametrize("curve", [_hertz, _parallel])
def test_each_is_told_whatever_its_curve(
    load: str, name: str, curve: Callable[[Array], Array]
) -> None:
    told = _wider(with_jaws(with_grip(recording())), load, curve)
    library = {one: EFFECTS[one] for one in RIVALS}
    found = diagnose(told, replace(MODEL, linkage=LINKAGE), {}, library)
    assert [(one.name, one.equivalents) for one in found.named] == [(name, ())]
    (effect,) = found.contest.best.fit.point.effects
    assert acts_in_gripper(effect)
    top = max(float(np.nanmax(run.columns[load])) for run in told.runs)
    for share in (0.3, 0.6, 0.9):
        given = effect.widening(share * top, share * top)
        expected = WIDER * curve(np.array([share, 1.0]))[0]
        assert given == pytest.approx(expected, rel=0.08)
