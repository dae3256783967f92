"""Lines of text about a communication watchdog."""

import re
from collections.abc import Iterator

from gripperd.bench.channels import Outputs
from gripperd.bench.text_line import Deed, Filled, Grant, Understood, granted
from gripperd.protocol.dcon import Refusal
from gripperd.protocol.phrase import Phrase
from gripperd.protocol.watchdog import PhraseWatchdog


def watchdog_lines(module: Outputs, described: PhraseWatchdog) -> Iterator[Understood]:
    """Arming, telling and clearing, as a description has them."""
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

    yield described.arm, arm
    if described.armed is not None:
        yield described.armed, _telling(described.armed, module, described)
    yield from _trip_lines(module, described)


def _trip_lines(module: Outputs, described: PhraseWatchdog) -> Iterator[Understood]:
    clock = module.watchdog

    def status(asked: Filled) -> Filled:
        return {"value": f"{described.tripped if clock.tripped else 0:02X}"}

    def clear(asked: Filled) -> Filled:
        clock.clear()
        return {}

    if described.status is not None:
        yield described.status, status
    if described.clear is not None:
        yield described.clear, clear


def _telling(phrase: Phrase, module: Outputs, described: PhraseWatchdog) -> Deed:
    """Tells that the watchdog is armed, or the same in zeros."""

    def armed(asked: Filled) -> Filled | Grant:
        timeout = module.watchdog.timeout
        filled = {"time": described.time_text(timeout or 0.0)}
        if timeout is not None:
            return filled
        grant = granted(phrase, filled)
        return grant._replace(text=re.sub("[0-9]", "0", grant.text))

    return armed


def _steps(text: str, described: PhraseWatchdog) -> int | None:
    """Time-out in a line, None where it is no such number."""
    if len(text) != described.digits:
        return None
    try:
        return int(text, described.radix)
    except ValueError:
        return None
