"""A large body on its way to a file; it is never all in memory."""

import asyncio
from asyncio import to_thread
from collections.abc import AsyncIterator
from pathlib import Path

from starlette.requests import ClientDisconnect

from gripperd.errors import Refused
from gripperd.store.records import writing

LARGEST = 64 * 2**20
"""[octets]"""
LONGEST = 300.0
"""Time for all of it to arrive. [s]"""
PARQUET = b"PAR1"
"""How a Parquet file begins; what begins otherwise is read as CSV."""
TYPES = ("text/csv", "application/vnd.apache.parquet", "application/octet-stream")


def check_header(kind: str | None, length: str | None) -> None:
    """Refuse a body by what its headers say.

    Raises
    ------
    Refused
        It is of another type, or too large.
    """
    named = (kind or "").partition(";")[0].strip().lower()
    if named not in TYPES:
        detail = f"the body is {named[:100] or 'of no stated type'}, not a recording"
        hints = (f"send it with one of the Content-Types {', '.join(TYPES)}",)
        raise Refused(detail, code="unsupported-media-type", hints=hints)
    if length is not None and length.isdecimal() and int(length) > LARGEST:
        raise _too_large(f"has {int(length) / 2**20:.0f} MB", LARGEST)


async def received(
    body: AsyncIterator[bytes],
    folder: Path,
    stem: str,
    *,
    largest: int = LARGEST,
    longest: float = LONGEST,
) -> Path:
    """Write a body to a file of its kind in a folder.

    Parameters
    ----------
    body
        Its parts, as they come.
    folder
        Where the file is made.
    stem
        Its name without the ending.
    largest
        Most that is taken. [octets]
    longest
        Time for all of it to arrive. [s]

    Returns
    -------
    The file, ending in ``.csv`` or ``.parquet``.

    Raises
    ------
    Refused
        It is too large or too slow, or the disk does not take it.
    """
    draft = folder / stem
    begin = b""
    try:
        async with asyncio.timeout(longest):
            begin = await _written(body, draft, largest)
    except TimeoutError:
        detail = f"the body was not complete within {longest:g} s"
        raise Refused(detail, code="body-too-slow") from None
    except ClientDisconnect:
        detail = "the client went away before the body was complete"
        raise Refused(detail, code="bad-request") from None
    return draft.rename(draft.with_name(f"{stem}{_ending(begin)}"))


async def _written(body: AsyncIterator[bytes], draft: Path, largest: int) -> bytes:
    """Write all of it; its first octets."""
    begin, size = b"", 0
    with writing(draft.parent), draft.open("wb") as file:
        async for part in body:
            size += len(part)
            if size > largest:
                raise _too_large(f"has {size} octets or more", largest)
            begin = begin or part[: len(PARQUET)]
            await to_thread(file.write, part)
    return begin


def _ending(begin: bytes) -> str:
    return ".parquet" if begin == PARQUET else ".csv"


def _too_large(size: str, largest: int) -> Refused:
    detail = f"a recording may have up to {largest / 2**20:.0f} MB; this one {size}"
    hints = ("thin it, or cut it into several",)
    return Refused(detail, code="body-too-large", hints=hints)
