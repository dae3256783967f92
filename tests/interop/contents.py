"""What every foreign device holds when it starts.

Registers hold numbers of their own: a wrong address, table or byte order shows.
"""

BITS = 2000
"""Coils, and discrete inputs. [-]"""
REGISTERS = 5000
"""Holding registers, and input registers. [-]"""


def coil(address: int) -> int:
    return int(address % 3 == 0)


def discrete(address: int) -> int:
    return int(address % 5 == 0)


def holding(address: int) -> int:
    return 1000 + address


def input_(address: int) -> int:
    """As a current in µA, a live one: 8.000 mA on the first channel."""
    return 8000 + address
