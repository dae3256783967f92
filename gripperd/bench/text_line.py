"""Lines of text that a simulated module understands, and what they are granted with."""

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from gripperd.protocol.dcon import Good, Refusal
from gripperd.protocol.phrase import PLACE, Phrase

Filled: TypeAlias = Mapping[str, str]
"""What stands in the places of a template."""

WRITTEN = {
    "unit": "",
    "channel": "(?P<channel>[0-9A-F])",
    "value": "(?P<value>.*)",
    "time": "(?P<time>[0-9A-F]+)",
}
"""Places of a question, as patterns."""


class Grant(NamedTuple):
    """A reply that grants a line."""

    good: Good
    text: str


Deed: TypeAlias = Callable[[Filled], Filled | Grant | Refusal]
"""Does what a line asks for; gives the reply, or what stands in its places."""
Understood: TypeAlias = tuple[Phrase, Deed]
"""A line, and what is done about it."""


def granted(phrase: Phrase, filled: Filled) -> Grant:
    """Reply to a line, with its places filled in."""
    reply = phrase.reply or ""
    text = PLACE.sub(lambda place: filled.get(place[1], ""), reply[1:])
    return Grant(Good(reply[0]), text)


def channel_of(asked: Filled) -> int:
    """Channel that a line is about; the first where it names none."""
    return int(asked.get("channel", "0"), 16)


def pattern(ask: str) -> re.Pattern[str]:
    """What a line looks like without its unit."""
    parts = PLACE.split(ask)
    literal = map(re.escape, parts[::2])
    places = (*(WRITTEN[name] for name in parts[1::2]), "")
    return re.compile("".join(map("".join, zip(literal, places, strict=True))))
