"""What the rig is asked to do: sweeps that show one thing at a time."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PAUSE = 30.0
"""Rest between sweeps. [s]"""


@dataclass(frozen=True, slots=True)
class Programme:
    """One sweep: what is asked at each time."""

    name: str
    kind: str
    time: Array
    """Since the start of the sweep. [s]"""
    pressure: Array
    """Share of the span of the regulator. [0..1]"""
    contraction: Array


def programmes(step: float) -> Iterator[Programme]:
    """Everything the rig is asked to do, in order.

    Sweeps of pressure at several lengths, of length at several pressures and speeds
    (one of them again), steps with long holds, and one vented hold: what a good
    recording has.

    Parameters
    ----------
    step
        Time between samples. [s]
    """
    for name, length in (("0", 0.0), ("1", 0.07), ("2", 0.14)):
        yield _sweep(
            f"isometric_{name}", "isometric", step,
            [(0, 0.0, length), (12, 0.9, length), (24, 0.0, length)],
        )  # fmt: skip
    for name, share, slowly in (
        ("0", 0.4, 1.0), ("1", 0.6, 0.7), ("2", 0.8, 1.6), ("1_again", 0.6, 0.7),
    ):  # fmt: skip
        yield _sweep(
            f"isobaric_{name}", "isobaric", step,
            [(0, share, 0.0), (10 * slowly, share, 0.16), (15 * slowly, share, 0.08),
             (20 * slowly, share, 0.16), (30 * slowly, share, 0.0)],
        )  # fmt: skip
    yield _sweep("hold_vented", "hold", step, [(0, 0.0, 0.02), (20, 0.0, 0.02)])
    for name, share, length in (("0", 0.5, 0.02), ("1", 0.8, 0.06), ("2", 0.65, 0.1)):
        yield _sweep(
            f"step_{name}", "step", step,
            [(0, 0.1, length), (5, 0.1, length), (5.2, share, length),
             (35, share, length), (35.2, 0.2, length), (50, 0.2, length)],
        )  # fmt: skip


def _sweep(
    name: str, kind: str, step: float, corners: list[tuple[float, float, float]]
) -> Programme:
    at, shares, lengths = (np.array(column) for column in zip(*corners, strict=True))
    time = np.arange(0.0, at[-1], step)
    return Programme(
        name, kind, time, np.interp(time, at, shares), np.interp(time, at, lengths)
    )
