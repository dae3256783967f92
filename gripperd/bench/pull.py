"""Pull of the muscle for both directions of travel, tabulated for speed."""

from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from gripperd.model import Direction, StaticMuscle

if TYPE_CHECKING:
    from numpy.typing import NDArray

CONTRACTION_STEP = 5e-4
"""Width of a cell. With ``|d²F/dh²| < 2.5e5 N`` in the paper's muscle, a straight line
across it is off by less than ``2.5e5 · h² / 8`` = 8 mN. [-]"""

PRESSURE_STEP = 5e3
"""Length of a cell. The force is affine in pressure, so there is no error but in the
cell that holds a kink: a quarter of the step times the change of slope, 3e-5 m² for the
friction of the paper's muscle, or 40 mN. [Pa]"""


class PullTable:
    """Signed pull at any pressure and contraction, bilinear between exact points.

    The model answers an array in no time but a single value in 2.4 µs; a dynamic step
    needs two of them.

    Parameters
    ----------
    static
        The muscle and its effects.
    pressure
        Highest pressure to tabulate, above the last kink; beyond it the lines go on.
        [Pa]
    contraction
        Highest contraction that will be asked for. [-]
    """

    __slots__ = ("_cells", "_columns")

    def __init__(
        self, static: StaticMuscle, pressure: float, contraction: float
    ) -> None:
        rows = int(contraction / CONTRACTION_STEP) + 1
        self._columns = ceil(pressure / PRESSURE_STEP)
        pressures = np.arange(self._columns + 1, dtype=np.float64) * PRESSURE_STEP
        contractions = np.arange(rows + 1, dtype=np.float64)[:, None] * CONTRACTION_STEP
        columns = [
            column.ravel().tolist()
            for direction in (Direction.CONTRACTING, Direction.EXTENDING)
            for column in _bilinear(
                np.asarray(static.force(pressures, contractions, direction))
            )
        ]
        self._cells = list(zip(*columns, strict=True))

    def at(self, pressure: float, contraction: float) -> tuple[float, float]:
        """Pull while contracting and while extending. [N, N].

        Parameters
        ----------
        pressure
            Gauge pressure, not below 0. [Pa]
        contraction
            From 0 to the highest tabulated. [-]
        """
        across = contraction / CONTRACTION_STEP
        along = pressure / PRESSURE_STEP
        row = int(across)
        column = int(along)
        if column >= self._columns:
            column = self._columns - 1
        cell = self._cells[row * self._columns + column]
        a, a_across, a_along, a_both, b, b_across, b_along, b_both = cell
        across -= row
        along -= column
        return (
            a + a_across * across + (a_along + a_both * across) * along,
            b + b_across * across + (b_along + b_both * across) * along,
        )


def _bilinear(corners: "NDArray[np.float64]") -> tuple["NDArray[np.float64]", ...]:
    """Give a, b, c, d of ``a + b u + c v + d u v`` in each cell; u down, v along."""
    near, far = corners[:-1], corners[1:]
    along = near[:, 1:] - near[:, :-1]
    both = far[:, 1:] - far[:, :-1] - along
    return near[:, :-1], far[:, :-1] - near[:, :-1], along, both
