"""A simulated module that speaks text: DCON or ADAM ASCII.

What a description does not say of the lines of DCON is as in the manual of the I-7024:
``~AA5N`` and ``$AA4N`` take the present output as safe value and as power-on value,
``$AA8N`` tells what is delivered. That ``~AA30`` disarms is not confirmed.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from gripperd.bench.channels import Inputs, Outputs
from gripperd.bench.text_channels import input_lines, output_lines
from gripperd.bench.text_line import (
    Deed,
    Filled,
    Grant,
    Understood,
    channel_of,
    granted,
    pattern,
)
from gripperd.bench.text_watchdog import watchdog_lines
from gripperd.protocol.dcon import Command, Refusal
from gripperd.protocol.engineering import engineering
from gripperd.protocol.modules import ModuleDialect
from gripperd.protocol.phrase import Phrase

DISARM = Phrase("~{unit}30{time}", "!{unit}")
KEEP_AS_SAFE = Phrase("~{unit}5{channel}", "!{unit}")
KEEP_AS_POWER_ON = Phrase("${unit}4{channel}", "!{unit}")
DELIVERED = Phrase("${unit}8{channel}", "!{unit}{value}")


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
        self._lines = [_Line(pattern(p.ask), p, deed) for p, deed in lines]
        self._kept_by_any = _kept_by_any(module, dialect)

    def answer(self, command: Command) -> Grant | Refusal:
        """Grant a line to this module, or refuse it."""
        if self._kept_by_any and isinstance(self._module, Outputs):
            self._module.watchdog.hear()
        asked = f"{command.lead.value}{command.text}"
        for line, phrase, deed in self._lines:
            found = line.fullmatch(asked)
            if found is not None:
                return self._do(phrase, deed, found.groupdict())
        return Refusal.INVALID

    def hear_host(self) -> None:
        """Take the line to every module that says that the host lives."""
        if isinstance(self._module, Outputs):
            self._module.watchdog.hear()

    def _do(self, phrase: Phrase, deed: Deed, asked: Filled) -> Grant | Refusal:
        if channel_of(asked) >= self._module.module.channels:
            return Refusal.INVALID
        done = deed(asked)
        if isinstance(done, Refusal | Grant):
            return done
        return granted(phrase, {**asked, **done})


def _lines(module: Outputs | Inputs, dialect: ModuleDialect) -> Iterator[Understood]:
    if isinstance(module, Inputs):
        yield from input_lines(module, module.module.phrases[dialect])
        return
    phrases = module.module.phrases[dialect]
    yield from output_lines(module, phrases)
    if phrases.watchdog is not None:
        yield from watchdog_lines(module, phrases.watchdog)
    if dialect is ModuleDialect.DCON:
        yield from _dcon_lines(module)


def _dcon_lines(module: Outputs) -> Iterator[Understood]:
    def disarm(asked: Filled) -> Filled:
        module.watchdog.disarm()
        return {}

    def keep_as_safe(asked: Filled) -> Filled:
        module.safe[channel_of(asked)] = module.currents()[channel_of(asked)]
        return {}

    def keep_as_power_on(asked: Filled) -> Filled:
        module.power_on[channel_of(asked)] = module.currents()[channel_of(asked)]
        return {}

    def delivered(asked: Filled) -> Filled:
        return {"value": engineering(module.delivered()[channel_of(asked)])}

    yield DISARM, disarm
    yield KEEP_AS_SAFE, keep_as_safe
    yield KEEP_AS_POWER_ON, keep_as_power_on
    yield DELIVERED, delivered


def _kept_by_any(module: Outputs | Inputs, dialect: ModuleDialect) -> bool:
    if isinstance(module, Inputs):
        return False
    described = module.module.phrases[dialect].watchdog
    return described is not None and described.keep is None
