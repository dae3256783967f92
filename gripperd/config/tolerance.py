"""Numbers known only to within a tolerance: ``{value: 300, tolerance: 4}``."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeAlias

from pydantic import Field

from gripperd.config.complaint import Complaint, KeyPath
from gripperd.config.document import Document
from gripperd.config.section import Section
from gripperd.config.validation import validated
from gripperd.errors import ConfigError

Sigmas: TypeAlias = dict[KeyPath, float]
"""One sigma by the place of the number, in the unit of its key."""


class Known(Section):
    """A number and its one sigma, in the unit of the key they stand under.

    A sigma of 0 says that the number is exact, as files may that round theirs.
    """

    value: float
    tolerance: float = Field(ge=0)


def without_tolerances(document: Document) -> tuple[Document, Sigmas]:
    """Put plain numbers where a document states a tolerance, and say which.

    What is wrong with one is kept in the document, like everything in its writing.
    """
    sigmas: Sigmas = {}
    complaints: list[str] = []
    value = _plain(document, (), sigmas, complaints)
    found = [said for said in complaints if isinstance(said, Complaint)]
    return (
        replace(document, value=value, complaints=(*document.complaints, *found)),
        sigmas,
    )


def _plain(
    part: Document, path: KeyPath, sigmas: Sigmas, complaints: list[str]
) -> object:
    def inside(step: str | int, value: object) -> object:
        below = (*path, step)
        there = replace(part, value=value, root=below, complaints=())
        return _plain(there, below, sigmas, complaints)

    if isinstance(part.value, list):
        return [inside(index, item) for index, item in enumerate(part.value)]
    if not isinstance(part.value, dict):
        return part.value
    # An effect has a name, and may have a parameter called value.
    if "value" not in part.value or "name" in part.value:
        return {key: inside(key, value) for key, value in part.value.items()}
    try:
        known = validated(Known, part)
    except ConfigError as refused:
        complaints.extend(refused.complaints)
        return None
    sigmas[path] = known.tolerance
    return known.value


def moved(document: Document, sigmas: Mapping[KeyPath, float], by: float) -> Document:
    """Move every number with a tolerance by some sigmas."""

    def shifted(value: object, path: KeyPath) -> object:
        if isinstance(value, list):
            return [shifted(item, (*path, index)) for index, item in enumerate(value)]
        if isinstance(value, dict):
            return {key: shifted(item, (*path, key)) for key, item in value.items()}
        if isinstance(value, float):
            return value + by * sigmas.get(path, 0.0)
        return value

    return replace(document, value=shifted(document.value, ()))
