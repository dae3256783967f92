"""Every error as a problem document (RFC 9457), and the one table of their statuses."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType

from pydantic import BaseModel, Field
from starlette.responses import Response

from gripperd import errors

RETRY_AFTER = "1"
"""When it may be worth asking again. [s]"""


class Category(StrEnum):
    """Who can do something about it."""

    REQUEST = "request"
    """The client: another request."""
    PRECONDITION = "precondition"
    """The state of things is in the way; the request may be right later."""
    LINK = "link"
    """A line inside the daemon or to the hardware."""
    INTERNAL = "internal"
    """A defect of gripperd."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What is the same about every problem with one code."""

    status: int
    title: str
    category: Category = Category.REQUEST
    retryable: bool = False
    """Whether the very same request may succeed later."""


PROBLEMS: Mapping[str, Kind] = MappingProxyType(
    {
        "malformed-json": Kind(400, "The body is not JSON"),
        "bad-request": Kind(400, "The request cannot be understood"),
        "foreign-origin": Kind(403, "A foreign web page may not ask"),
        "not-found": Kind(404, "There is no such thing"),
        "not-simulated": Kind(404, "There is no simulated bench"),
        "method-not-allowed": Kind(405, "The resource cannot do that"),
        "not-acceptable": Kind(406, "No acceptable representation"),
        "body-too-slow": Kind(408, "The body did not arrive in time", retryable=True),
        "wrong-state": Kind(
            409, "Not possible in this state", Category.PRECONDITION, retryable=True
        ),
        "object-held": Kind(
            409, "An object is being held", Category.PRECONDITION, retryable=True
        ),
        "not-acknowledged": Kind(
            409, "A fault was not acknowledged", Category.PRECONDITION
        ),
        "cause-present": Kind(
            409, "The cause of a fault is still there", Category.PRECONDITION
        ),
        "estopped": Kind(
            409, "The emergency stop is pressed", Category.PRECONDITION, retryable=True
        ),
        "not-enabled": Kind(
            409, "The external enable is missing", Category.PRECONDITION, retryable=True
        ),
        "already-final": Kind(409, "It is over already", Category.PRECONDITION),
        "not-finished": Kind(
            409, "It is not over yet", Category.PRECONDITION, retryable=True
        ),
        "model-unusable": Kind(
            409, "The version cannot be used", Category.PRECONDITION
        ),
        "model-changed": Kind(
            409, "The model was changed since", Category.PRECONDITION
        ),
        "recording-damaged": Kind(
            409, "The recording is not as it was sent", Category.PRECONDITION
        ),
        "nothing-found": Kind(409, "It ended without a result", Category.PRECONDITION),
        "not-named": Kind(409, "There is nothing to accept", Category.PRECONDITION),
        "not-confirmed": Kind(
            409, "Data left out do not confirm it", Category.PRECONDITION
        ),
        "already-accepted": Kind(409, "It was kept already", Category.PRECONDITION),
        "read-only": Kind(409, "The profile is an original", Category.PRECONDITION),
        "already-exists": Kind(409, "There is one already", Category.PRECONDITION),
        "changed-since": Kind(
            412, "It was changed since you read it", Category.PRECONDITION
        ),
        "body-too-large": Kind(413, "The body is too large"),
        "unsupported-media-type": Kind(415, "The body is of another type"),
        "misdirected": Kind(421, "Not a name of this service"),
        "invalid": Kind(422, "The request cannot be carried out as it is"),
        "infeasible": Kind(422, "The grasp would fail or do harm"),
        "idempotency-mismatch": Kind(422, "The key was used for another request"),
        "leased": Kind(
            423, "Somebody else has the lease", Category.PRECONDITION, retryable=True
        ),
        "lease-lost": Kind(423, "Your lease is over", Category.PRECONDITION),
        "if-match-required": Kind(428, "Say which version you change"),
        "queue-full": Kind(
            429, "Too many are waiting", Category.PRECONDITION, retryable=True
        ),
        "too-many-readers": Kind(
            429, "Too many follow the events", Category.PRECONDITION, retryable=True
        ),
        "headers-too-large": Kind(431, "The headers are too large"),
        "overloaded": Kind(503, "Too many ask at once", retryable=True),
        "internal": Kind(500, "A defect of gripperd", Category.INTERNAL),
        "link-lost": Kind(503, "A part is not there", Category.LINK, retryable=True),
        "no-reply": Kind(503, "A part did not answer", Category.LINK, retryable=True),
        "bad-reply": Kind(503, "A part talks nonsense", Category.LINK, retryable=True),
        "device-refused": Kind(503, "The device said no", Category.LINK),
        "link-down": Kind(
            503, "The gripper has no link", Category.LINK, retryable=True
        ),
        "storage-failed": Kind(
            503, "The disk did not take it", Category.INTERNAL, retryable=True
        ),
        "not-recorded": Kind(
            503, "The disk does not keep it", Category.INTERNAL, retryable=True
        ),
        "too-late": Kind(503, "It came too late", Category.LINK, retryable=True),
        "storage-full": Kind(
            507, "The disk is full", Category.PRECONDITION, retryable=True
        ),
        "not-ready": Kind(503, "Not ready", Category.LINK, retryable=True),
    }
)
"""Every code there is; the code never changes, the words may."""

REFUSED = Kind(409, "Not allowed now", Category.PRECONDITION)
"""For a refusal whose code is not in the table."""

CODES: tuple[tuple[type[errors.GripperdError], str], ...] = (
    (errors.NotFound, "not-found"),
    (errors.InputError, "invalid"),
    (errors.ConfigError, "invalid"),
    (errors.LinkLost, "link-lost"),
    (errors.ReplyTimeout, "no-reply"),
    (errors.BadReply, "bad-reply"),
    (errors.DeviceRefused, "device-refused"),
    (errors.LinkError, "link-lost"),
)
"""Code of each error that has none of its own; the first that fits."""


class Fault(BaseModel):
    """One value of the request that cannot be used, and where it stands."""

    pointer: str | None = Field(
        default=None, description="In the body, as RFC 6901 has it."
    )
    parameter: str | None = Field(default=None, description="In the path or the query.")
    header: str | None = None
    detail: str


class Problem(BaseModel):
    """What went wrong, for programs and people (RFC 9457)."""

    type: str
    title: str
    status: int
    detail: str
    instance: str = Field(description="Path of the request.")
    code: str = Field(description="Stable word for programs.")
    category: Category
    retryable: bool = Field(description="The same request may succeed later.")
    hints: tuple[str, ...] = Field(default=(), description="What you could do.")
    errors: tuple[Fault, ...] = Field(default=(), description="Every value at fault.")


def problem(
    code: str,
    detail: str,
    *,
    instance: str,
    hints: Sequence[str] = (),
    faults: Sequence[Fault] = (),
) -> Problem:
    """Fill in what the table says about a code."""
    kind = PROBLEMS.get(code, REFUSED)
    return Problem(
        type=f"urn:gripperd:problem:{code}",
        title=kind.title,
        status=kind.status,
        detail=detail,
        instance=instance,
        code=code,
        category=kind.category,
        retryable=kind.retryable,
        hints=tuple(hints),
        errors=tuple(faults),
    )


def code_of(error: errors.GripperdError) -> str:
    """Give the code of an error of ours."""
    if isinstance(error, errors.Refused):
        return error.code
    return next((code for kind, code in CODES if isinstance(error, kind)), "internal")


class ProblemResponse(Response):
    """A problem on its way to the client."""

    media_type = "application/problem+json"

    def __init__(
        self, found: Problem, headers: Mapping[str, str] | None = None
    ) -> None:
        more = {"retry-after": RETRY_AFTER} if found.status in {429, 503} else {}
        document = found.model_dump(mode="json", exclude_none=True)
        # What cannot be UTF-8, a lone surrogate of the client, becomes its JSON escape.
        text = json.dumps(document, ensure_ascii=False, allow_nan=False)
        body = text.encode("utf-8", "backslashreplace") + b"\n"
        super().__init__(body, found.status, {**more, **(headers or {})})
