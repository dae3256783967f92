"""Faults on the command line: what is wrong, what was, and who has seen it."""

import json
from collections.abc import Iterator, Sequence
from datetime import datetime
from getpass import getuser
from typing import Annotated, Any, TypeAlias
from urllib.parse import quote

import typer

from gripperd.cli.app import Json, app
from gripperd.cli.rest import DEFAULT_URL, Name, Url, ask, where
from gripperd.errors import InputError

LIST, FAULT = frozenset({"faults"}), frozenset({"cause", "message"})
"""Keys by which the answers of a daemon are told from those of something else."""
EVERY = "all"
SHOWN = 8
"""Characters of an id; more are never needed to tell two faults apart."""
TO_ACKNOWLEDGE = "acknowledge"
"""The step of a way out that is taken here."""
STEPS = {"command": "give the next command"}
"""Steps that are no command of that name."""

Fault: TypeAlias = dict[str, Any]


@app.command()
def faults(
    url: Url = DEFAULT_URL,
    gripper: Name = None,
    active: Annotated[
        bool, typer.Option("--active", help="Only those that still matter.")
    ] = False,
    limit: Annotated[int, typer.Option(min=1, max=200, help="The last so many.")] = 20,
    as_json: Json = False,
) -> None:
    """List what went wrong, newest first, and what is left to be done about it."""
    query = f"?limit={limit}" + ("&active=true" if active else "")
    found = ask("GET", f"{where(url, gripper)}/faults{query}", LIST)
    if as_json:
        typer.echo(json.dumps(found))
        return
    for fault in found["faults"]:
        typer.echo("\n".join(lines(fault)))
    if not found["faults"]:
        typer.echo("no faults")


@app.command()
def acknowledge(
    fault: Annotated[str, typer.Argument(help=f"Beginning of its id, or '{EVERY}'.")],
    by: Annotated[
        str | None, typer.Option(help="Who has seen it; without one, the user.")
    ] = None,
    url: Url = DEFAULT_URL,
    gripper: Name = None,
    as_json: Json = False,
) -> None:
    """Say that a fault was seen; nothing else changes."""
    path = f"{where(url, gripper)}/faults"
    known = ask("GET", f"{path}?limit=200", LIST)["faults"]
    body = {"by": by or _user()}
    seen = [
        ask(
            "POST",
            f"{path}/{quote(each['id'], safe='')}/acknowledge",
            FAULT,
            body=body,
        )
        for each in _meant(fault, known)
    ]
    if as_json:
        typer.echo(json.dumps({"faults": seen}))
        return
    for each in seen:
        typer.echo("\n".join(lines(each)))
    if not seen:
        typer.echo("nothing to acknowledge")


def lines(fault: Fault) -> Iterator[str]:
    """Describe a fault for a person: what and since when, then the way out."""
    kind = "latched" if fault["latched"] else "told"
    what = fault["cause"] + (f" {fault['subject']}" if fault.get("subject") else "")
    seen = fault.get("acknowledged_by")
    seen = f", acknowledged by {seen}" if seen else ""
    begun = f"{fault['id'][:SHOWN]}  {what}, {kind}, {_when(fault)}"
    yield f"{begun}{seen}: {fault['message']}"
    if fault["way_out"]:
        steps = (STEPS.get(step, step) for step in fault["way_out"])
        yield f"          to do: {', '.join(steps)}"


def _when(fault: Fault) -> str:
    """How long it has been so."""
    since, gone = _clock(fault["raised_at"]), fault.get("cleared_at")
    if not fault["active"]:
        return f"{since} to {_clock(fault.get('reset_at') or gone)}"
    return f"since {since}" + (f", gone since {_clock(gone)}" if gone else "")


def _meant(fault: str, known: Sequence[Fault]) -> Sequence[Fault]:
    """The faults that an argument means.

    Raises
    ------
    InputError
        None, or several.
    """
    if fault == EVERY:
        return [each for each in known if TO_ACKNOWLEDGE in each["way_out"]]
    found = [each for each in known if each["id"].startswith(fault)]
    if len(found) == 1:
        return found
    told = ", ".join(each["id"][:SHOWN] for each in found or known) or "none"
    message = f"{len(found)} faults begin with {fault!r}; there is {told}"
    raise InputError(message, key="FAULT")


def _user() -> str:
    try:
        return getuser()
    except (KeyError, OSError):
        message = "this user has no name: say with --by who has seen it"
        raise InputError(message, key="--by") from None


def _clock(text: str | None) -> str:
    """Date and time of this machine's time zone."""
    if text is None:
        return "now"
    return f"{datetime.fromisoformat(text).astimezone():%Y-%m-%d %H:%M:%S}"
