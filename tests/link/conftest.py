from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest


@pytest.fixture
def socket_path() -> Iterator[Path]:
    """A short path: a Unix socket's name must fit in 107 octets."""
    with TemporaryDirectory(prefix="link") as folder:
        yield Path(folder) / "run" / "s"
