"""What the noise of the rig's own sensors leaves of a residual."""

from collections.abc import Mapping
from typing import cast

import numpy as np

KILO, MILLI = 1e3, 1e-3


def sensor_floors(truth: Mapping[str, object]) -> dict[str, float]:
    """Floor of each signal from the noise that the rig truly put on. SI.

    Inputs without their noise are taken for granted where a diagnosis smooths them:
    pressure and contraction ahead of the force. The opening is compared with the
    contraction, and the grip with the force, reading by reading.
    """
    told = cast("dict[str, float]", truth["noise_floor"])
    rig = cast("dict[str, float]", truth["rig"])
    travel = rig["ratio"] * rig["rest_length"] * told["contraction"]
    return {
        "pressure": told["pressure_kPa"] * KILO,
        "force": told["force_N"],
        "opening": float(np.hypot(told["opening_mm"] * MILLI, travel)),
        "grip": float(np.hypot(told["grip_N"], told["force_N"] / rig["ratio"])),
    }
