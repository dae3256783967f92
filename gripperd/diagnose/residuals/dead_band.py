"""Noise of a pressure that a regulator leaves alone within its dead band."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.level import MOVES
from gripperd.diagnose.residuals.block import Block
from gripperd.model import Regulator
from gripperd.model.memory import begin, play

UNIFORM = 12**-0.5
"""Standard deviation of what is as likely anywhere in a band, of its width. [-]"""
SAW = 6.0
"""How steeply the correlation ``1 - 6 x (1 - x)`` of a saw begins, x of a tooth. [-]"""


def within_band(
    block: Block, course: Course, regulator: Regulator, noise: Noise, band: float
) -> Block:
    """Give a block the noise of a regulator that sleeps in its dead band.

    It is as likely anywhere in the band. Where the command goes on it forgets as a saw
    does whose teeth are as wide; where the command rests it stays, but for the drift of
    the transmitter.

    Parameters
    ----------
    block, course
        Pressures, and their sweep.
    regulator
        Its curve tells how far the command goes.
    noise
        Of the pressure where the command rests. [Pa]
    band
        Width. [Pa]
    """
    moved = regulator.gain * play(course.column("current"), MOVES, begin())
    # Before the first command that was read there was no way that anybody knows.
    way = np.cumsum(np.nan_to_num(np.abs(np.diff(moved, prepend=moved[:1]))))
    ages = SAW * way / band + course.time / noise.memory
    drift = float(np.hypot(UNIFORM * band, noise.drift))
    return block._replace(noise=replace(noise, drift=drift), ages=ages[block.good])
