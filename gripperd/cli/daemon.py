"""Commands that start the daemon or parts of it, and check its configuration."""

import atexit
import json
import logging
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TextIO, cast

import structlog
import typer

from gripperd.cli.app import ConfigFile, app
from gripperd.cli.console import console
from gripperd.errors import InputError

if TYPE_CHECKING:
    from gripperd.cli.spool import Spool

LAST_WORDS = 0.5
"""How long the end of a process waits for its log to be read. [s]"""

config_app = typer.Typer(help="Look at the configuration.", no_args_is_help=True)
app.add_typer(config_app, name="config")

Tcp = Annotated[
    str | None,
    typer.Option("--tcp", help="HOST:PORT to listen on, instead of the settings'."),
]
Bench = Annotated[
    str | None,
    typer.Option("--bench", help="HOST:PORT of the bench, instead of the settings'."),
]

Http = Annotated[
    str | None,
    typer.Option("--http", help="HOST:PORT to serve on, instead of the settings'."),
]


@app.command()
def run(config: ConfigFile = None) -> None:
    """Run the daemon: control, service and, without hardware, the bench."""
    from gripperd.cli.run import run as run_daemon
    from gripperd.config import load_settings
    from gripperd.store import with_active_models

    settings = load_settings(config)
    # A damaged version is told before anything is started.
    with_active_models(settings)
    log_to_stderr()
    raise typer.Exit(run_daemon(settings, console(soft_wrap=True)))


@app.command()
def control(config: ConfigFile = None, bench: Bench = None) -> None:
    """Run the control process alone."""
    from gripperd.cli import processes
    from gripperd.config import load_settings
    from gripperd.store import with_active_models

    settings = with_active_models(load_settings(config))
    spool = log_to_stderr()
    address = host_and_port("--bench", bench)
    control = processes.control(settings, address, lambda: spool.dropped)
    processes.run_process(control)


@app.command()
def service(config: ConfigFile = None, http: Http = None) -> None:
    """Run the service process alone: REST in front of control."""
    from gripperd.cli import serving
    from gripperd.cli.processes import run_process
    from gripperd.config import KEYLESS, is_loopback, load_settings

    settings = load_settings(config)
    log_to_stderr()
    address = host_and_port("--http", http)
    if address is not None and not is_loopback(address[0]):
        message = f"--http {http!r} is not a loopback address; {KEYLESS}"
        raise InputError(message, key="--http")
    run_process(serving.service(settings, address))


@config_app.command()
def check(
    config: Annotated[
        Path | None, typer.Argument(help="File to check; default as for run.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Check a configuration with everything it refers to; exit 78 if unusable."""
    from gripperd.cli.doubts import doubts
    from gripperd.config import load_settings
    from gripperd.store import with_active_models

    settings = with_active_models(load_settings(config))
    models = {name: one.chain.name for name, one in settings.grippers.items()}
    warnings = list(doubts(settings))
    if as_json:
        facts = {
            "source": str(settings.source),
            "models": models,
            "profiles": list(settings.profiles),
            "warnings": warnings,
        }
        typer.echo(json.dumps(facts))
        return
    typer.echo(f"{settings.source}: usable")
    for name, model in models.items():
        typer.echo(f"  gripper {name}: model {model}")
    typer.echo(f"  profiles: {', '.join(settings.profiles)}")
    for warning in warnings:
        typer.echo(f"  warning: {warning}")


def host_and_port(option: str, address: str | None) -> tuple[str, int] | None:
    """Read the address that an option gives, if it does.

    Raises
    ------
    InputError
        It is none.
    """
    if address is None:
        return None
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal() or int(port) > 65535:
        message = f"{option} {address!r} is not HOST:PORT, such as 127.0.0.1:15020"
        raise InputError(message, key=option)
    return host.removeprefix("[").removesuffix("]"), int(port)


def log_to_stderr() -> "Spool":
    """Plain lines; on a terminal in colour, without time stamps in the journal."""
    from gripperd.cli.spool import Spool

    spool = Spool(sys.stderr.fileno())
    atexit.register(spool.close, LAST_WORDS)
    stamp = [structlog.processors.TimeStamper(fmt="%H:%M:%S")]
    structlog.configure(
        processors=[
            structlog.processors.add_log_level,
            # The journal keeps its own time; systemd tells that it listens.
            *(() if os.environ.get("JOURNAL_STREAM") else stamp),
            structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty()),
        ],
        wrapper_class=structlog.make_filtering_bound_logger(logging.INFO),
        logger_factory=structlog.WriteLoggerFactory(cast("TextIO", spool)),
    )
    return spool
