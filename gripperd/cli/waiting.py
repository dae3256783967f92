"""How long work looks while it goes on, and when somebody ends it."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from gripperd.cli.app import INTERRUPTED


@contextmanager
def progress() -> Iterator[Callable[[str, float], None]]:
    """Show how far it is on a terminal; say nothing in a pipe."""
    bar = Progress(
        TextColumn("{task.description:<32}"),
        BarColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
    with bar:
        task = bar.add_task("", total=1.0)

        def tell(what: str, share: float) -> None:
            bar.update(task, description=what, completed=share)

        yield tell


class _Interrupted(BaseException):
    """Somebody pressed Ctrl-C.

    Of a KeyboardInterrupt in a string that it runs Python keeps account, and dies of
    the signal rather than leave with a status.
    """


@contextmanager
def interruptible(left: Callable[[], str]) -> Iterator[None]:
    """Let Ctrl-C end what is inside with a word about it.

    Parameters
    ----------
    left
        Says what is left behind, such as ``wrote nothing``.
    """
    here, pressed = os.getpid(), False

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        nonlocal pressed
        if os.getpid() != here:
            # A copy that shares the work has nothing to say.
            os._exit(INTERRUPTED)
        pressed = True
        raise _Interrupted

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    except BaseException:
        # What is written in C and calls Python may make another error of it: numba,
        # while it loads machine code, a SystemError.
        if not pressed:
            raise
        typer.echo(f"interrupted; {left()}", err=True)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        signal.signal(signal.SIGINT, before)
