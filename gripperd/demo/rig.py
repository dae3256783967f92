"""A muscle on a rig, written apart from the model that is to explain it.

It shares no code with :mod:`gripperd.model` and :mod:`gripperd.effects`, and the
hidden effects have other formulas than those of the library.

References
----------
.. [1] C.-P. Chou, B. Hannaford, "Measurement and modeling of McKibben pneumatic
       artificial muscles", IEEE Trans. Robotics Automation 12(1), 90-102, 1996: the
       pull of a braid.
.. [2] Y.-K. Wen, "Method for random vibration of hysteretic systems", J. Eng. Mech.
       Div. 102(2), 249-263, 1976.
.. [3] J. D. Ferry, "Viscoelastic Properties of Polymers", 3rd ed., Wiley, 1980,
       chapter 1: Voigt elements in series.
"""

from dataclasses import dataclass
from math import exp, pi, radians, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from gripperd.demo.hidden import Hidden
from gripperd.demo.programme import Programme

Array = NDArray[np.float64]

LENGTH, DIAMETER, ANGLE = 0.250, 20e-3, radians(25.0)
"""As drawn: rest length [m], diameter [m], braid angle [rad]."""
CURRENT, PRESSURE = (4e-3, 20e-3), (0.0, 500e3)
"""Ends of the line of the regulator. [A], [Pa]"""

MADE = 0.01
"""How far a constant as built is off, relative, one sigma. [-]"""
NOISE = {"force": 3.0, "pressure": 1e3, "contraction": 1e-4}
"""One sigma of each sensor. [N], [Pa], [-]"""
CORRELATION = 0.3
"""Of the noise of neighbouring samples. [-]"""

CREEP = ((0.025, 2.5), (0.03, 20.0))
"""Share of the pull that each Voigt element takes, and its time constant. [-], [s]"""
THRESHOLD = 18e3
"""Pressure that stretches the bladder before the braid carries. [Pa]"""
LOOP, SOFT = 22.0, 0.008
"""Half height of the hysteresis loop [N], and the travel that turns it [-]."""


@dataclass(frozen=True, slots=True)
class Readings:
    """What the sensors of the rig said in one sweep; arrays of one shape, SI."""

    time: Array
    current: Array
    pressure: Array
    contraction: Array
    force: Array


@dataclass(frozen=True, slots=True)
class Rig:
    """A muscle as it was built."""

    diameter: float
    angle: float
    span: float
    """Highest pressure of the regulator. [Pa]"""
    hidden: Hidden

    @classmethod
    def built(cls, hidden: Hidden, draws: np.random.Generator) -> "Rig":
        """Make a muscle, nearly as drawn."""
        off = 1 + MADE * np.clip(draws.standard_normal(3), -1.5, 1.5)
        return cls(
            DIAMETER * float(off[0]),
            ANGLE * float(off[1]),
            PRESSURE[1] * float(off[2]),
            hidden,
        )

    def run(self, programme: Programme, draws: np.random.Generator) -> Readings:
        """Run one sweep and read the sensors."""
        share, contraction = programme.pressure, programme.contraction
        pressure = self.span * share
        force = self.force(programme.time, pressure, contraction)
        low, high = CURRENT
        return Readings(
            time=programme.time,
            current=low + (high - low) * share,
            pressure=pressure + NOISE["pressure"] * _noise(share.size, draws),
            contraction=contraction + NOISE["contraction"] * _noise(share.size, draws),
            force=force + NOISE["force"] * _noise(share.size, draws),
        )

    def force(self, time: Array, pressure: Array, contraction: Array) -> Array:
        """Pull of the muscle along a sweep, without noise. [N].

        Parameters
        ----------
        time
            Since the start of the sweep, shape ``(n,)``. [s]
        pressure
            Gauge. [Pa]
        contraction
            Shortening relative to rest. [-]
        """
        match self.hidden:
            case Hidden.CREEP:
                return _crept(time, self._pull(pressure, contraction))
            case Hidden.THRESHOLD:
                carried = pressure - THRESHOLD * np.tanh(pressure / THRESHOLD)
                return self._pull(carried, contraction)
            case Hidden.HYSTERESIS:
                return self._pull(pressure, contraction) - _loop(contraction)

    def _pull(self, pressure: Array, contraction: Array) -> Array:
        """Pull of the braid, [1]_ eq. (8) with the angle at rest. [N]."""
        length_term = 3 * (1 - contraction) ** 2 / tan(self.angle) ** 2
        return np.asarray(
            pressure
            * pi
            * self.diameter**2
            / 4
            * (length_term - 1 / sin(self.angle) ** 2)
        )


def _crept(time: Array, pull: Array) -> Array:
    """Let Voigt elements in series take their share late, [3]_. [N]."""
    out = pull.copy()
    for share, constant in CREEP:
        strain = pull[0]
        for i in range(pull.size):
            if i:
                kept = exp(-(time[i] - time[i - 1]) / constant)
                strain = kept * strain + (1 - kept) * pull[i]
            out[i] -= share * (pull[i] - strain)
    return out


def _loop(contraction: Array) -> Array:
    """Bouc-Wen hysteresis over the travel, [2]_ with n = 1. [N]."""
    out = np.zeros_like(contraction)
    state = 0.0
    for i in range(1, contraction.size):
        travel = float(contraction[i] - contraction[i - 1])
        # Exact over a step: it decays towards the side the muscle moves to.
        side = 1.0 if travel > 0 else -1.0
        kept = exp(-abs(travel) / SOFT)
        state = kept * state + (1 - kept) * side
        out[i] = LOOP * state
    return out


def _noise(size: int, draws: np.random.Generator) -> Array:
    """Unit noise in which neighbours know of each other."""
    fresh = draws.standard_normal(size)
    out = np.empty(size)
    out[0] = fresh[0]
    for i in range(1, size):
        out[i] = CORRELATION * out[i - 1] + sqrt(1 - CORRELATION**2) * fresh[i]
    return out
