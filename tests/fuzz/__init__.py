"""Random and mutated octets against every decoder: ``python -m tests.fuzz [N]``.

Whatever comes, a decoder answers or raises what it says that it raises; and what it
believes of a reply, its own other half would have said so.
"""

import random
from collections import Counter

from gripperd.protocol.dcon import Dcon

from .half import Case
from .modbus import modbus_halves
from .text import dcon_halves, itv_halves

SEED = 20_240_229


def cases() -> dict[str, Case]:
    """Every decoder, by name."""
    return {
        **modbus_halves(),
        **dcon_halves(Dcon(), "DCON"),
        **dcon_halves(Dcon(checksum=True), "DCON sum"),
        **itv_halves(),
    }


def fuzz(total: int, seed: int = SEED) -> dict[str, Counter[str]]:
    """Share so many inputs among the decoders, and count what became of them."""
    rng = random.Random(seed)
    found = {name: Counter[str]() for name in cases()}
    tries = [(case, found[name]) for name, case in cases().items()]
    for number in range(total):
        case, counts = tries[number % len(tries)]
        counts[case(rng)] += 1
    return found
