"""Grippers on one line: a line has one owner, and is set up in one way."""

import os
from collections.abc import Mapping
from contextlib import suppress
from ipaddress import ip_address
from typing import Literal

from gripperd.config.bus_section import BENCH, BusSection, TcpSection


def check_one_way(buses: Mapping[str, BusSection | Literal["bench"]]) -> None:
    """Refuse a line that two grippers name or set up differently.

    Each way would become an owner of its own, and neither would know when the other
    talks.

    Parameters
    ----------
    buses
        Of each gripper.

    Raises
    ------
    ValueError
        With both places.
    """
    owners: dict[str, tuple[str, BusSection]] = {}
    for name, bus in buses.items():
        if bus == BENCH:
            continue
        line = _line(bus)
        first, other = owners.setdefault(line, (name, bus))
        if other != bus:
            message = (
                f"{_place(first, other)} and {_place(name, bus)} are one line, {line}:"
                " say the same of it in both"
            )
            raise ValueError(message)


def _place(name: str, bus: BusSection) -> str:
    return f"{name}.bus ({bus.address}, {bus.manner})"


def _line(bus: BusSection) -> str:
    """What all spellings of an address lead to, as far as this machine knows."""
    if not isinstance(bus, TcpSection):
        # Path.resolve raises where links lead round in a circle.
        return os.path.realpath(bus.serial)
    host = bus.tcp.host.lower().removesuffix(".")
    with suppress(ValueError):
        host = str(ip_address("127.0.0.1" if host == "localhost" else host))
    return f"[{host}]:{bus.tcp.port}" if ":" in host else f"{host}:{bus.tcp.port}"
