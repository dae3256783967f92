"""Commands that talk to a running daemon over REST."""

import json
from typing import Annotated, Any

import typer

from gripperd.cli.app import Json, app
from gripperd.cli.faults import lines
from gripperd.cli.rest import DEFAULT_URL, Name, Url, ask, where
from gripperd.errors import InputError

STATE = frozenset(
    {
        "name",
        "machine",
        "grip",
        "holding",
        "link",
        "measured",
        "faults",
        "hold_budget",
    }
)
COMMAND = frozenset({"status", "result", "error"})
"""Keys by which the answers of a daemon are told from those of something else."""


@app.command()
def status(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Show what the gripper does and measures, and what is wrong with it."""
    state = ask("GET", where(url, gripper), STATE)
    if as_json:
        typer.echo(json.dumps(state))
        return
    held = f" {state['holding']}" if state["holding"] else ""
    typer.echo(f"{state['name']}: {state['machine']}, {state['grip']}{held}")
    if state["link"] != "up":
        typer.echo(f"  link: {state['link']}")
    for fault in state["faults"]:
        for line in lines(fault):
            typer.echo(f"  {line}")
    for key, reading in state["measured"].items():
        value = "-" if reading["value"] is None else f"{reading['value']:.2f}"
        note = ""
        if reading["quality"] != "good":
            # Why there is no link was said above.
            cause = reading.get("cause", "").removesuffix(f": {state['link']}")
            note = f"  {reading['quality']}: {cause}"
        typer.echo(f"  {key:<14}{value:>10}{note}")
    if state["hold_budget"] is not None:
        typer.echo(f"  hold budget   {_lasting(state['hold_budget'])}")


@app.command()
def grasp(
    profile: Annotated[str, typer.Argument(help="Name of a profile.")],
    current: Annotated[
        float | None, typer.Option(help="Valve current instead of a force. [mA]")
    ] = None,
    force: Annotated[float | None, typer.Option(help="Grip force per jaw. [N]")] = None,
    url: Url = DEFAULT_URL,
    gripper: Name = None,
    as_json: Json = False,
) -> None:
    """Grasp an object and wait for the outcome; exit 1 unless it is held."""
    if current is not None and force is not None:
        message = "give --current or --force, not both"
        raise InputError(message, key="--force")
    params: dict[str, Any] = {"profile": profile}
    if current is not None:
        params["current_mA"] = current
    if force is not None:
        params["force_N"] = force
    _command({"type": "grasp", "params": params}, url, gripper, as_json=as_json)


@app.command()
def release(
    url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False
) -> None:
    """Open the jaws and wait until they let go."""
    _command({"type": "release"}, url, gripper, as_json=as_json)


@app.command()
def enable(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Allow commands after a start, a disable or a reset; nothing moves."""
    _switch("enable", url, gripper, as_json=as_json)


@app.command()
def disable(
    url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False
) -> None:
    """Allow no more commands; what is held stays held."""
    _switch("disable", url, gripper, as_json=as_json)


@app.command()
def reset(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Leave a mended fault or an emergency stop for disabled; nothing moves."""
    _switch("reset", url, gripper, as_json=as_json)


@app.command()
def stop(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Freeze at once; what is held stays held."""
    _switch("stop", url, gripper, as_json=as_json)


def _lasting(budget: dict[str, Any]) -> str:
    """How long the grip lasts after each loss."""
    losses = []
    for loss in ("air", "power", "bus"):
        seconds = budget[f"{loss}_s"]
        lasts = "stays" if seconds is None else f"{seconds:.1f} s"
        losses.append(f"without {loss} {lasts}")
    assumed = "  assumed: what is held is not known" if budget["assumed"] else ""
    return ", ".join(losses) + assumed


def _switch(what: str, url: str, gripper: str | None, *, as_json: bool) -> None:
    state = ask("POST", f"{where(url, gripper)}/{what}", STATE)
    typer.echo(json.dumps(state) if as_json else f"{state['machine']}, {state['grip']}")


def _command(
    body: dict[str, Any], url: str, gripper: str | None, *, as_json: bool
) -> None:
    path = f"{where(url, gripper)}/commands"
    command = ask("POST", path, COMMAND, body=body, wait=30)
    if as_json:
        typer.echo(json.dumps(command))
    else:
        typer.echo(_summary(command))
    if command["status"] != "succeeded":
        raise typer.Exit(1)


def _summary(command: dict[str, Any]) -> str:
    result, error = command["result"], command["error"]
    if result is None or result["slip_margin"] is None:
        line = str(command["status"])
    else:
        line = f"{result['outcome']}: {result['force_N']:.1f} N per jaw"
        if result["predicted_force_N"] is not None:
            line += (
                f", predicted {result['predicted_force_N']:.1f}"
                f" ± {result['predicted_std_N']:.1f} N"
            )
        line += (
            f"; slip margin {result['slip_margin']:.1f},"
            f" crush margin {result['crush_margin']:.1f}"
        )
    return line if error is None else f"{line}\n{error['code']}: {error['message']}"
