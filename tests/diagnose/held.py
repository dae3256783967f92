"""A muscle that a frame holds at three lengths; the frame may yield."""

import numpy as np

from gripperd.diagnose.readings.recording import Recording
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run

SIZE = 240
STEP = 0.05
COMPLIANCE = 3e-6
"""A thousand newtons shorten the muscle by 0.3 %. [1/N]"""


def up_and_down() -> Array:
    """A force that rises and falls. [N]"""
    return np.interp(np.linspace(0.0, 2.0, SIZE), [0.0, 1.0, 2.0], [0.0, 1e3, 0.0])


def held(compliance: float) -> Recording:
    """Three sweeps alike but for their length."""
    force = up_and_down()
    runs = tuple(
        run(
            str(place),
            time=60.0 * place + STEP * np.linspace(0, SIZE - 1, SIZE),
            pressure=500.0 * force + noise(SIZE, 1e3, 10 + place),
            contraction=lengths(place, compliance) + noise(SIZE, 8e-4, 20 + place),
            force=force + noise(SIZE, 3.0, 30 + place),
        )
        for place in range(3)
    )
    return Recording("held", "", runs)


def lengths(place: int, compliance: float) -> Array:
    """Contraction of one of the sweeps, without noise. [-]"""
    return 0.04 + 0.02 * place + compliance * up_and_down()
