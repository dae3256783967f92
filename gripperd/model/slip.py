"""Dry friction that needs a rate to be there in full.

References
----------
.. [1] S. Andersson, A. Söderberg, S. Björklund, "Friction models for sliding dry,
       boundary and mixed lubricated contacts", Tribology International 40(4), 580-587,
       2007.
"""

import numpy as np

from gripperd.model.real import Real


def called_up(rate: Real, slip: float) -> Real:
    """Share of a friction that is there at a rate: its hyperbolic tangent. [-].

    Parameters
    ----------
    rate
        Of contraction. [1/s]
    slip
        Rate at which three quarters are there; 0 for all of it at any rate. [1/s]
    """
    return np.tanh(np.abs(rate) / slip) if slip > 0 else 1.0
