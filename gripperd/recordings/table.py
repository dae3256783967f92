"""A table of named columns with the place of each row, whatever file it came from."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gripperd.model.track import Array


@dataclass(frozen=True, slots=True)
class Words:
    """A column of text: few different words, many rows."""

    codes: NDArray[np.int64]
    """Position in `values` of the word of each row, shape ``(n,)``."""
    values: tuple[str, ...]
    """Every word once, in the order of its first row; "" is an empty cell."""


@dataclass(frozen=True, slots=True)
class Table:
    """The columns that were asked for."""

    source: str
    words: Mapping[str, Words]
    numbers: Mapping[str, Array]
    """Columns of shape ``(n,)`` in the unit of the file; NaN is an empty cell."""
    place: Callable[[int], str]
    """Where a row stands, such as ``rig.csv:12``."""


class TableFile(Protocol):
    """A file that holds a table."""

    @property
    def names(self) -> tuple[str, ...]:
        """Name of every column."""
        ...

    def table(self, words: Collection[str], numbers: Collection[str]) -> Table:
        """Read those of the columns of text and of numbers that are there.

        Raises
        ------
        InputError
            A line is no row of the table, or a cell is no number.
        """
        ...
