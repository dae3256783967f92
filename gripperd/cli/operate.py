"""Commands that talk to a running daemon over REST."""

import json
from typing import Annotated, Any

import httpx
import typer

from gripperd.cli.app import app
from gripperd.errors import GripperdError, InputError, LinkLost

Url = Annotated[
    str, typer.Option("--url", envvar="GRIPPERD_URL", help="Where the daemon serves.")
]
Name = Annotated[
    str | None, typer.Option("--gripper", "-g", help="Without one, the first.")
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]

DEFAULT_URL = "http://127.0.0.1:8765"
MARGIN = 5.0
"""Time for an answer beyond what the command itself may take. [s]"""


class Problem(GripperdError):
    """The daemon says no; the message is its problem document."""

    def __init__(self, document: dict[str, Any]) -> None:
        super().__init__(document.get("detail") or document.get("title") or "refused")
        self.hints = tuple(document.get("hints") or ())


@app.command()
def status(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Show what the gripper does and measures."""
    state = _ask("GET", f"{url}/v1/grippers/{_name(url, gripper)}")
    if as_json:
        typer.echo(json.dumps(state))
        return
    typer.echo(f"{state['name']}: {state['machine']}, {state['grip']}")
    if state["link"] != "up":
        typer.echo(f"  link: {state['link']}")
    for key, reading in state["measured"].items():
        value = "-" if reading["value"] is None else f"{reading['value']:.2f}"
        note = ""
        if reading["quality"] != "good":
            note = f"  {reading['quality']}: {reading.get('cause', '')}"
        typer.echo(f"  {key:<14}{value:>10}{note}")


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
def enable(url: Url = DEFAULT_URL, gripper: Name = None) -> None:
    """Allow commands after a start or a disable; nothing moves."""
    _switch("enable", url, gripper)


@app.command()
def disable(url: Url = DEFAULT_URL, gripper: Name = None) -> None:
    """Allow no more commands; what is held stays held."""
    _switch("disable", url, gripper)


@app.command()
def stop(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Freeze at once; what is held stays held."""
    _switch("stop", url, gripper, as_json=as_json)


def _switch(what: str, url: str, gripper: str | None, *, as_json: bool = False) -> None:
    state = _ask("POST", f"{url}/v1/grippers/{_name(url, gripper)}/{what}")
    typer.echo(json.dumps(state) if as_json else f"{state['machine']}, {state['grip']}")


def _command(
    body: dict[str, Any], url: str, gripper: str | None, *, as_json: bool
) -> None:
    path = f"{url}/v1/grippers/{_name(url, gripper)}/commands"
    command = _ask("POST", path, body=body, wait=30)
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


def _name(url: str, gripper: str | None) -> str:
    if gripper is not None:
        return gripper
    listing = _ask("GET", f"{url}/v1/grippers")
    return str(listing["grippers"][0]["name"])


def _ask(
    method: str, url: str, *, body: object = None, wait: int = 0
) -> dict[str, Any]:
    headers = {"Prefer": f"wait={wait}"} if wait else {}
    try:
        answer = httpx.request(
            method, url, json=body, headers=headers, timeout=wait + MARGIN
        )
    except httpx.TransportError as error:
        message = f"no daemon answers at {url}: {error}; 'gripperd run' starts one"
        raise LinkLost(message) from error
    document: dict[str, Any] = answer.json()
    if answer.is_error:
        raise Problem(document)
    return document
