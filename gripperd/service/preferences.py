"""How long a client wants to wait: ``Prefer: wait=5`` (RFC 7240) or ``?wait_s=5``."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Header, Query
from pydantic import BaseModel, ConfigDict, Field

LONGEST_WAIT = 60.0
"""[s]"""


class _WaitQuery(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    wait_s: float | None = Field(
        default=None, ge=0, description="Answer once it is over, or after this time."
    )


@dataclass(frozen=True, slots=True)
class Waiting:
    """How long to wait for the end of a command."""

    seconds: float
    applied: str | None = None
    """Value of the reply's ``Preference-Applied``."""


async def _waiting(
    query: Annotated[_WaitQuery, Query()],
    prefer: Annotated[
        list[str] | None, Header(description="`wait=N`, seconds (RFC 7240).")
    ] = None,
) -> Waiting:
    if query.wait_s is not None:
        return Waiting(min(query.wait_s, LONGEST_WAIT))
    seconds = preferred_wait(prefer or ())
    if seconds is None:
        return Waiting(0.0)
    seconds = min(seconds, int(LONGEST_WAIT))
    return Waiting(seconds, f"wait={seconds}")


Wait = Annotated[Waiting, Depends(_waiting)]


def preferred_wait(headers: Sequence[str]) -> int | None:
    """Seconds of the first ``wait``; what cannot be understood is ignored.

    >>> preferred_wait(["respond-async, wait=10"])
    10
    """
    for header in headers:
        for preference in header.split(","):
            name, _, value = preference.partition(";")[0].partition("=")
            number = value.strip().strip('"')
            if name.strip().lower() == "wait" and number.isascii() and number.isdigit():
                return int(number[:9])
    return None
