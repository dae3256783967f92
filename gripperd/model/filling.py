"""Filling and exhaust of a volume through a throttled regulator.

References
----------
.. [1] ISO 6358-1:2013, "Pneumatic fluid power - Determination of flow-rate
       characteristics of components using compressible fluids": an orifice lets
       through what goes with the absolute pressure before it, until the pressure
       behind it is no longer low; then less, by a quarter of an ellipse.
"""

from typing import NamedTuple

import numpy as np

from gripperd.model.compiled import compiled
from gripperd.model.track import Array

ATMOSPHERE = 101325.0
"""Absolute pressure into which a muscle exhausts. [Pa]"""
TOLD = 300e3
"""Gauge pressure at which the time constant of exhaust is told. [Pa]"""
CRITICAL = 0.3
"""Ratio of the pressures behind and before an orifice up to which it is choked: 0.2 to
0.5 for valves and tubes [1]_. [-]"""
NEWTON = 8
"""Steps of a root that is convex: up to 10 bar away, whatever orifice and choke hold up
of 99 %, so many left less than 0.01 Pa in 200 000 draws."""
SHORT = 0.25
"""Part of a time constant in which the outflow may be taken at its middle. [-]"""
FINEST = 64
"""Parts of one step at most: after 16 time constants nothing is left to exhaust."""


class Filling(NamedTuple):
    """How fast a volume fills and empties."""

    rise: float
    """Time constant of filling, near the goal. [s]"""
    fall: float
    """The same of exhaust, at 300 kPa. [s]"""
    orifice: float = 0.0
    """What an orifice holds up. [1/sqrt(Pa)]"""
    choke: float = 0.0
    """What a choke holds up. [1/Pa]"""
    sonic: float = 0.0
    """Share of the exhaust that goes with the pressure in the volume. [0..1]"""


def filled(signal: Array, step: Array, law: Filling, state: Array) -> Array:
    r"""Pressure of a volume that a regulator fills, or empties, to what it is told.

    At a distance ``e`` it nears by ``g e / (T (1 + o sqrt(e) + c e))``: through an
    orifice as the square root, and choked no faster than ``1 / (T c)``. As it fills
    ``g = 1``, and that is exact for a signal that is constant between samples. As it
    empties g is taken at the middle of each quarter of a time constant:

    .. math:: g = 1 - s + s \frac{p + p_a}{300\,\mathrm{kPa} + p_a}
        \sqrt{1 - \max\left(0, \frac{p_a / (p + p_a) - b}{1 - b}\right)^2}

    Parameters
    ----------
    signal
        What it is told, shape ``(n,)``. Gauge pressure. [Pa]
    step
        Time since the sample before, shape ``(n,)``. [s]
    law
        Of the regulator.
    state
        Pressure so far, shape ``(1,)``; it is moved on.
    """
    return compiled(_filled)(signal, step, law, state)


def _filled(signal: Array, step: Array, law: Filling, state: Array) -> Array:
    out = np.empty_like(signal)
    last = goal = state[0]
    for index in range(signal.size):
        goal = goal if np.isnan(signal[index]) else signal[index]
        last = goal if np.isnan(last) else last
        sonic = law.sonic if goal < last else 0.0
        passed = step[index] / (law.rise if goal > last else law.fall)
        parts = min(FINEST, 1 + int(passed / SHORT)) if sonic > 0 else 1
        # The first half of a part tells how fast it goes in the middle of it.
        halves = 2 if sonic > 0 else 1
        middle = last
        for half in range(halves * parts):
            absolute = max(middle, 0.0) + ATMOSPHERE
            past = max(0.0, (ATMOSPHERE / absolute - CRITICAL) / (1 - CRITICAL))
            flow = absolute / (TOLD + ATMOSPHERE) * np.sqrt(1 - past**2)
            whole = (half + 1) % halves == 0
            time = (1 - sonic + sonic * flow) * passed / parts / (1 if whole else 2)
            away = last - goal
            kept = np.exp(-time)
            if law.orifice + law.choke > 0 and away != 0:
                # log e + 2 o sqrt(e) + c e falls by t / T: Newton comes from above.
                far = np.log(abs(away))
                slow, bent = law.orifice * np.exp(far / 2), law.choke * np.exp(far)
                end = far + 2 * slow + bent - time
                found = min(far, end)
                for _ in range(NEWTON):
                    slow = law.orifice * np.exp(found / 2)
                    bent = law.choke * np.exp(found)
                    found -= (found + 2 * slow + bent - end) / (1 + slow + bent)
                kept = np.exp(found - far)
            middle = goal + away * kept
            last = middle if whole else last
        out[index] = last
    state[0] = last
    return out
