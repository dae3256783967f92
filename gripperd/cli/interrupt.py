"""Ctrl-C in the middle of long work."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import typer

from gripperd.cli.app import INTERRUPTED

SIGNALS = (signal.SIGINT, signal.SIGALRM)
"""Ctrl-C, and the clock that repeats it."""
AGAIN = 0.05
"""Until an interrupt is tried again that struck where no error can come out: in what a
library in C calls, such as a compiler that is done with a piece. [s]"""


class _Interrupted(BaseException):
    """Somebody pressed Ctrl-C.

    Of a KeyboardInterrupt in a string that it runs Python keeps account, and dies of
    the signal rather than leave with a status.
    """


class _Listener:
    """Whether somebody pressed Ctrl-C."""

    def __init__(self) -> None:
        self.pressed = False
        self._here = os.getpid()
        self._beside = sys.unraisablehook

    def struck(self, _number: int, _frame: FrameType | None) -> None:
        """Leave whatever is being done."""
        if os.getpid() != self._here:
            # A copy that shares the work has nothing to say.
            os._exit(INTERRUPTED)
        self.pressed = True
        raise _Interrupted

    def swallowed(self, lost: "sys.UnraisableHookArgs") -> None:
        """Try again where it did not come out."""
        if lost.exc_type is _Interrupted:
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            self._beside(lost)


@contextmanager
def interruptible(left: Callable[[], str]) -> Iterator[None]:
    """Let Ctrl-C end what is inside with a word about it.

    Parameters
    ----------
    left
        Says what is left behind, such as ``wrote nothing``.
    """
    listener, hook = _Listener(), sys.unraisablehook
    before = {number: signal.signal(number, listener.struck) for number in SIGNALS}
    sys.unraisablehook = listener.swallowed
    try:
        yield
        if listener.pressed:
            raise _Interrupted
    except BaseException:
        # What is written in C and calls Python may make another error of it: numba,
        # while it loads machine code, a SystemError.
        if not listener.pressed:
            raise
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        typer.echo(f"interrupted; {left()}", err=True)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)
