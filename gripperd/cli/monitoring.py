"""``gripperd bus``: what goes over the line of a daemon that runs."""

import asyncio
import json
import time
from contextlib import aclosing
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Annotated

import typer

from gripperd.cli.app import ConfigFile, Json, app
from gripperd.errors import InputError
from gripperd.units import MILLI

if TYPE_CHECKING:
    from gripperd.config import Settings
    from gripperd.drivers.transcript import Spoken

bus_app = typer.Typer(help="Look at a bus.", no_args_is_help=True)
app.add_typer(bus_app, name="bus")

ARROWS = {"request": "->", "reply": "<-"}


@bus_app.callback()
def bus() -> None:
    """Look at a bus."""


@bus_app.command()
def monitor(
    gripper: Annotated[
        str | None, typer.Argument(help="Whose bus; without one, the first.")
    ] = None,
    tcp: Annotated[
        str | None, typer.Option(help="HOST:PORT of the bus, instead of a gripper.")
    ] = None,
    port: Annotated[
        str | None, typer.Option(help="Device of the bus, instead of a gripper.")
    ] = None,
    count: Annotated[
        int | None, typer.Option(min=1, help="End after so many exchanges.")
    ] = None,
    config: ConfigFile = None,
    as_json: Json = False,
) -> None:
    """Show what a running daemon says to its modules, and what they answer.

    It asks the control process, which owns the bus: nothing is sent over the line.
    """
    from gripperd.config import load_settings

    given = [each for each in (gripper, tcp, port) if each is not None]
    if len(given) > 1:
        message = "give a gripper, --tcp or --port, not several"
        raise InputError(message)
    settings = load_settings(config)
    asyncio.run(_show(settings, gripper, tcp or port, count, as_json=as_json))


async def _show(
    settings: "Settings",
    gripper: str | None,
    address: str | None,
    count: int | None,
    *,
    as_json: bool,
) -> None:
    from gripperd.cli.listening import listen

    seen = 0
    async with aclosing(listen(settings, gripper, address)) as exchanges:
        async for halves in exchanges:
            for spoken in halves:
                typer.echo(_document(spoken) if as_json else _row(spoken))
            seen += 1
            if seen == count:
                return


def _row(spoken: "Spoken") -> str:
    meaning = spoken.meaning
    unit = "" if meaning.unit is None else f"unit {meaning.unit}"
    said = [meaning.said, *(f"{k} {v:.3f} mA" for k, v in _currents(spoken).items())]
    if spoken.error is not None:
        said.insert(0, spoken.error)
    clock = f"{_moment(spoken):%H:%M:%S.%f}"[:-3]
    arrow = ARROWS[spoken.direction]
    return f"{clock} {arrow} {unit:<8} {'  '.join(said)}"


def _document(spoken: "Spoken") -> str:
    meaning = spoken.meaning
    return json.dumps(
        {
            "time": _moment(spoken).isoformat(timespec="milliseconds"),
            "direction": spoken.direction,
            "unit": meaning.unit,
            "function": meaning.function,
            "registers": meaning.registers,
            "current_mA": _currents(spoken),
            "said": meaning.said,
            "error": spoken.error,
            "octets": spoken.octets.hex(" "),
        }
    )


def _currents(spoken: "Spoken") -> dict[str, float]:
    found = spoken.meaning.currents.items()
    return {name: round(current / MILLI, 4) for name, current in found}


def _moment(spoken: "Spoken") -> datetime:
    """When it was, by the clock on the wall: the machine has one monotonic clock."""
    wall = time.time() - time.monotonic() + spoken.time
    return datetime.fromtimestamp(wall, UTC).astimezone()
