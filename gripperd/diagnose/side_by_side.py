"""Work that is shared between processes, for a fit keeps one core busy."""

import multiprocessing
import os
import struct
from collections.abc import Callable, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import TypeVar

Piece = TypeVar("Piece")
Outcome = TypeVar("Outcome")

_TICKET = struct.Struct("=H")
"""Number of a piece; all of them fit into a pipe of 64 KiB."""


def side_by_side(
    work: Callable[[Piece], Outcome], pieces: Sequence[Piece], processes: int
) -> list[Outcome]:
    """Do the same with each of some pieces; the outcome is that of one process.

    The others are copies of this one (fork), so that only what they found is passed
    on. A piece that is lost with its process, killed or failed, is done here again.

    Parameters
    ----------
    work
        What is done. It must not wait for a thread: a copy has but one.
    pieces
        With what, in any order, up to 32768.
    processes
        How many share it, this one among them.
    """
    others = min(processes, len(pieces)) - 1
    if others < 1:
        return [work(piece) for piece in pieces]
    fork = multiprocessing.get_context("fork")
    tickets, source = os.pipe()
    os.write(source, b"".join(map(_TICKET.pack, range(len(pieces)))))
    os.close(source)
    pipes = [fork.Pipe(duplex=False) for _ in range(others)]
    copies = [
        fork.Process(target=_send, args=(end, tickets, work, pieces), daemon=True)
        for _, end in pipes
    ]
    for copy, (_, end) in zip(copies, pipes, strict=True):
        copy.start()
        end.close()
    try:
        found = _done(tickets, work, pieces)
    finally:
        os.close(tickets)
    for copy, (end, _) in zip(copies, pipes, strict=True):
        with end, suppress(EOFError):
            found |= end.recv()
        copy.join()
    return [
        found[place] if place in found else work(piece)
        for place, piece in enumerate(pieces)
    ]


def _done(
    tickets: int, work: Callable[[Piece], Outcome], pieces: Sequence[Piece]
) -> dict[int, Outcome]:
    """Do what no other process has taken, a piece at a time."""
    found: dict[int, Outcome] = {}
    while _is_awaited() and (ticket := os.read(tickets, _TICKET.size)):
        (place,) = _TICKET.unpack(ticket)
        found[place] = work(pieces[place])
    return found


def _is_awaited() -> bool:
    """Whether the process still is there that this one is a copy of."""
    original = multiprocessing.parent_process()
    return original is None or original.is_alive()


def _send(
    end: Connection,
    tickets: int,
    work: Callable[[Piece], Outcome],
    pieces: Sequence[Piece],
) -> None:
    # Whoever waits does it again, and is told what is wrong with it.
    with suppress(Exception):
        end.send(_done(tickets, work, pieces))
