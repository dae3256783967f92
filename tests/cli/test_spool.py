"""Log lines over a real pipe, read late or never."""

import os
import re
from collections.abc import Iterator
from contextlib import suppress

import pytest

from gripperd.cli.spool import Spool
from tests.daemon import until

LINE = "x" * 99 + "\n"


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    reader, writer = os.pipe()
    yield reader, writer
    os.close(writer)


def read_to_end(reader: int, writer: int) -> str:
    """Everything that is in the pipe now."""
    os.set_blocking(reader, False)
    text = b""
    while True:
        try:
            text += os.read(reader, 1 << 16)
        except BlockingIOError:
            return text.decode()


def test_lines_come_out_in_order(pipe: tuple[int, int]) -> None:
    spool = Spool(pipe[1])
    for number in range(500):
        spool.write(f"{number}\n")
    spool.close(20)
    assert read_to_end(*pipe).split() == [str(number) for number in range(500)]
    assert spool.dropped == 0
    os.close(pipe[0])


def fill(writer: int) -> None:
    """Until a further write would wait for the reader."""
    os.set_blocking(writer, False)
    with suppress(BlockingIOError):
        while True:
            os.write(writer, b"." * 4096)
    os.set_blocking(writer, True)


def test_a_reader_that_sleeps_stops_nobody_and_is_told_what_it_missed(
    pipe: tuple[int, int],
) -> None:
    fill(pipe[1])
    spool = Spool(pipe[1], length=10)
    for _ in range(500):
        spool.write(LINE)
    # One line is on its way, ten wait.
    missed = spool.dropped
    assert 489 <= missed <= 490
    text = ""

    def told() -> bool:
        nonlocal text
        text += read_to_end(*pipe)
        told = re.findall(r"(\d+) log lines were dropped", text)
        return sum(map(int, told)) == missed

    until(told)
    spool.close(20)
    text += read_to_end(*pipe)
    assert text.count(LINE) + missed == 500
    os.close(pipe[0])


def test_a_reader_that_went_away_harms_nobody(pipe: tuple[int, int]) -> None:
    os.close(pipe[0])
    spool = Spool(pipe[1])
    spool.write(LINE)
    spool.close(20)
    assert spool.dropped >= 1


def test_the_end_does_not_wait_for_a_reader_that_sleeps(pipe: tuple[int, int]) -> None:
    fill(pipe[1])
    spool = Spool(pipe[1], length=10)
    spool.write(LINE)
    spool.close(0.01)
    assert spool._thread.is_alive()
    # Wake it, so that it does not outlive the pipe.
    read_to_end(*pipe)
    spool._thread.join(20)
    assert not spool._thread.is_alive()
    os.close(pipe[0])
