"""Control inside the event loop of the service, as a yardstick for its own process."""

import asyncio
import sys
from pathlib import Path

import uvloop

from gripperd.cli import processes, serving
from gripperd.config import load_settings


async def main(_: str, bench: str, __: str, config: str) -> None:
    """As its test calls it: ``together HOST:PORT --config FILE``."""
    host, _, port = bench.rpartition(":")
    settings = load_settings(Path(config))
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(processes.control(settings, (host, int(port))))
        tasks.create_task(serving.service(settings, None))


if __name__ == "__main__":
    uvloop.run(main(*sys.argv[1:5]))
