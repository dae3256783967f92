"""Gains of a loop from the lags of what it acts on.

References
----------
.. [1] S. Skogestad, "Simple analytic rules for model reduction and PID controller
       tuning", Journal of Process Control 13 (2003) 291-309.
"""

from dataclasses import dataclass

REGULATOR_LAG = 0.060
"""Of an E/P regulator that exhausts, the slow way: 1.5 times the 40 ms of a rise
(measured on a 10 mm muscle). [s]"""
CHAMBER_LAG = 0.030
"""Of tube and muscle when they empty; 20 ms when they fill. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """Of a PI controller on a plant of gain 1."""

    proportional: float
    """[-]"""
    integral_time: float
    """[s]"""


def simc(*, slow: float, fast: float, delay: float, closed: float) -> Gains:
    r"""SIMC rule for two lags and a delay, plant gain 1 [1]_.

    The half rule makes one lag of two:

    .. math:: \tau_1 = \tau_s + \tau_f/2, \quad \theta = \theta_0 + \tau_f/2

    and the gains follow from the time constant that the closed loop is to have:

    .. math:: K = \frac{\tau_1}{\tau_c + \theta}, \quad
              \tau_I = \min\left(\tau_1,\, 4(\tau_c + \theta)\right)

    Parameters
    ----------
    slow, fast
        Lags of the plant. [s]
    delay
        Dead time, with one and a half periods for sampling and holding. [s]
    closed
        Time constant of the closed loop, at least the effective delay. [s]
    """
    lag, late = slow + fast / 2, delay + fast / 2
    return Gains(
        proportional=lag / (closed + late),
        integral_time=min(lag, 4 * (closed + late)),
    )
