"""The REST of a running daemon, as the commands ask it."""

import re
from collections.abc import Iterable, Iterator
from typing import Annotated, Any
from urllib.parse import quote

import httpx
import typer

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

LIST = frozenset({"grippers"})
"""Keys by which the answers of a daemon are told from those of something else."""

COMMANDS = (
    (r"POST \.\.\./(reset|enable)", r"gripperd \1"),
    (r"POST \.\.\./faults/(\w{8})\w*/acknowledge", r"gripperd acknowledge \1"),
    (r"POST /v1/models/(\S+)/activate", r"gripperd model activate \1"),
)
"""Hints that name a request, and what to type instead."""
OF_REQUESTS = re.compile(r"GET |Idempotency-Key")
"""Tells hints that nobody can follow who types commands."""


class Problem(GripperdError):
    """The daemon says no; the message is its problem document."""

    def __init__(self, document: dict[str, Any]) -> None:
        super().__init__(document.get("detail") or document.get("title") or "refused")
        self.hints = tuple(typed(document.get("hints") or ()))


def typed(hints: Iterable[str]) -> Iterator[str]:
    """Hints for who types commands.

    >>> list(typed(["mend the cause", "POST .../reset"]))
    ['mend the cause', 'gripperd reset']
    """
    for hint in hints:
        if OF_REQUESTS.search(hint):
            continue
        for request, command in COMMANDS:
            hint = re.sub(request, command, hint)
        yield hint


def where(url: str, gripper: str | None) -> str:
    """URL of a gripper; of the first when none is named."""
    grippers = f"{url.rstrip('/')}/v1/grippers"
    if gripper is None:
        gripper = str(ask("GET", grippers, LIST)["grippers"][0]["name"])
    return f"{grippers}/{quote(gripper, safe='', errors='surrogateescape')}"


def ask(
    method: str, url: str, keys: frozenset[str], *, body: object = None, wait: int = 0
) -> dict[str, Any]:
    """Ask for a document that has these keys.

    Parameters
    ----------
    method, url, body
        Of the request.
    keys
        That its answer has.
    wait
        How long the daemon may wait for the end of a command. [s]

    Raises
    ------
    Problem
        The daemon refuses.
    BadReply, LinkLost, InputError
        It is no gripperd; nobody answers; this is no address.
    """
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
