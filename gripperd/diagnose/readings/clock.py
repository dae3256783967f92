"""Rows in which a command is told: the row in which it is given, or one beside it.

A controller that reads, decides and commands logs what it read together with what it
will command next; one that logs before it commands has the command of the row before.
By no physics does a pressure move before its command. That it moves after it is a lag
of the valve, unless all that is read moves exactly one row late.

References
----------
.. [1] L. Ljung, "System Identification: Theory for the User", 2nd ed., Prentice Hall,
       1999, section 14.4: impulse response from correlation, and what it tells of
       delays.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gripperd.diagnose.readings.frozen import COMMANDED
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array

AHEAD, BEHIND = 2, 4
"""Rows before and after a command in which readings may move with it."""
FEWEST = 50
"""Rows that tell when readings move."""
SURE = 5.0
"""Standard errors by which they move more in one row than in another. [-]"""
NONE = 0.1
"""Share of a move up to which it has not begun. [-]"""
MOST = 0.5
"""Share of a move from which it is as good as over: what takes longer lags. [-]"""


@dataclass(frozen=True, slots=True)
class _Moves:
    """How much of its way a column goes in each row from a command on."""

    share: Array
    """From :data:`AHEAD` rows before it to :data:`BEHIND` after it; sum 1. [-]"""
    error: Array
    """One sigma of the same. [-]"""

    def at(self, row: int) -> float:
        """Share of the way in a row, 0 that of the command. [-]."""
        return float(self.share[AHEAD + row])

    def more_at(self, row: int) -> bool:
        """Whether most of the way is surely gone in one row, not in the command's."""
        error = float(np.hypot(self.error[AHEAD + row], self.error[AHEAD]))
        return (
            int(np.argmax(self.share)) == AHEAD + row
            and self.at(row) - self.at(0) > SURE * error
        )

    @property
    def is_next(self) -> bool:
        """Whether nothing moves in the row of a command, and all in the next."""
        return self.more_at(1) and self.at(0) < NONE and self.at(1) > MOST


def with_prompt_command(recording: Recording) -> Recording:
    """Put a command that is told a row late or early into the row in which it is given.

    Early only where at least two columns say so, and none moves with it at once: if
    the pressure alone is late, it is its channel or its valve that is.
    """
    pressure = _moves(recording.runs, "pressure")
    if pressure is None:
        return recording
    if pressure.more_at(-1):
        return _shifted(recording, -1)
    if not pressure.is_next:
        return recording
    names = {name for run in recording.runs for name in run.columns}
    others = [
        moves
        for name in sorted(names - COMMANDED - {"pressure"})
        if (moves := _moves(recording.runs, name)) is not None
    ]
    is_told_early = any(one.is_next for one in others) and not any(
        one.at(0) > max(NONE, SURE * one.error[AHEAD]) for one in others
    )
    return _shifted(recording, 1) if is_told_early else recording


def _moves(runs: Sequence[Run], name: str) -> _Moves | None:
    """How a column follows the command; none if that is not known."""
    rows = [
        rows
        for run in runs
        if run.has("current") and run.has(name) and len(run) > AHEAD + BEHIND + 1
        for rows in [_rows(run.columns["current"], run.columns[name])]
    ]
    known = np.concatenate([np.empty((0, AHEAD + BEHIND + 2)), *rows])
    asked, moved = known[:, :-1], known[:, -1]
    if len(known) < FEWEST or np.linalg.matrix_rank(asked) < asked.shape[1]:
        return None
    inverse = np.linalg.inv(asked.T @ asked)
    share = inverse @ asked.T @ moved
    left = float(np.mean((moved - asked @ share) ** 2))
    whole = float(share.sum())
    error = np.sqrt(np.diag(inverse) * left)
    if abs(whole) <= SURE * float(np.sqrt(inverse.sum() * left)):
        return None
    return _Moves(share / whole, error / abs(whole))


def _rows(current: Array, column: Array) -> Array:
    """Steps of a command around each row, and that of a column; all of them known.

    Where the command rests, a column has moved by something else, which is no matter.
    """
    asked = np.lib.stride_tricks.sliding_window_view(
        np.diff(current), AHEAD + BEHIND + 1
    )[:, ::-1]
    moved = np.diff(column)[BEHIND : BEHIND + len(asked)]
    rows = np.column_stack([asked, moved])
    known = np.isfinite(rows).all(axis=1)
    return rows[known & asked.any(axis=1)]


def _shifted(recording: Recording, late: int) -> Recording:
    """Tell commands so many rows later; a row for which none is known then is left."""
    told = ("early", "later", "first") if late > 0 else ("late", "earlier", "last")
    when, row, left = told
    remark = (
        f"current_mA is logged a row {when}: it is read a row {row}, and the {left} row"
        " of each run is left out."
    )
    runs = tuple(
        _told(run, late) if run.has("current") else run for run in recording.runs
    )
    return replace(recording, runs=runs, remarks=(*recording.remarks, remark))


def _told(run: Run, late: int) -> Run:
    kept = slice(late, None) if late > 0 else slice(None, late)
    columns = {name: column[kept] for name, column in run.columns.items()}
    columns["current"] = np.roll(run.columns["current"], late)[kept]
    return replace(run, columns=columns)
