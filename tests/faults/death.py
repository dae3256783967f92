"""Processes that die in the middle of a write, as far as is asked for."""

import os
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from io import StringIO
from itertools import count
from types import FrameType

ON_FILES = frozenset(
    {
        "open",
        "write",
        "flush",
        "close",
        "fsync",
        "replace",
        "rename",
        "link",
        "unlink",
        "mkdir",
        "rmdir",
        "flock",
    }
)
"""Calls by which Python changes files."""
CALLS = frozenset({"c_call", "c_return"})

Work = Callable[[], object]


def _end_of(child: int) -> bool:
    """Whether a child came to its own end; false if it was killed."""
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return False
    assert os.WEXITSTATUS(status) == 0, "the work failed before it could be cut short"
    return True


def forked(work: Work) -> int:
    """Work in a process of its own; its id."""
    child = os.fork()
    if child:
        return child
    status = 1
    try:
        work()
        status = 0
    finally:
        os._exit(status)


def killed_at_byte(work: Work, size: int) -> bool:
    """Work; whoever makes a file longer than a size dies at that very byte.

    Returns
    -------
    Whether it lived to the end.
    """

    def limited() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        work()

    return _end_of(forked(limited))


def killed_at_call(work: Work, number: int) -> bool:
    """Work, and be killed before or after one of the calls that change files.

    Even numbers are before a call, odd ones after it.

    Returns
    -------
    Whether it lived to the end, because there are fewer.
    """
    seen = count()

    def look(_: FrameType, event: str, what: object) -> None:
        if event in CALLS and _changes_a_file(what) and next(seen) == number:
            os.kill(os.getpid(), signal.SIGKILL)

    def watched() -> None:
        sys.setprofile(look)
        work()

    return _end_of(forked(watched))


def _changes_a_file(call: object) -> bool:
    in_memory = isinstance(getattr(call, "__self__", None), StringIO)
    return getattr(call, "__name__", "") in ON_FILES and not in_memory


def every_call(work: Work, prepare: Work) -> Iterator[int]:
    """Prepare and work, again and again, each time killed a call later."""
    for number in count():
        prepare()
        over = killed_at_call(work, number)
        yield number
        if over:
            return
