"""The command tree, and what an error means for the exit status."""

import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from rich.console import Console

from gripperd.errors import ConfigError, GripperdError, InputError

FAILED, WRONG_USE, UNUSABLE_CONFIGURATION = 1, 2, 78
"""Exit statuses; 78 is EX_CONFIG of sysexits.h."""

app = typer.Typer(
    name="gripperd",
    help="Drives a gripper powered by a pneumatic artificial muscle.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

ConfigFile = Annotated[
    Path | None,
    typer.Option(
        "--config",
        "-c",
        envvar="GRIPPERD_CONFIG",
        help="Configuration file; without one, the simulated bench.",
    ),
]


def main() -> NoReturn:
    """Run the command line."""
    # Imported here, so that each command registers itself.
    from gripperd.cli import daemon, operate, physics  # noqa: F401

    try:
        app()
    except ConfigError as error:
        _complain(error, UNUSABLE_CONFIGURATION)
    except InputError as error:
        _complain(error, WRONG_USE)
    except GripperdError as error:
        _complain(error, FAILED)
    sys.exit(0)


def _complain(error: GripperdError, status: int) -> NoReturn:
    console = Console(stderr=True, soft_wrap=True, highlight=False)
    for line in str(error).splitlines():
        console.print("error:", line, markup=False)
    for hint in getattr(error, "hints", ()):
        console.print("  hint:", hint, markup=False)
    sys.exit(status)
