"""A recording as the diagnosis sees it: runs of columns in SI."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from gripperd.model.track import Array


class Kind(StrEnum):
    """What a run was made to show, when the side file says so."""

    ISOMETRIC = "isometric"
    ISOBARIC = "isobaric"
    STEP = "step"
    HOLD = "hold"
    CYCLE = "cycle"
    GRASP = "grasp"


@dataclass(frozen=True, slots=True)
class Run:
    """One contiguous experiment.

    The columns are arrays of one shape ``(n,)`` in SI: ``time`` always; of ``current``,
    ``pressure`` (gauge), ``contraction``, ``length``, ``force``, ``opening``, ``grip``,
    ``object``, ``temperature`` [K], ``supply`` and ``ambient`` those that were
    recorded. NaN is not measured, or not to be believed.
    """

    name: str
    columns: Mapping[str, Array]
    kind: Kind | None = None
    cut: str = ""
    """Name of the run that it is a piece of, from a pause or to one; else none."""

    def __len__(self) -> int:
        """Number of samples."""
        return self.columns["time"].size

    def has(self, column: str) -> bool:
        """Whether there is any believable value of it."""
        return column in self.columns and bool(np.isfinite(self.columns[column]).any())


@dataclass(frozen=True, slots=True)
class Rejection:
    """Samples that are not believed, and why."""

    run: str
    column: str
    """As the file spells it, such as ``force_N``."""
    count: int
    reason: str


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Two groups of runs that repeat the same sweep and do not agree."""

    runs: tuple[str, ...]
    others: tuple[str, ...]
    column: str
    """As the file spells it."""
    difference: float
    """Median of the first minus that of the others, root mean square over the sweep,
    in the unit of the file."""
    unit: str
    spread: float
    """How far repeats inside a group differ, 1 sigma, in the unit of the file; NaN when
    no place was visited twice inside a group."""


@dataclass(frozen=True, slots=True)
class Recording:
    """Everything one file says, checked."""

    name: str
    digest: str
    """SHA-256 of the bytes of the file."""
    runs: tuple[Run, ...]
    noise: Mapping[str, float] = field(default_factory=dict)
    """Stated by the side file: one sigma by column. [SI]"""
    rejected: tuple[Rejection, ...] = ()
    contradictions: tuple[Contradiction, ...] = ()
    remarks: tuple[str, ...] = ()
    """What a person should know about it, a sentence each."""

    def has(self, column: str) -> bool:
        """Whether any run measured it."""
        return any(run.has(column) for run in self.runs)
