"""Doubt of a prediction: what is not known of the smooth pressure it starts from.

Where a pressure swings within a few samples no trend tells its noise from its way, and
what is wrong there is wrong in the force many times over. The usual doubt is part of
what is left of a force anyway, and so of its noise; more than that is not.
"""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.course import Course, is_table
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.track import track_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array


def own_shares(
    model: Explanation,
    courses: Sequence[Course],
    blocks: Sequence[Block],
    stds: Sequence[float],
) -> list[Array]:
    """Share of the uncertainty of each reading that readings of its kind have anyway.

    Parameters
    ----------
    model
        Whose area turns a pressure into a force.
    courses
        The sweeps.
    blocks
        Readings to explain; of them only a force follows from a smooth pressure.
    stds
        Of the noise of one reading, block by block. [SI]

    Returns
    -------
    Block by block: 1 where the pressure is known as well as usual. [-]
    """
    handed = [_handed_on(model, courses[block.course], block) for block in blocks]
    forces = [
        one
        for one, block in zip(handed, blocks, strict=True)
        if block.signal is Signal.FORCE
    ]
    usual = float(np.median(np.concatenate(forces))) if forces else 0.0
    return [
        np.hypot(std, usual) / np.hypot(std, np.maximum(one, usual))
        for one, std in zip(handed, stds, strict=True)
    ]


def _handed_on(model: Explanation, course: Course, block: Block) -> Array:
    """Standard deviation of a force that a doubtful pressure makes. [N]."""
    if block.signal is not Signal.FORCE or is_table((course,)):
        return np.zeros(int(block.good.sum()))
    area = track_of(model, course, block.course).pull_area
    return np.nan_to_num(np.abs(area) * course.doubt("pressure"))[block.good]
