"""The command tree, and what an error means for the exit status."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from gripperd import __version__
from gripperd.cli.console import console
from gripperd.errors import ConfigError, GripperdError, InputError

FAILED, WRONG_USE, UNUSABLE_CONFIGURATION, INTERRUPTED = 1, 2, 78, 130
"""Exit statuses; 78 is EX_CONFIG of sysexits.h, 130 is 128 + SIGINT as of a shell."""

MODULES = (
    "daemon",
    "demonstrating",
    "diagnosing",
    "examining",
    "faults",
    "model",
    "monitoring",
    "operate",
    "physics",
    "simulating",
)
"""Each registers its commands when it is imported."""
PROCESSES = {
    "run": "daemon",
    "control": "daemon",
    "service": "daemon",
    "bench": "simulating",
}
"""Modules of the commands that run for months, and load nothing else."""

app = typer.Typer(
    name="gripperd",
    help="Drives a gripper powered by a pneumatic artificial muscle.",
    add_completion=False,
    # Rich would take "[mm]" in a help text for a style.
    rich_markup_mode=None,
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
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback(invoke_without_command=True)
def version(
    context: typer.Context,
    show: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.")
    ] = False,
) -> None:
    """Drives a gripper powered by a pneumatic artificial muscle."""
    if show:
        typer.echo(f"gripperd {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(WRONG_USE)


def main() -> NoReturn:
    """Run the command line."""
    asked = sys.argv[1] if len(sys.argv) > 1 else ""
    for name in (PROCESSES[asked],) if asked in PROCESSES else MODULES:
        import_module(f"gripperd.cli.{name}")
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
    told = console(stderr=True, soft_wrap=True)
    for line in str(error).splitlines():
        told.print("error:", line)
    for hint in getattr(error, "hints", ()):
        told.print("  hint:", hint)
    sys.exit(status)
