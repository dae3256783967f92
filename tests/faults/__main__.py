"""Inject every fault for real, and print how long it takes to tell: ``make faults``.

Where a time says nothing, it prints how often each thing came of it.
"""

import logging
import sys
from collections.abc import Iterator

import structlog
from rich.console import Console
from rich.table import Table

from tests.faults import (
    clock,
    commands,
    disk,
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
    "module": module,
    "process": process,
    "power": power,
    "disk": disk,
    "clock": clock,
    "settings": settings,
    "models": models,
    "load": load,
    "commands": commands,
}


def table(name: str, rows: Iterator[Row]) -> tuple[Table, bool]:
    """What was measured, and whether all was as it must be."""
    found = Table(name, "told by, or came of it", "tries", "median", "longest", "limit")
    found.add_column("")
    kept = True
    for row in rows:
        took = sorted(row.took)
        found.add_row(
            row.fault,
            row.noticed,
            f"{row.tries}",
            f"{took[len(took) // 2] * 1e3:.0f} ms" if took else "",
            f"{took[-1] * 1e3:.0f} ms" if took else "",
            "" if row.limit is None else f"{row.limit * 1e3:.0f} ms",
            _said(row),
        )
        kept = kept and row.kept
    return found, kept


def _said(row: Row) -> str:
    if row.wrong:
        return f"WRONG: {', '.join(row.wrong)}"
    return "" if row.kept else "TOO LATE"


def main() -> int:
    # What control logs about every fault is not the table.
    structlog.configure(
        wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL)
    )
    console = Console(width=120)
    good = True
    for name in sys.argv[1:] or CHAPTERS:
        found, kept = table(name, CHAPTERS[name].rows())
        console.print(found)
        good = good and kept
    return not good


if __name__ == "__main__":
    sys.exit(main())
