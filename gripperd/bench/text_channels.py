"""Lines of text about currents, safe values, ranges and the name of a module."""

from collections.abc import Iterator

from gripperd.bench.channels import Inputs, Outputs
from gripperd.bench.text_line import Deed, Filled, Understood, channel_of
from gripperd.errors import BadReply
from gripperd.protocol.dcon import Refusal
from gripperd.protocol.encoding import ROUNDING
from gripperd.protocol.engineering import engineering, from_engineering
from gripperd.protocol.modules import (
    Beyond,
    InputPhrases,
    OutputPhrases,
    RangePhrase,
)


def input_lines(module: Inputs, phrases: InputPhrases) -> Iterator[Understood]:
    """What an input module understands."""

    def read(asked: Filled) -> Filled:
        return {"value": "".join(map(engineering, module.currents()))}

    yield phrases.read, read
    yield from _setup_lines(module, phrases)


def output_lines(module: Outputs, phrases: OutputPhrases) -> Iterator[Understood]:
    """What an output module understands."""

    def read_back(asked: Filled) -> Filled:
        currents = module.currents() if phrases.echo else module.delivered()
        return {"value": engineering(currents[channel_of(asked)])}

    def safe(asked: Filled) -> Filled:
        return {"value": engineering(module.safe[channel_of(asked)])}

    yield phrases.write, _writing(module, phrases.beyond_range)
    yield phrases.read_back, read_back
    if phrases.safe is not None:
        yield phrases.safe, safe
    yield from _setup_lines(module, phrases)


def _writing(module: Outputs, beyond: Beyond) -> Deed:
    def write(asked: Filled) -> Filled | Refusal:
        try:
            current = from_engineering(asked["value"])
        except BadReply:
            return Refusal.INVALID
        if module.watchdog.tripped:
            return Refusal.WATCHDOG
        channel = channel_of(asked)
        chosen = module.ranges[channel]
        within = min(max(current, chosen.current_low), chosen.current_high)
        outside = abs(within - current) > ROUNDING
        if not (outside and beyond is Beyond.REFUSED):
            module.put_out(channel, within)
        told = outside and beyond is not Beyond.CLAMPED
        return Refusal.OUT_OF_RANGE if told else {}

    return write


def _setup_lines(
    module: Outputs | Inputs, phrases: OutputPhrases | InputPhrases
) -> Iterator[Understood]:
    if phrases.range_code is not None:
        yield phrases.range_code.phrase, _telling(module, phrases.range_code)
    if phrases.type_name is not None:
        yield phrases.type_name, lambda asked: {}


def _telling(module: Outputs | Inputs, described: RangePhrase) -> Deed:
    def range_code(asked: Filled) -> Filled:
        code = module.ranges[channel_of(asked)].code or 0
        return {"value": f"{code:02X}{described.rest}"}

    return range_code
