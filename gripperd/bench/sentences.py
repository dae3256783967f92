"""What the sentences of a module description mean to the bench.

A description tells a person how a trip is cleared, what it outlives and what each bit
of a status says. The bench does as those sentences say.
"""

import re

from gripperd.protocol.live_zero import BROKEN_ABOVE, BROKEN_BELOW
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import Status
from gripperd.protocol.watchdog import Setting

CLEARING = re.compile(r"write (\d+) to (coil|holding register) (0x[0-9A-Fa-f]+|\d+)")
LASTING = "survives a power cycle"
OPEN = re.compile(r"\bopen\b|burn-out|broken wire")
UNDER = re.compile(r"\bunder\b")
OVER = re.compile(r"\bover\b")


def remedy(clear: str) -> Setting | None:
    """Register or coil that clears a trip; None where none is named.

    >>> str(remedy("write 1 to holding register 0x1007"))
    'holding register 4103 = 1'
    """
    found = CLEARING.search(clear)
    if found is None:
        return None
    table = Table.COILS if found[2] == "coil" else Table.HOLDING
    return Setting(table, int(found[3], 0), int(found[1]))


def lasts(acts: str) -> bool:
    """Whether a trip outlives a power cycle."""
    return LASTING in acts


def sign(status: Status, *meanings: re.Pattern[str]) -> int:
    """Status that says the first of these meanings that the module knows; 0 if none."""
    for meaning in meanings:
        for code, said in status.codes.items():
            if meaning.search(said):
                return code
        for bit, said in status.bits.items():
            if meaning.search(said):
                return 1 << bit
    return 0


def condition(status: Status, current: float) -> int:
    """Status of a 4-20 mA input at a current [A]; 0 while the loop is sound.

    The limits are those of NAMUR NE 43; modules have limits of their own.
    """
    if current < BROKEN_BELOW:
        return sign(status, OPEN, UNDER)
    return sign(status, OVER) if current > BROKEN_ABOVE else 0
