"""Strict reading of YAML: plain values, and the line of every key.

YAML has surprises that a gripper cannot afford: in version 1.1 ``no`` is false,
``1:30`` is ninety and ``010`` is eight; an alias can blow a small file up to gigabytes;
a second ``diameter_mm`` silently replaces the first. Here only ``true``, ``false``,
``null`` and decimal numbers mean something, everything else is text, and aliases, tags,
repeated keys and numbers that are not finite are refused.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from gripperd.config.complaint import Complaint, KeyPath, printable
from gripperd.errors import ConfigError

MAX_BYTES = 1_000_000
MAX_DEPTH = 20

WORDS = {"true": True, "false": False, "null": None, "~": None, "": None}
INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]*)")
DECIMAL = re.compile(
    r"[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?",
)
NOT_FINITE = re.compile(r"[-+]?\.(inf|nan)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Document:
    """Plain values with the place of each, and what was wrong with the writing."""

    value: object
    source: str = ""
    """The file, or "" for values that came in a request."""
    lines: Mapping[KeyPath, int] = field(default_factory=dict)
    complaints: tuple[Complaint, ...] = ()
    """What was refused while reading on; nobody may use the value before looking."""
    root: KeyPath = ()
    """Where the value stands, when it is a part of a file."""

    def complaint(self, path: KeyPath, detail: str) -> Complaint:
        """Complain about a value; a missing key is placed where it should stand."""
        full = known = (*self.root, *path)
        while known and known not in self.lines:
            known = known[:-1]
        line = self.lines.get(known, 0)
        return Complaint(detail, source=self.source, line=line, path=full)


def read_document(path: Path) -> Document:
    """Read a YAML file.

    Raises
    ------
    ConfigError
        When it is no file, too large, not UTF-8 or not YAML. Lesser complaints stand
        in the document.
    """
    text = _text(path)
    reading = _Reading(text, str(path))
    try:
        value = reading.document()
    except yaml.MarkedYAMLError as broken:
        line = broken.problem_mark.line + 1 if broken.problem_mark else 0
        raise _refused(path, f"not YAML: {broken.problem}", line) from None
    except yaml.reader.ReaderError as broken:
        line = text.count("\n", 0, broken.position) + 1
        raise _refused(path, "holds a control character", line) from None
    except ConfigError:
        raise
    except (ValueError, OverflowError) as broken:
        # PyYAML hands an escape beyond Unicode, "\UFFFFFFFF", straight to chr().
        raise _refused(path, f"not YAML: {broken}") from None
    return Document(value, str(path), reading.lines, tuple(reading.complaints))


def _text(path: Path) -> str:
    try:
        if not path.is_file():
            there = path.exists()
            raise _refused(path, "is not a file" if there else "there is no such file")
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as broken:
        raise _refused(path, f"cannot be read: {broken.strerror}") from None
    if len(content) > MAX_BYTES:
        raise _refused(path, f"is larger than {MAX_BYTES} bytes")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as broken:
        line = content.count(b"\n", 0, broken.start) + 1
        raise _refused(path, "is not UTF-8 text", line) from None


def _refused(path: Path, detail: str, line: int = 0) -> ConfigError:
    return ConfigError(Complaint(detail, source=str(path), line=line))


class _Reading:
    """Turns the events of one YAML stream into values."""

    def __init__(self, text: str, source: str) -> None:
        self._events: Iterator[yaml.Event] = yaml.parse(text, Loader=yaml.SafeLoader)
        self._source = source
        self.lines: dict[KeyPath, int] = {(): 1}
        self.complaints: list[Complaint] = []

    def document(self) -> object:
        """Give the value of the one document in the stream."""
        next(self._events)
        if isinstance(next(self._events), yaml.StreamEndEvent):
            return None
        value = self._value(next(self._events), ())
        next(self._events)
        after = next(self._events)
        if not isinstance(after, yaml.StreamEndEvent):
            self._complain(after, (), "a second document starts; a file holds one")
        return value

    def _value(self, event: yaml.Event, path: KeyPath) -> object:
        if len(path) > MAX_DEPTH:
            detail = f"nested deeper than {MAX_DEPTH} levels"
            self._complain(event, path[:1], detail)
            raise ConfigError(*self.complaints)
        self._refuse_tricks(event, path)
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(path)
        if isinstance(event, yaml.SequenceStartEvent):
            return self._sequence(path)
        if isinstance(event, yaml.ScalarEvent):
            return self._scalar(event, path)
        return None

    def _mapping(self, path: KeyPath) -> dict[str, object]:
        mapping: dict[str, object] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            key = self._key(event, path)
            inside = (*path, key)
            if key in mapping:
                first = self.lines[inside]
                self._complain(event, inside, f"stands twice, first on line {first}")
            self.lines.setdefault(inside, _line(event))
            mapping.setdefault(key, self._value(next(self._events), inside))
        return mapping

    def _key(self, event: yaml.Event, path: KeyPath) -> str:
        if isinstance(event, yaml.ScalarEvent):
            self._refuse_tricks(event, path)
            return str(event.value)
        self._complain(event, path, "a key must be a word")
        self._value(event, (*path, ""))
        return ""

    def _refuse_tricks(self, event: yaml.Event, path: KeyPath) -> None:
        if isinstance(event, yaml.AliasEvent):
            self._complain(event, path, f'alias "*{event.anchor}" is refused')
        elif isinstance(event, yaml.NodeEvent) and event.anchor:
            self._complain(event, path, f'anchor "&{event.anchor}" is refused')
        tag = getattr(event, "tag", None)
        if isinstance(tag, str):
            short = tag.replace("tag:yaml.org,2002:", "!!")
            self._complain(event, path, f'tag "{printable(short)}" is refused')

    def _sequence(self, path: KeyPath) -> list[object]:
        items: list[object] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            inside = (*path, len(items))
            self.lines[inside] = _line(event)
            items.append(self._value(event, inside))
        return items

    def _scalar(self, event: yaml.ScalarEvent, path: KeyPath) -> object:
        text = str(event.value)
        if event.style is not None:
            return text
        if text in WORDS:
            return WORDS[text]
        number = DECIMAL.fullmatch(text)
        if NOT_FINITE.fullmatch(text) or (number and math.isinf(float(text))):
            self._complain(event, path, f"{printable(text)} is not a finite number")
            return None
        if INTEGER.fullmatch(text):
            return int(text)
        return float(text) if number else text

    def _complain(self, event: yaml.Event, path: KeyPath, detail: str) -> None:
        self.complaints.append(
            Complaint(detail, source=self._source, line=_line(event), path=path)
        )


def _line(event: yaml.Event) -> int:
    return event.start_mark.line + 1 if event.start_mark else 0
