"""Fuzz every decoder, a million inputs unless told otherwise."""

import sys
import time

from . import SEED, fuzz

TOTAL = 1_000_000


def main() -> None:
    total = int(sys.argv[1]) if len(sys.argv) > 1 else TOTAL
    start = time.perf_counter()
    for name, counts in fuzz(total).items():
        words = ", ".join(f"{count} {word}" for word, count in counts.most_common())
        print(f"{name:16} {words}")
    print(
        f"{total} inputs, seed {SEED}, {time.perf_counter() - start:.0f} s: no defect"
    )


main()
