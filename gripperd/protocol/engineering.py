"""Currents in the engineering format of DCON and ADAM ASCII: mA, seven characters."""

import re

from gripperd.errors import BadReply, InputError
from gripperd.units import MILLI

HIGHEST = 99.999e-3
"""Largest current that seven characters can say, either way. [A]"""

CURRENT = re.compile(r"[+-][0-9]{2}\.[0-9]{3}")


def engineering(current: float) -> str:
    """Write a current. [A].

    >>> engineering(0.0107)
    '+10.700'

    Raises
    ------
    InputError
        More than two digits of mA.
    """
    if not -HIGHEST <= current <= HIGHEST:
        message = f"{current / MILLI:g} mA cannot be written in two digits: 99.999 can"
        raise InputError(message, key="current_mA")
    # Adding zero takes the sign off a negative zero.
    return f"{round(current / MILLI, 3) + 0.0:+07.3f}"


def from_engineering(text: str) -> float:
    """Read a current. [A].

    >>> from_engineering("+10.700")
    0.0107

    Raises
    ------
    BadReply
        It is none in that format.
    """
    if CURRENT.fullmatch(text) is None:
        message = f"{text!r} is not a current in engineering format, such as '+10.700'"
        raise BadReply(message)
    return float(text) * MILLI
