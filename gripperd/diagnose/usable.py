"""Samples of a sweep that say something about a stage."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.course import Course, is_table
from gripperd.diagnose.stages import INPUTS
from gripperd.model.effect import Signal

Mask: TypeAlias = NDArray[np.bool_]

TRANSIENT = 0.06
"""A command that moves by more than this share of the span in one sample is a step."""


def usable(course: Course, signal: Signal, noise: float) -> Mask:
    """Samples of a signal that say something about its stage.

    Parameters
    ----------
    course
        The sweep.
    signal
        What is predicted.
    noise
        One sigma of a sample of it. [SI]
    """
    measured = course.column(signal.value)
    good = np.isfinite(measured)
    for name in INPUTS[signal]:
        good &= np.isfinite(course.level(name))
    if signal is Signal.GRIP:
        # Without contact the jaws are moved by the muscle alone and press on nothing.
        good &= (measured > 5 * noise) & np.isfinite(course.level("force"))
    sweeps = "pressure" in course.smooth and not is_table((course,))
    if sweeps and signal in (Signal.FORCE, Signal.PRESSURE):
        good &= ~_transients(course)
    if signal is Signal.FORCE:
        good &= ~_reversals(course)
    return good


def _reversals(course: Course) -> Mask:
    """Samples next to a reversal: which side of it they lie on is not known."""
    turned = np.diff(course.direction, prepend=course.direction[0]) != 0
    return _widened(turned, 2)


def _widened(near: Mask, reach: int) -> Mask:
    wide = near.copy()
    for shift in range(1, reach + 1):
        wide[shift:] |= near[:-shift]
        wide[:-shift] |= near[shift:]
    return wide


def _transients(course: Course) -> Mask:
    """Samples next to a step of pressure: two sensors never see it at once."""
    pressure = course.level("pressure")
    jump = np.abs(np.diff(pressure, prepend=pressure[0]))
    top = max(float(np.nanmax(np.abs(pressure))), 1.0)
    near = jump > TRANSIENT * top
    current = course.column("current")
    if np.isfinite(current).all():
        step = np.abs(np.diff(current, prepend=current[0]))
        near |= step > TRANSIENT * float(np.max(np.abs(current)))
    return _widened(near, 2)
