"""Commands that talk to a running daemon over REST."""

import json
from typing import Annotated, Any
from urllib.parse import quote

import httpx
import typer

from gripperd.cli.app import Json, app
from gripperd.errors import BadReply, GripperdError, InputError, LinkLost

Url = Annotated[
    str, typer.Option("--url", envvar="GRIPPERD_URL", help="Where the daemon serves.")
]
Name = Annotated[
    str | None, typer.Option("--gripper", "-g", help="Without one, the first.")
]


DEFAULT_URL = "http://127.0.0.1:8765"
MARGIN = 5.0
"""Time for an answer beyond what the command itself may take. [s]"""


STATE = frozenset({"name", "machine", "grip", "link", "measured"})
COMMAND = frozenset({"status", "result", "error"})
LIST = frozenset({"grippers"})
"""Keys by which the answers of a daemon are told from those of something else."""


class Problem(GripperdError):
    """The daemon says no; the message is its problem document."""

    def __init__(self, document: dict[str, Any]) -> None:
        super().__init__(document.get("detail") or document.get("title") or "refused")
        self.hints = tuple(document.get("hints") or ())


@app.command()
def status(url: Url = DEFAULT_URL, gripper: Name = None, as_json: Json = False) -> None:
    """Show what the gripper does and measures."""
    state = _ask("GET", _where(url, gripper), STATE)
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
    state = _ask("POST", f"{_where(url, gripper)}/{what}", STATE)
    typer.echo(json.dumps(state) if as_json else f"{state['machine']}, {state['grip']}")


def _command(
    body: dict[str, Any], url: str, gripper: str | None, *, as_json: bool
) -> None:
    path = f"{_where(url, gripper)}/commands"
    command = _ask("POST", path, COMMAND, body=body, wait=30)
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


def _where(url: str, gripper: str | None) -> str:
    """URL of a gripper; of the first when none is named."""
    grippers = f"{url.rstrip('/')}/v1/grippers"
    if gripper is None:
        gripper = str(_ask("GET", grippers, LIST)["grippers"][0]["name"])
    return f"{grippers}/{quote(gripper, safe='', errors='surrogateescape')}"


def _ask(
    method: str, url: str, keys: frozenset[str], *, body: object = None, wait: int = 0
) -> dict[str, Any]:
    answer = _answer(method, url, body, wait)
    try:
        document = answer.json()
    except ValueError:
        document = None
    if answer.is_error and isinstance(document, dict):
        raise Problem(document)
    if not isinstance(document, dict) or not keys <= document.keys():
        message = f"what answers at {url} is no gripperd: status {answer.status_code}"
        raise BadReply(message)
    return document


def _answer(method: str, url: str, body: object, wait: int) -> httpx.Response:
    headers = {"Prefer": f"wait={wait}"} if wait else {}
    try:
        # A proxy of the environment has no business between here and the daemon.
        return httpx.request(
            method,
            url,
            json=body,
            headers=headers,
            timeout=wait + MARGIN,
            trust_env=False,
        )
    except (httpx.InvalidURL, httpx.UnsupportedProtocol) as error:
        message = f"--url: {url!r} is no address such as {DEFAULT_URL}: {error}"
        raise InputError(message, key="--url") from error
    except httpx.HTTPError as error:
        message = f"no daemon answers at {url}: {error}; 'gripperd run' starts one"
        raise LinkLost(message) from error
    except ValueError as error:
        message = f"this cannot be sent: {error}"
        raise InputError(message) from error
