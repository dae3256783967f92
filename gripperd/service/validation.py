"""What is wrong with a request, value by value, in words for a person."""

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, cast, get_args

from fastapi import Request
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from pydantic import BaseModel

from gripperd.config.complaint import Complaint, KeyPath, did_you_mean
from gripperd.config.wording import describe, shown
from gripperd.service.body import DISAGREEMENT
from gripperd.service.problems import Fault, Problem, problem

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

DECIMAL_COMMA = re.compile(r"([0-9]+),\s*([0-9]+)")
NEARBY = 20
"""How far from the place of an error its cause may begin. [characters]"""
TAG = "type"
"""Key that tells alternatives apart, wherever there are some."""
WHOLE_BODY = frozenset(
    {
        "missing",
        "dict_type",
        "model_type",
        "model_attributes_type",
        "union_tag_not_found",
    }
)
ABSENT_BODY = "the request needs a JSON object as its body"


def validation_problem(request: Request, refused: RequestValidationError) -> Problem:
    """Describe everything that pydantic refused."""
    errors = cast("Sequence[ErrorDetails]", refused.errors())
    path = request.url.path
    if errors[0]["type"] == "json_invalid":
        return _malformed(errors[0], str(refused.body), path)
    faults = [_fault(error, refused.body, request) for error in errors]
    return problem("invalid", _summary(faults), instance=path, faults=faults)


def complaints_problem(complaints: Sequence[str], path: str) -> Problem:
    """Describe everything that was found wrong with a document, or with a file."""
    faults = [_of_complaint(complaint) for complaint in complaints]
    return problem("invalid", _summary(faults), instance=path, faults=faults)


def _of_complaint(complaint: str) -> Fault:
    # A file has lines; a pointer is a place in the request.
    if isinstance(complaint, Complaint) and not complaint.source:
        return Fault(detail=complaint.detail, pointer=complaint.pointer)
    return Fault(detail=complaint)


def _summary(faults: Sequence[Fault]) -> str:
    said = [f"{_where(fault)}{fault.detail}" for fault in faults]
    if len(said) == 1:
        return said[0]
    return f"{len(said)} values cannot be used: {'; '.join(said)}"


def _where(fault: Fault) -> str:
    pointer = (fault.pointer or "").removeprefix("/").replace("/", ".")
    name = pointer or fault.parameter or fault.header
    return f"{name}: " if name else ""


def _malformed(error: "ErrorDetails", text: str, path: str) -> Problem:
    at = int(error["loc"][-1])
    line = text.count("\n", 0, at) + 1
    column = at - text.rfind("\n", 0, at)
    reason = error["ctx"]["error"]
    comma = DECIMAL_COMMA.search(text, max(at - NEARBY, 0), at + NEARBY)
    hint = "a decimal number is written with a point"
    if comma:
        hint += f": {comma[1]}.{comma[2]}, not {comma[1]},{comma[2]}"
    return problem(
        "malformed-json",
        f"line {line}, column {column}: {reason[:1].lower()}{reason[1:]}",
        instance=path,
        hints=(hint,) if comma else (),
    )


def _fault(error: "ErrorDetails", body: object, request: Request) -> Fault:
    place, *rest = error["loc"]
    if place == "body":
        path = _path(body, tuple(rest), error["type"])
        complaint = Complaint(_detail(error, path, request), path=path)
        return Fault(detail=complaint.detail, pointer=complaint.pointer)
    name = str(rest[0]) if rest else str(place)
    if error["type"] == "extra_forbidden":
        return Fault(detail="is not a parameter here", parameter=name)
    detail = describe(error, (name,))
    if place == "header":
        return Fault(detail=detail, header=name)
    return Fault(detail=detail, parameter=name)


def _path(body: object, steps: KeyPath, kind: str) -> KeyPath:
    """Keep the steps that lead through the body; the others name alternatives."""
    path: list[str | int] = []
    for step in steps:
        at_hand = body if isinstance(body, dict) else {}
        if isinstance(body, list):
            at_hand = dict(enumerate(body))
        if step in at_hand:
            body = at_hand[step]
            path.append(step)
    if kind.startswith("union_tag"):
        return (*path, TAG) if isinstance(body, dict) else tuple(path)
    return (*path, steps[-1]) if kind == "missing" and steps else tuple(path)


def _detail(error: "ErrorDetails", path: KeyPath, request: Request) -> str:
    kind = error["type"]
    if kind == "extra_forbidden":
        known = set(_keys(request, path[:-1]))
        if path[-1] in known:
            # The second step names the alternative that the body's type chose.
            return f"does not go with a {error['loc'][1]}"
        return f"is not a key here; {did_you_mean(str(path[-1]), known)}"
    if kind in WHOLE_BODY and not path:
        return ABSENT_BODY
    if kind == "union_tag_not_found":
        return "is missing"
    if kind == "union_tag_invalid":
        supported = error["ctx"]["expected_tags"].replace("'", "")
        tag = shown(error["input"][TAG])
        return f"{tag} is not supported; supported are: {supported}"
    if kind == "too_long":
        length, most = error["ctx"]["actual_length"], error["ctx"]["max_length"]
        return f"has {length} values; at most {most} are allowed"
    return error["msg"] if kind == DISAGREEMENT else describe(error, path)


def _keys(request: Request, path: KeyPath) -> set[str]:
    """Every key that a place in the body knows."""
    route = request.scope.get("route")
    if not isinstance(route, APIRoute) or route.body_field is None:
        return set()
    here = list(_models(route.body_field.field_info.annotation))
    for step in path:
        here = [
            inside
            for model in here
            for name, about in model.model_fields.items()
            if (about.alias or name) == step
            for inside in _models(about.annotation)
        ]
    return {
        about.alias or name
        for model in here
        for name, about in model.model_fields.items()
    }


def _models(annotation: object) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models(argument)
