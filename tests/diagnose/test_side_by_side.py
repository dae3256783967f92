import multiprocessing
import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.diagnose.side_by_side import side_by_side


def test_two_processes_work_at_once_and_nothing_is_out_of_order() -> None:
    meet = meeting()

    def met(piece: int) -> tuple[int, int]:
        meet()
        return piece * piece, os.getpid()

    squares, where = zip(*side_by_side(met, [1, 2], 2), strict=True)

    assert squares == (1, 4)
    assert os.getpid() in where
    assert len(set(where)) == 2


@pytest.mark.parametrize("pieces", [0, 1, 2, 7])
def test_each_piece_is_done_however_many_share_them(pieces: int) -> None:
    doubles = side_by_side(lambda piece: 2 * piece, list(range(pieces)), 3)

    assert doubles == [2 * piece for piece in range(pieces)]


def test_one_process_is_this_one() -> None:
    where = side_by_side(lambda _: os.getpid(), [1, 2, 3], 1)

    assert set(where) == {os.getpid()}


def test_what_is_lost_with_its_process_is_done_again() -> None:
    meet, here = meeting(), os.getpid()

    def deadly(piece: int) -> int:
        meet()
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return -piece

    assert side_by_side(deadly, [1, 2, 3], 2) == [-1, -2, -3]


def test_what_goes_wrong_in_another_process_is_raised_here() -> None:
    meet, here = meeting(), os.getpid()

    def failing(piece: int) -> int:
        meet()
        if os.getpid() != here or piece in lost:
            lost.append(piece)
            message = f"no such piece: {piece}"
            raise LookupError(message)
        lost.append(3 - piece)
        return piece

    lost: list[int] = []
    with pytest.raises(LookupError, match="no such piece"):
        side_by_side(failing, [1, 2], 2)


def test_a_copy_takes_nothing_more_once_its_original_is_gone(tmp_path: Path) -> None:
    """One that is killed amid four pieces, of which its copy has one in hand."""
    done = tmp_path / "done"
    fork = multiprocessing.get_context("fork")
    both = fork.Barrier(2)

    def original() -> None:
        here = os.getpid()

        def slow(piece: int) -> None:
            if piece < 2:
                both.wait(timeout=60)
            if os.getpid() == here:
                os.kill(here, signal.SIGKILL)
            while os.getppid() == here:
                time.sleep(0.01)
            with done.open("a") as file:
                file.write(f"{piece} ")

        side_by_side(slow, [0, 1, 2, 3], 2)

    parent = fork.Process(target=original)
    parent.start()
    parent.join()
    assert parent.exitcode == -signal.SIGKILL
    deadline = time.monotonic() + 60
    while not (done.exists() and done.read_text()) and time.monotonic() < deadline:
        time.sleep(0.01)
    # Whoever goes on does so at once: a second is ages.
    time.sleep(1.0)
    assert len(done.read_text().split()) == 1


def meeting() -> Callable[[], None]:
    """Give what waits, at the first call in a process, until another does."""
    both = multiprocessing.get_context("fork").Barrier(2)
    met: list[int] = []

    def meet() -> None:
        if os.getpid() not in met:
            met.append(os.getpid())
            both.wait(timeout=60)

    return meet
