"""Programs that nobody here wrote, started and stopped."""

import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

HEADERS = Path("/usr/include/modbus")
PATIENCE = 60.0
"""Longest wait for a program to start; none takes this long. [s]"""


def needed(program: str) -> str:
    """Where a program is that its package is named after; without it, skip the test."""
    found = shutil.which(program)
    if found is None:
        pytest.skip(f"{program} is not installed (apt-get install {program})")
    return found


def compiled(source: Path, folder: Path) -> Path | None:
    """A program on libmodbus; None without a compiler or the library."""
    compiler = shutil.which("gcc")
    if compiler is None or not (HEADERS / "modbus.h").exists():
        return None
    program = folder / source.stem
    flags = ["-O2", f"-I{HEADERS}", "-o", str(program), str(source), "-lmodbus"]
    subprocess.run([compiler, *flags], check=True)
    return program


@contextmanager
def running(*command: str) -> Iterator[None]:
    """Run a server inside, from when it says that it is ready; then kill it."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            yield
        finally:
            process.kill()


@contextmanager
def cable(folder: Path) -> Iterator[tuple[Path, Path]]:
    """Both ends of a serial cable, two ptys with socat between them, while inside."""
    near, far = folder / "near", folder / "far"
    ends = [f"pty,raw,echo=0,link={end}" for end in (near, far)]
    with subprocess.Popen(["socat", *ends]) as joining:
        try:
            until = time.monotonic() + PATIENCE
            while not (near.exists() and far.exists()):
                assert time.monotonic() < until, "socat has made no ptys"
                time.sleep(0.01)
            yield near, far
        finally:
            joining.terminate()


def free_port() -> int:
    """A TCP port on loopback that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port: int = free.getsockname()[1]
    return port
