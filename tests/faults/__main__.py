"""Inject every fault for real, and print how long it takes to tell: ``make faults``.

Where a time says nothing, it prints how often each thing came of it.
"""

import logging
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import structlog
from rich.console import Console
from rich.table import Table

from tests.faults import (
    clock,
    commands,
    disk,
    hostile,
    inputs,
    line,
    load,
    models,
    module,
    power,
    process,
    rig,
    settings,
    wire,
)
from tests.faults.row import Row

CHAPTERS = {
    "rig": rig,
    "wire": wire,
    "line": line,
    "inputs": inputs,
    "module": module,
    "process": process,
    "power": power,
    "disk": disk,
    "clock": clock,
    "settings": settings,
    "models": models,
    "load": load,
    "commands": commands,
    "hostile": hostile,
}


def table(name: str, rows: Sequence[Row]) -> Table:
    """What was measured."""
    found = Table(name, "told by, or came of it", "tries", "median", "longest", "limit")
    found.add_column("")
    for row in rows:
        took = sorted(row.took)
        found.add_row(
            row.fault,
            row.noticed,
            f"{row.tries}",
            _shown(took[len(took) // 2] if took else None),
            _shown(took[-1] if took else None),
            _shown(row.limit),
            _said(row),
        )
    return found


def _shown(seconds: float | None) -> str:
    """Two digits at least, so that what is quick does not look like nothing."""
    if seconds is None:
        return ""
    return f"{seconds * 1e3:.{0 if seconds >= 0.01 else 2}f} ms"


def _said(row: Row) -> str:
    if row.wrong:
        return f"WRONG: {', '.join(row.wrong)}"
    return "" if row.kept else "TOO LATE"


@contextmanager
def listening() -> Iterator[str]:
    """A file that takes what the daemons log: it is not the table."""
    terminal = os.dup(sys.stderr.fileno())
    with tempfile.NamedTemporaryFile(prefix="gripperd-faults-", delete=False) as log:
        os.dup2(log.fileno(), sys.stderr.fileno())
        try:
            yield log.name
        finally:
            os.dup2(terminal, sys.stderr.fileno())
            os.close(terminal)


def main(names: Sequence[str]) -> int:
    if unknown := set(names) - set(CHAPTERS):
        there = ", ".join(CHAPTERS)
        sys.exit(f"no chapter {', '.join(sorted(unknown))}; there is {there}")
    # What control logs in this process is not the table either.
    structlog.configure(
        wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL)
    )
    console = Console(width=120)
    total, bad = 0, 0
    with listening() as log:
        for name in names or CHAPTERS:
            rows = tuple(CHAPTERS[name].rows())
            console.print(table(name, rows))
            total += len(rows)
            bad += sum(not row.kept for row in rows)
    said = f"{bad} not as they must be" if bad else "all as they must be, in time"
    console.print(f"{total} rows, {said}; what the daemons logged is in {log}")
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
