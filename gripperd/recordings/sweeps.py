"""The rows of a table as runs, on one clock that only goes forward."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from unicodedata import category

import numpy as np

from gripperd.config.complaint import printable
from gripperd.diagnose.readings.columns import COLUMNS, TIME
from gripperd.diagnose.readings.recording import Rejection, Run
from gripperd.errors import InputError
from gripperd.recordings.header import IDENTITIES, RUN
from gripperd.recordings.table import Table

PAUSE = 60.0
"""Rest assumed before a run whose clock starts anew. [s]"""
LATEST = 1e12
"""Seconds; more is no time, such as milliseconds since 1970."""
MOST_RUNS = 2000
"""A column with more names is a counter."""
UNSEEN = frozenset({"Cc", "Cf"})
"""Categories of characters that move the cursor, turn a line round, or do not show."""


@dataclass(frozen=True, slots=True)
class Sweeps:
    """The runs of a table."""

    runs: tuple[Run, ...]
    rejected: tuple[Rejection, ...]
    remarks: tuple[str, ...]


def sweeps(table: Table) -> Sweeps:
    """Cut a table into its runs, in SI.

    Raises
    ------
    InputError
        A run has no name, or one that cannot be shown, or is torn apart; time is
        missing or runs backwards; or there is more than one muscle.
    """
    _require_one_muscle(table)
    _require_few_runs(table)
    runs = tuple(_runs(table))
    ordered = _in_order(runs)
    ahead, restarted = _on_one_clock(ordered)
    fresh = [np.diff(run.columns["time"], prepend=-np.inf) > 0.0 for run in ahead]
    return Sweeps(
        tuple(
            Run(run.name, {key: column[rows] for key, column in run.columns.items()})
            for run, rows in zip(ahead, fresh, strict=True)
        ),
        tuple(
            Rejection(run.name, TIME.name, int((~rows).sum()), "same time as before")
            for run, rows in zip(ahead, fresh, strict=True)
            if not rows.all()
        ),
        tuple(_remarks(table, restarted, is_sorted=ordered is not runs)),
    )


def _require_one_muscle(table: Table) -> None:
    for key in IDENTITIES:
        if key not in table.words:
            continue
        named = [value for value in table.words[key].values if value]
        if len(named) > 1:
            shown = ", ".join(printable(value) for value in named[:5])
            detail = (
                f"{table.source}: column {key} names {len(named)} muscles ({shown}); "
                "a recording is of one, so cut it into a file for each"
            )
            raise InputError(detail)


def _require_few_runs(table: Table) -> None:
    names = len(table.words[RUN].values)
    if not names:
        detail = f"{table.source}: there are names of columns, and no rows"
        raise InputError(detail)
    if names > MOST_RUNS:
        detail = (
            f"{table.source}: column {RUN} has {names} different names; "
            f"{MOST_RUNS} runs are the most"
        )
        raise InputError(detail)


def _runs(table: Table) -> Iterator[Run]:
    words = table.words[RUN]
    starts = [0, *(np.flatnonzero(np.diff(words.codes)) + 1)]
    ends = [*starts[1:], words.codes.size]
    measured = {
        COLUMNS[name].quantity: COLUMNS[name].si(values)
        for name, values in table.numbers.items()
        if name == TIME.name or not np.isnan(values).all()
    }
    seen: set[str] = set()
    for start, end in zip(starts, ends, strict=True):
        name = words.values[words.codes[start]]
        if not name:
            detail = f"{table.place(int(start))}: {RUN} is empty"
            raise InputError(detail)
        if any(category(one) in UNSEEN for one in name):
            detail = (
                f"{table.place(int(start))}: run {printable(name)} has characters that "
                "move the cursor, or that nobody sees"
            )
            raise InputError(detail)
        if name in seen:
            detail = (
                f"{table.place(int(start))}: run {printable(name)} goes on after "
                "another; the rows of a run stand together"
            )
            raise InputError(detail)
        seen.add(name)
        run = Run(name, {key: values[start:end] for key, values in measured.items()})
        _require_forward(table, run, int(start))
        yield run


def _require_forward(table: Table, run: Run, start: int) -> None:
    time = run.columns["time"]
    wrong = np.flatnonzero(~(np.abs(time) <= LATEST))
    if wrong.size:
        place = table.place(start + int(wrong[0]))
        detail = f"{place}: {TIME.name} is empty, or beyond {LATEST:g} s"
        raise InputError(detail)
    back = np.flatnonzero(np.diff(time) < 0.0)
    if back.size:
        row = int(back[0]) + 1
        detail = (
            f"{table.place(start + row)}: {TIME.name} runs backwards in run "
            f"{printable(run.name)}: {time[row]:g} s after {time[row - 1]:g} s"
        )
        raise InputError(detail)


def _in_order(runs: tuple[Run, ...]) -> tuple[Run, ...]:
    """Put runs in order of time, where one clock tells it: none began within another.

    A file may be sorted by the names of its runs, and what came first matters.
    """
    ordered = tuple(sorted(runs, key=lambda run: float(run.columns["time"][0])))
    one_clock = all(
        before.columns["time"][-1] < after.columns["time"][0]
        for before, after in pairwise(ordered)
    )
    is_other = any(one is not own for one, own in zip(ordered, runs, strict=True))
    return ordered if one_clock and is_other else runs


def _on_one_clock(runs: tuple[Run, ...]) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """Let time rise over the runs too; also name the runs that had to be moved."""
    moved: list[Run] = []
    restarted: list[str] = []
    offset, last = 0.0, -np.inf
    for run in runs:
        time = run.columns["time"]
        if time[0] + offset <= last:
            restarted.append(run.name)
            offset = last + PAUSE - float(time[0])
        last = float(time[-1]) + offset
        moved.append(Run(run.name, {**run.columns, "time": time + offset}))
    return tuple(moved), tuple(restarted)


def _remarks(
    table: Table, restarted: tuple[str, ...], *, is_sorted: bool
) -> Iterator[str]:
    for name, values in table.numbers.items():
        if values.size and np.isnan(values).all():
            yield f"Column {name} is empty: not measured."
    if is_sorted:
        yield (
            f"The runs stand in another order than {TIME.name}; they were put in order."
        )
    if restarted:
        yield (
            f"{TIME.name} starts anew in {len(restarted)} runs (first "
            f"{printable(restarted[0])}); they were put one after the other with "
            f"{PAUSE:g} s between, so nothing can be said of the time between runs."
        )
