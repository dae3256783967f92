"""Simulated modules that speak text: DCON, ADAM ASCII, and SMC regulators.

What a description does not say of the lines of DCON is as in the manual of the I-7024:
``~AA1`` clears a trip, ``~AA5N`` and ``$AA4N`` take the present output as safe value
and as power-on value, ``$AA8N`` tells what is delivered. That ``~AA30`` disarms, and
what these are granted with, is not confirmed.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple, TypeAlias

from gripperd.bench.channels import Inputs, Outputs
from gripperd.bench.rig import Rig
from gripperd.errors import BadReply
from gripperd.protocol import itv
from gripperd.protocol.dcon import Command, Good, Refusal
from gripperd.protocol.encoding import ROUNDING
from gripperd.protocol.engineering import engineering, from_engineering
from gripperd.protocol.modules import InputPhrases, ModuleDialect, OutputPhrases
from gripperd.protocol.phrase import PLACE, Phrase
from gripperd.protocol.watchdog import PhraseWatchdog

Filled: TypeAlias = Mapping[str, str]
"""What stands in the places of a template."""

WRITTEN = {
    "unit": "",
    "channel": "(?P<channel>[0-9A-F])",
    "value": "(?P<value>.*)",
    "time": "(?P<time>[0-9A-F]+)",
}
"""Places of a question, as patterns."""

CLEAR = Phrase("~{unit}1", "!{unit}")
DISARM = Phrase("~{unit}30{time}", "!{unit}")
KEEP_AS_SAFE = Phrase("~{unit}5{channel}", "!{unit}")
KEEP_AS_POWER_ON = Phrase("${unit}4{channel}", "!{unit}")
DELIVERED = Phrase("${unit}8{channel}", "!{unit}{value}")


class Grant(NamedTuple):
    """A reply that grants a line."""

    good: Good
    text: str


Deed: TypeAlias = Callable[[Filled], Filled | Grant | Refusal]
"""Does what a line asks for; gives the reply, or what stands in its places."""


class _Line(NamedTuple):
    """A line that a module understands."""

    pattern: re.Pattern[str]
    phrase: Phrase
    deed: Deed


class TextDevice:
    """One module of a line of DCON or ADAM ASCII."""

    def __init__(self, module: Outputs | Inputs, dialect: ModuleDialect) -> None:
        self._module = module
        lines = _lines(module, dialect)
        self._lines = [_Line(_pattern(p.ask), p, deed) for p, deed in lines]
        self._kept_by_any = _kept_by_any(module, dialect)

    def answer(self, command: Command) -> Grant | Refusal:
        """Grant a line to this module, or refuse it."""
        if self._kept_by_any and isinstance(self._module, Outputs):
            self._module.watchdog.hear()
        asked = f"{command.lead.value}{command.text}"
        for pattern, phrase, deed in self._lines:
            found = pattern.fullmatch(asked)
            if found is not None:
                return self._do(phrase, deed, found.groupdict())
        return Refusal.INVALID

    def hear_host(self) -> None:
        """Take the line to every module that says that the host lives."""
        if isinstance(self._module, Outputs):
            self._module.watchdog.hear()

    def _do(self, phrase: Phrase, deed: Deed, asked: Filled) -> Grant | Refusal:
        if int(asked.get("channel", "0"), 16) >= self._module.module.channels:
            return Refusal.INVALID
        done = deed(asked)
        if isinstance(done, Refusal | Grant):
            return done
        return _granted(phrase, {**asked, **done})


class ItvDevice:
    """One SMC regulator; it measures the pressure at the outlet of the rig."""

    def __init__(self, outputs: Outputs, rig: Rig) -> None:
        self._outputs = outputs
        self._rig = rig

    def answer(self, request: itv.Request | itv.Refusal) -> int | itv.Refusal:
        """Count that was asked for or set, or why not."""
        scale = self._outputs.ranges[0]
        match request:
            case itv.Refusal():
                return request
            case itv.Set(count):
                self._outputs.put_out(0, scale.current(count))
                return count
            case itv.Query.SET_POINT:
                return round(scale.count(self._outputs.currents()[0]))
            case itv.Query.PRESSURE:
                count = round(scale.count(self._rig.outlet_current()))
                return min(max(count, 0), itv.FULL_SCALE)


def _lines(
    module: Outputs | Inputs, dialect: ModuleDialect
) -> Iterator[tuple[Phrase, Deed]]:
    if isinstance(module, Inputs):
        yield from _input_lines(module, module.module.phrases[dialect])
        return
    phrases = module.module.phrases[dialect]
    yield from _output_lines(module, phrases)
    if phrases.watchdog is not None:
        yield from _watchdog_lines(module, phrases.watchdog)
    if dialect is ModuleDialect.DCON:
        yield from _dcon_lines(module)


def _input_lines(
    module: Inputs, phrases: InputPhrases
) -> Iterator[tuple[Phrase, Deed]]:
    def read(asked: Filled) -> Filled:
        return {"value": "".join(map(engineering, module.currents()))}

    yield phrases.read, read


def _output_lines(
    module: Outputs, phrases: OutputPhrases
) -> Iterator[tuple[Phrase, Deed]]:
    def write(asked: Filled) -> Filled | Refusal:
        try:
            current = from_engineering(asked["value"])
        except BadReply:
            return Refusal.INVALID
        if module.watchdog.tripped:
            return Refusal.WATCHDOG
        channel = _channel(asked)
        chosen = module.ranges[channel]
        within = min(max(current, chosen.current_low), chosen.current_high)
        module.put_out(channel, within)
        return {} if abs(within - current) <= ROUNDING else Refusal.OUT_OF_RANGE

    def read_back(asked: Filled) -> Filled:
        currents = module.currents() if phrases.echo else module.delivered()
        return {"value": engineering(currents[_channel(asked)])}

    def safe(asked: Filled) -> Filled:
        return {"value": engineering(module.safe[_channel(asked)])}

    yield phrases.write, write
    yield phrases.read_back, read_back
    if phrases.safe is not None:
        yield phrases.safe, safe


def _watchdog_lines(
    module: Outputs, described: PhraseWatchdog
) -> Iterator[tuple[Phrase, Deed]]:
    clock = module.watchdog

    def arm(asked: Filled) -> Filled | Refusal:
        steps = _steps(asked["time"], described)
        if steps is None:
            return Refusal.INVALID
        if steps:
            clock.arm(steps * described.step)
        else:
            clock.disarm()
        return {}

    def status(asked: Filled) -> Filled:
        return {"value": f"{described.tripped if clock.tripped else 0:02X}"}

    yield described.arm, arm
    if described.armed is not None:
        yield described.armed, _telling(described.armed, module, described)
    if described.status is not None:
        yield described.status, status


def _telling(phrase: Phrase, module: Outputs, described: PhraseWatchdog) -> Deed:
    """Tells that the watchdog is armed, or the same in zeros."""

    def armed(asked: Filled) -> Filled | Grant:
        timeout = module.watchdog.timeout
        filled = {"time": described.time_text(timeout or 0.0)}
        if timeout is not None:
            return filled
        granted = _granted(phrase, filled)
        return granted._replace(text=re.sub("[0-9]", "0", granted.text))

    return armed


def _steps(text: str, described: PhraseWatchdog) -> int | None:
    """Time-out in a line, None where it is no such number."""
    if len(text) != described.digits:
        return None
    try:
        return int(text, described.radix)
    except ValueError:
        return None


def _granted(phrase: Phrase, filled: Filled) -> Grant:
    reply = phrase.reply or ""
    text = PLACE.sub(lambda place: filled.get(place[1], ""), reply[1:])
    return Grant(Good(reply[0]), text)


def _dcon_lines(module: Outputs) -> Iterator[tuple[Phrase, Deed]]:
    def clear(asked: Filled) -> Filled:
        module.watchdog.clear()
        return {}

    def disarm(asked: Filled) -> Filled:
        module.watchdog.disarm()
        return {}

    def keep_as_safe(asked: Filled) -> Filled:
        module.safe[_channel(asked)] = module.currents()[_channel(asked)]
        return {}

    def keep_as_power_on(asked: Filled) -> Filled:
        module.power_on[_channel(asked)] = module.currents()[_channel(asked)]
        return {}

    def delivered(asked: Filled) -> Filled:
        return {"value": engineering(module.delivered()[_channel(asked)])}

    yield CLEAR, clear
    yield DISARM, disarm
    yield KEEP_AS_SAFE, keep_as_safe
    yield KEEP_AS_POWER_ON, keep_as_power_on
    yield DELIVERED, delivered


def _kept_by_any(module: Outputs | Inputs, dialect: ModuleDialect) -> bool:
    if isinstance(module, Inputs):
        return False
    described = module.module.phrases[dialect].watchdog
    return described is not None and described.keep is None


def _channel(asked: Filled) -> int:
    return int(asked.get("channel", "0"), 16)


def _pattern(ask: str) -> re.Pattern[str]:
    parts = PLACE.split(ask)
    literal = map(re.escape, parts[::2])
    places = (*(WRITTEN[name] for name in parts[1::2]), "")
    return re.compile("".join(map("".join, zip(literal, places, strict=True))))
