"""Print every benchmark: ``make bench``, or ``make bench ONLY=physics``.

Each figure stands beside its yardstick, measured in the same run on the same machine:
ratios count, absolute times do not.
"""

import logging
import sys

import structlog
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
    # Every bus, state and command is logged, which would drown the tables.
    quiet = structlog.make_filtering_bound_logger(logging.CRITICAL)
    structlog.configure(wrapper_class=quiet)
    for name in sys.argv[1:] or CHAPTERS:
        console.print(CHAPTERS[name].table())


main()
