"""One complaint about one value: a line for a person, its place for a program."""

from collections.abc import Iterator, MutableSequence
from contextlib import contextmanager
from difflib import get_close_matches
from typing import TYPE_CHECKING, TypeAlias

from gripperd.errors import ConfigError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Self

KeyPath: TypeAlias = tuple[str | int, ...]
"""Keys and list positions from the top of a document to a value."""


class Complaint(str):
    """A line such as ``egg.yaml:4: diameter_mm: -41 mm is not above 0 mm``.

    It is the text that :class:`gripperd.errors.ConfigError` carries, and remembers
    what it was made of, so that a request can be answered with pointers.
    """

    __slots__ = ("detail", "line", "path", "source")
    source: str
    """The file, or "" when the value came in a request."""
    line: int
    """Line in the file, from 1; 0 when there is none."""
    path: KeyPath
    detail: str
    """What is wrong, without the place."""

    def __new__(
        cls, detail: str, *, source: str = "", line: int = 0, path: KeyPath = ()
    ) -> "Self":
        """Write the line."""
        where = f"{source}:{line}" if line else source
        parts = (where, dotted(path), detail)
        self = super().__new__(cls, ": ".join(part for part in parts if part))
        self.source, self.line, self.path, self.detail = source, line, path, detail
        return self

    @property
    def pointer(self) -> str:
        """The place as a JSON pointer (RFC 6901), such as ``/grasp/current_mA``."""
        steps = (str(step).replace("~", "~0").replace("/", "~1") for step in self.path)
        return "".join(f"/{step}" for step in steps)


def dotted(path: KeyPath) -> str:
    """Write a place for a person.

    >>> dotted(("valve", "pressure_kPa", 1))
    'valve.pressure_kPa[1]'
    """
    steps = (
        f"[{step}]" if isinstance(step, int) else f".{printable(step)}" for step in path
    )
    return "".join(steps).removeprefix(".")


def printable(text: str) -> str:
    """Escape what would move the cursor of a terminal, and cut what is too long."""
    shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text[:61])
    return shown if len(shown) <= 60 else f"{shown[:57]}..."


def did_you_mean(word: str, known: "Iterable[str]") -> str:
    """Name the word that was probably meant, or else all there are."""
    choice = sorted(known)
    close = get_close_matches(word[:64], choice, n=1)
    if close:
        return f'did you mean "{close[0]}"?'
    return f"there are: {', '.join(choice)}" if choice else "there are none"


@contextmanager
def gathering(complaints: MutableSequence[str]) -> Iterator[None]:
    """Keep what is wrong here, and go on, so that everything is said at once."""
    try:
        yield
    except ConfigError as refused:
        complaints.extend(refused.complaints)
