"""Grasp again and again, with mishaps: ``make soak N=1000``."""

import os
import sys
from collections.abc import Sequence
from functools import partial
from multiprocessing import Pool

from rich.console import Console
from rich.table import Table

from gripperd.config import load_settings, shipped
from tests.soak.case import TOLD_WITHIN, Verdict, case


def table(verdicts: Sequence[Verdict]) -> Table:
    found = Table(
        "mishap", "grasps", "held", "lost", "told within", "limit", "objections"
    )
    for mishap in sorted({each.mishap for each in verdicts}):
        these = [each for each in verdicts if each.mishap == mishap]
        told = [each.told_after for each in these if each.told_after is not None]
        found.add_row(
            mishap,
            f"{len(these)}",
            f"{sum(each.held for each in these)}",
            f"{sum(each.lost for each in these)}",
            f"{max(told) * 1e3:.0f} ms" if told else "",
            f"{TOLD_WITHIN * 1e3:.0f} ms",
            f"{sum(bool(each.objections) for each in these)}",
        )
    return found


def main() -> int:
    count = int(os.environ.get("N", "100"))
    first = int(os.environ.get("SEED", "1"))
    settings = load_settings(shipped("gripperd.yaml"), {})
    with Pool() as pool:
        seeds = range(first, first + count)
        verdicts = pool.map(partial(case, settings), seeds, chunksize=5)
    console = Console(width=110)
    console.print(table(verdicts))
    bad = [each for each in verdicts if each.objections]
    for each in bad:
        console.print(
            f"seed {each.seed}: {each.profile}, {each.mishap}:"
            f" {', '.join(each.objections)}"
        )
    console.print(f"{count} grasps, {len(bad)} with objections")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
