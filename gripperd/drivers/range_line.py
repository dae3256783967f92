"""Comparing the range of a module that speaks text with what is expected."""

import re
from collections.abc import Sequence

from gripperd.drivers.bus import Bus
from gripperd.drivers.registers import called
from gripperd.drivers.wiring import InputWiring, OutputWiring
from gripperd.errors import BadReply, DeviceRefused, ModuleMismatch, WatchdogTripped
from gripperd.protocol.dcon import Ask
from gripperd.protocol.modules import RangePhrase

CODE = re.compile(r"[0-9A-F]{2}")


async def check_range(
    bus: Bus[Ask, str],
    wiring: OutputWiring | InputWiring,
    channels: Sequence[int],
    described: RangePhrase | None,
) -> bool:
    """Ask every channel in use for its range.

    Parameters
    ----------
    bus, wiring
        Where the module is, and what it is said to be set to.
    channels
        Those in use.
    described
        What to ask; None where no line is confirmed.

    Returns
    -------
    Whether all were compared; False where the module does not tell.

    Raises
    ------
    ModuleMismatch
        One has another range.
    LinkError
        No trustworthy answer came.
    """
    expected = wiring.range.code
    if described is None or expected is None:
        return False
    for channel in channels:
        try:
            found = await _code(bus, wiring.unit, channel, described)
        except WatchdogTripped:
            raise
        except DeviceRefused:
            return False
        if found != expected:
            message = (
                f"channel {channel} of {wiring.module.name}, unit {wiring.unit}, has"
                f" range code {called(wiring.module, found, 2)},"
                f" {called(wiring.module, expected, 2)} is wanted: set it with the"
                " maker's utility"
            )
            raise ModuleMismatch(message)
    return True


async def _code(
    bus: Bus[Ask, str], unit: int, channel: int, described: RangePhrase
) -> int:
    phrase = described.phrase
    filled = {"unit": f"{unit:02X}", "channel": f"{channel:X}"}
    question = phrase.question(unit, filled, 2 + len(described.rest))
    said = phrase.value(await bus.ask(question), filled)
    if not CODE.match(said):
        message = f'"{said}" does not begin with a range code, the reply to {phrase}'
        raise BadReply(message)
    return int(said[:2], 16)
