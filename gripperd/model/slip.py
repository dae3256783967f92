"""Dry friction that needs a rate to be there in full, or a way to turn round.

References
----------
.. [1] S. Andersson, A. Söderberg, S. Björklund, "Friction models for sliding dry,
       boundary and mixed lubricated contacts", Tribology International 40(4), 580-587,
       2007.
"""

import numpy as np

from gripperd.model.memory import dahl
from gripperd.model.real import Real
from gripperd.model.track import Array, Track


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


def held(rate: Real, distance: float, slip: float) -> Real:
    """Share of a friction once all has settled; over a way it is left at rest. [-].

    Parameters
    ----------
    rate, slip
        As of :func:`called_up`.
    distance
        Way over which it turns round; 0 for at once. [-]
    """
    return 1.0 if distance > 0 else called_up(rate, slip)


def turned(track: Track, distance: float, slip: float, memory: Array) -> Array:
    """Sign of a friction at each moment, and its share (Dahl). [-1..1].

    Parameters
    ----------
    track
        The moments, shape ``(n,)``.
    distance, slip
        As of :func:`held`.
    memory
        As of :func:`gripperd.model.memory.dahl`, shape ``(2,)``; it is moved on.
    """
    way, direction = track.contraction, track.direction
    share = np.broadcast_to(called_up(track.rate, slip), way.shape)
    return dahl(way, direction, np.asarray(share), distance, memory)
