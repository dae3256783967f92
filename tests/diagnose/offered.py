"""Corrections made by hand: one reading, and nothing known beside it."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.correction.gaussian_process import LENGTHS, Kernel, Process
from gripperd.diagnose.correction.offer import Correction, Offer, Worth
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.model.effect import Signal


def bump() -> Offer:
    """It depends on the pressure, over 50 kPa, and not on the contraction."""
    kernel = Kernel(40.0, np.array([0.5, LENGTHS[1]]))
    centre = np.zeros((1, 2))
    # One reading of 30 N with a noise of 0.1 N.
    features = kernel.between(centre, centre) / 0.1
    process = Process.given(kernel, centre, features, np.array([300.0]))
    correction = Correction(
        signal=Signal.FORCE,
        regressors=(BY_QUANTITY["pressure"], BY_QUANTITY["contraction"]),
        process=process,
        usual=np.array([200e3, 0.1]),
        spread=np.array([100e3, 0.05]),
        ends=np.array([[0.0, 0.0], [400e3, 0.2]]),
        held={BY_QUANTITY["temperature"]: (294.15, 295.15)},
        wander=1.0,
    )
    return Offer(correction, Worth(20.0, 5.0, 375.0, 20.0, 0.75))


def around() -> Offer:
    """The same of the grip force, which depends on both."""
    offer = bump()
    process = replace(
        offer.correction.process, kernel=Kernel(40.0, np.array([0.5, 0.5]))
    )
    correction = replace(offer.correction, signal=Signal.GRIP, process=process)
    return replace(offer, correction=correction)
