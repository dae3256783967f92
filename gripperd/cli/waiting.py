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


@contextmanager
def interruptible(left: Callable[[], str]) -> Iterator[None]:
    """Let Ctrl-C end what is inside with a word about it.

    Parameters
    ----------
    left
        Says what is left behind, such as ``wrote nothing``.
    """
    here = os.getpid()

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        if os.getpid() != here:
            # A copy that shares the work has nothing to say.
            os._exit(INTERRUPTED)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(f"interrupted; {left()}", err=True)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        signal.signal(signal.SIGINT, before)
