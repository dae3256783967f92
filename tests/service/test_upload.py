import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from starlette.requests import ClientDisconnect

from gripperd.errors import Refused
from gripperd.service.upload import received

pytestmark = pytest.mark.anyio


async def parts(*octets: bytes) -> AsyncIterator[bytes]:
    for part in octets:
        yield part


async def test_the_parts_make_the_file(tmp_path: Path) -> None:
    file = await received(parts(b"run,", b"t_s\n", b""), tmp_path, "rig")
    assert file == tmp_path / "rig.csv"
    assert file.read_bytes() == b"run,t_s\n"


async def test_a_parquet_file_begins_as_one(tmp_path: Path) -> None:
    assert (await received(parts(b"PAR1", b"..."), tmp_path, "rig")).suffix == (
        ".parquet"
    )


async def test_as_much_as_is_allowed_is_taken_and_no_octet_more(tmp_path: Path) -> None:
    file = await received(parts(b"12345", b"67"), tmp_path, "rig", largest=7)
    assert file.read_bytes() == b"1234567"
    with pytest.raises(Refused) as refused:
        await received(parts(b"12345", b"67"), tmp_path, "more", largest=6)
    assert refused.value.code == "body-too-large"


async def test_a_body_that_never_ends_is_given_up(tmp_path: Path) -> None:
    async def stalled() -> AsyncIterator[bytes]:
        yield b"run,"
        await asyncio.Event().wait()

    with pytest.raises(Refused, match=r"not complete within 0\.05 s") as refused:
        await received(stalled(), tmp_path, "rig", longest=0.05)
    assert refused.value.code == "body-too-slow"


async def test_a_client_that_goes_away_is_no_defect(tmp_path: Path) -> None:
    async def broken() -> AsyncIterator[bytes]:
        yield b"run,"
        raise ClientDisconnect

    with pytest.raises(Refused, match="went away"):
        await received(broken(), tmp_path, "rig")
