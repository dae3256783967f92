"""Doubt of a prediction: what is not known of the pressure and length it starts from.

Where a pressure swings within a few samples no trend tells its noise from its way, and
what is wrong there is wrong in the force many times over. The usual doubt is part of
what is left of a force anyway, and so of its noise; more than that is not.

A length that travels is taken as it was read, for its corners. Its noise comes beside
that of the force, and where the muscle is held it does not.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.course import Course, is_table
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.stages import at_once
from gripperd.diagnose.residuals.track import track_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array

LENGTH = "length"
"""Column of the contraction with its corners sharp."""


def own_shares(
    model: Explanation,
    courses: Sequence[Course],
    blocks: Sequence[Block],
    noises: Sequence[Noise],
    length: str = LENGTH,
) -> list[Array]:
    """Share of the uncertainty of each reading that readings of its kind have anyway.

    Parameters
    ----------
    model
        Whose area turns a pressure into a force.
    courses
        The sweeps.
    blocks
        Readings to explain; of them only a force follows from a pressure and a length
        that are read otherwise in one sweep than in another.
    noises
        Of the readings, block by block. [SI]
    length
        Column it is taken from: its trend is ``contraction``.

    Returns
    -------
    Block by block: 1 where the pressure is known as well as usual, and the length
    exactly. [-]
    """
    handed = [_of_pressure(model, courses[block.course], block) for block in blocks]
    lengths = [
        _lasting(courses[one.course], noise, length)
        * of_length(model, courses[one.course], one, length)
        for one, noise in zip(blocks, noises, strict=True)
    ]
    forces = [
        one
        for one, block in zip(handed, blocks, strict=True)
        if block.signal is Signal.FORCE
    ]
    usual = float(np.median(np.concatenate(forces))) if forces else 0.0
    return [
        np.hypot(noise.std, usual)
        / np.sqrt(noise.std**2 + np.maximum(pressure, usual) ** 2 + way**2)
        for pressure, way, noise in zip(handed, lengths, noises, strict=True)
    ]


def _lasting(course: Course, noise: Noise, length: str) -> float:
    """How much longer the noise of a length lasts than that of its force. [-].

    What is left of a force is held against noise that lasts as long as its own.
    """
    known = course.smooth.get(length)
    return max(known.lasting / noise.lasting, 1.0) if known else 1.0


def of_length(
    model: Explanation, course: Course, block: Block, length: str = LENGTH
) -> Array:
    """Standard deviation of a force that the noise of a length makes. [N].

    Parameters
    ----------
    model
        Whose slope turns a contraction into a force.
    course, block
        A sweep, and readings of it; 0 of any but a force.
    length
        Column it is taken from.
    """
    if _is_other(course, block):
        return np.zeros(int(block.good.sum()))
    track = track_of(model, course, block.course)
    aside = replace(track, contraction=track.contraction + course.doubt(length))
    here, there = (at_once(model, one, Signal.FORCE) for one in (track, aside))
    return np.nan_to_num(np.abs(there - here))[block.good]


def _of_pressure(model: Explanation, course: Course, block: Block) -> Array:
    """Standard deviation of a force that a doubtful pressure makes. [N]."""
    if _is_other(course, block):
        return np.zeros(int(block.good.sum()))
    area = track_of(model, course, block.course).pull_area
    return np.nan_to_num(np.abs(area) * course.doubt("pressure"))[block.good]


def _is_other(course: Course, block: Block) -> bool:
    return block.signal is not Signal.FORCE or is_table((course,))
