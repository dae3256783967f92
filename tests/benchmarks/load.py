"""Requests without end, from another process: ``python -m tests.benchmarks.load``."""

import asyncio
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import uvloop

CONNECTIONS = 32
REQUEST = b"GET /v1/grippers/g0 HTTP/1.1\r\nHost: localhost\r\n\r\n"


async def _asking(host: str, port: int, pause: float) -> None:
    """One client on one connection; without a pause it asks as fast as it can."""
    reader, writer = await asyncio.open_connection(host, port)
    while True:
        writer.write(REQUEST)
        head = await reader.readuntil(b"\r\n\r\n")
        length = head.lower().split(b"content-length:")[1].split(b"\r\n")[0]
        await reader.readexactly(int(length))
        if pause:
            await asyncio.sleep(pause)


async def main(url: str, rate: float) -> None:
    place = urlsplit(url)
    pause = CONNECTIONS / rate if rate else 0.0
    async with asyncio.TaskGroup() as clients:
        for _ in range(CONNECTIONS):
            clients.create_task(_asking(place.hostname or "", place.port or 0, pause))


@contextmanager
def loaded(url: str, rate: float = 0.0) -> Iterator[None]:
    """Keep asking while inside; a rate of 0 is as fast as it goes. [1/s]."""
    command = (sys.executable, "-m", "tests.benchmarks.load", url, str(rate))
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        yield
        assert process.poll() is None, "the load broke off"
    finally:
        process.kill()
        process.wait()


if __name__ == "__main__":
    uvloop.run(main(sys.argv[1], float(sys.argv[2])))
