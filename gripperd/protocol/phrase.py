"""Lines of DCON with places to fill in, and the replies that grant them.

A template is text with ``{unit}``, ``{channel}`` (one digit), ``{value}`` and
``{time}``. Nothing else is replaced: what a description says reaches nothing but these.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from gripperd.errors import BadReply
from gripperd.protocol.dcon import HOST_OK, Ask, Good, Lead

PLACE = re.compile(r"\{([^{}]*)\}")
PLACES = frozenset({"unit", "channel", "value", "time"})
ASK = re.compile(r"[#$~%]\{unit\}[ -~]*|~\*\*")
REPLY = re.compile(r"(>|!\{unit\})[ -~]*")
CURRENT = 7
"""Characters of a current in engineering format."""


@dataclass(frozen=True, slots=True)
class Phrase:
    """One question and its answer, as templates."""

    ask: str
    """A lead and ``{unit}``, as in ``#{unit}{channel}{value}``; or ``~**``."""
    reply: str | None = None
    """Begins with ``>`` or ``!{unit}``; None where no module answers."""

    def __str__(self) -> str:
        """As manuals have it: AA is the address.

        >>> str(Phrase("~{unit}1", "!{unit}"))
        '~AA1'
        """
        return _fill(self.ask, {"unit": "AA", "channel": "N"})

    @property
    def places(self) -> frozenset[str]:
        """Everything that is to be filled in."""
        return frozenset(PLACE.findall(f"{self.ask}{self.reply or ''}"))

    def question(
        self, unit: int, filled: Mapping[str, str], length: int | None = 0
    ) -> Ask:
        """Question with its places filled in.

        Parameters
        ----------
        unit
            Whom it is for.
        filled
            What stands in the other places.
        length
            Characters of the value in the answer; None where the module decides.

        >>> str(Phrase("#{unit}{channel}{value}", ">").question(
        ...     1, {"channel": "0", "value": "+10.700"}))
        '#010+10.700'
        """
        if self.reply is None:
            return HOST_OK
        lead, text = self.ask[0], self.ask[1:].removeprefix("{unit}")
        good = Good(self.reply[0])
        expected = _fill(self._payload, filled)
        payload = None if length is None else len(expected) + length
        return Ask(unit, _fill(text, filled), Lead(lead), good, payload)

    def value(self, answer: str, filled: Mapping[str, str]) -> str:
        """Part of an answer that stands for ``{value}``; the rest must agree.

        Parameters
        ----------
        answer
            What follows the grant.
        filled
            As in the question.

        Raises
        ------
        BadReply
            The answer has another form.
        """
        parts = self._payload.partition("{value}")
        before, after = _fill(parts[0], filled), _fill(parts[2], filled)
        said = answer[len(before) : len(answer) - len(after)]
        wanted = filled.get("value", said) if parts[1] else ""
        if f"{before}{wanted}{after}" != answer or said != wanted:
            form = f"{before}{filled.get('value', '...') if parts[1] else ''}{after}"
            message = f'"{answer}" does not answer {self.ask}: "{form}" would'
            raise BadReply(message)
        return said

    @property
    def _payload(self) -> str:
        """Template of what follows the grant."""
        return (self.reply or "")[1:].removeprefix("{unit}")


def _fill(template: str, filled: Mapping[str, str]) -> str:
    return PLACE.sub(lambda place: filled.get(place[1], ""), template)
