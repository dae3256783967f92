"""Checking a document against a schema, with every complaint in its place."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, TypeVar, get_args

from pydantic import ValidationError

from gripperd.config.complaint import Complaint, KeyPath, did_you_mean
from gripperd.config.document import Document
from gripperd.config.section import Section, key_of
from gripperd.config.wording import describe
from gripperd.errors import ConfigError

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

SectionType = TypeVar("SectionType", bound=Section)


def validated(
    schema: type[SectionType], document: Document, context: object = None
) -> SectionType:
    """Check a document against a schema.

    A validator of the schema may read a further file and raise what is wrong there.

    Raises
    ------
    ConfigError
        With all that is wrong: this file in the order of its lines, then others.
    """
    try:
        section = schema.model_validate(document.value, context=context)
    except ValidationError as refused:
        errors = refused.errors(include_url=False)
        found = [line for error in errors for line in _lines(schema, document, error)]
    else:
        if not document.complaints:
            return section
        found = []
    # What could not even be read is not blamed a second time for what it is not.
    spoilt = {said.path for said in document.complaints}
    news = [line for line in found if not _spoilt(line, document.source, spoilt)]
    ordered = sorted(
        [*document.complaints, *news], key=lambda line: _order(line, document.source)
    )
    raise ConfigError(*dict.fromkeys(ordered))


def _lines(
    schema: type[Section], document: Document, error: "ErrorDetails"
) -> tuple[str, ...]:
    """Everything to say about one error of pydantic."""
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, ConfigError):
        return cause.complaints
    path = _place(document.value, error["loc"], error["type"])
    full = (*document.root, *path)
    if error["type"] == "extra_forbidden":
        hint = did_you_mean(str(path[-1]), _keys(schema, path[:-1]))
        return (document.complaint(path, f"is not a key here; {hint}"),)
    return (document.complaint(path, describe(error, full)),)


def _spoilt(line: str, source: str, paths: set[KeyPath]) -> bool:
    if not isinstance(line, Complaint) or line.source != source:
        return False
    return any(path[: len(line.path)] == line.path for path in paths)


def _order(line: str, source: str) -> tuple[bool, int]:
    if isinstance(line, Complaint) and line.source == source:
        return (False, line.line)
    return (True, 0)


def _place(value: object, loc: KeyPath, kind: str) -> KeyPath:
    """Keep the steps that lead through the document; the others name types."""
    path: list[str | int] = []
    for step in loc:
        inside = _inside(value)
        if step in inside:
            value = inside[step]
            path.append(step)
    return (*path, loc[-1]) if kind == "missing" else tuple(path)


def _inside(value: object) -> Mapping[str | int, object]:
    if isinstance(value, list):
        return dict(enumerate(value))
    return value if isinstance(value, dict) else {}


def _keys(schema: type[Section], path: KeyPath) -> set[str]:
    """Every key that a place knows; names of mappings lead to the same section."""
    here = [schema]
    for step in path:
        inside = [
            section
            for outer in here
            for field, about in outer.model_fields.items()
            if key_of(outer, field) == step
            for section in _sections(about.annotation)
        ]
        here = inside or here
    return {key_of(known, field) for known in here for field in known.model_fields}


def _sections(annotation: object) -> Iterator[type[Section]]:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        yield annotation
    for argument in get_args(annotation):
        yield from _sections(argument)
