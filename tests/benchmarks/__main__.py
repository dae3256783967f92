"""Print every benchmark: ``make bench``, or ``make bench ONLY=physics``.

Each figure stands beside its yardstick, measured in the same run on the same machine:
ratios count, absolute times do not.
"""

import sys

from rich.console import Console

from tests.benchmarks import (
    bus,
    diagnosis,
    faults,
    footprint,
    latency,
    outage,
    physics,
    plant,
    punctuality,
    stopping,
)

CHAPTERS = {
    "physics": physics,
    "plant": plant,
    "bus": bus,
    "faults": faults,
    "outage": outage,
    "latency": latency,
    "stopping": stopping,
    "punctuality": punctuality,
    "footprint": footprint,
    "diagnosis": diagnosis,
}


def main() -> None:
    console = Console(width=140)
    for name in sys.argv[1:] or CHAPTERS:
        console.print(CHAPTERS[name].table())


main()
