import pytest

from gripperd.doctor.attempt import Attempt, Protocol, SerialSearch
from gripperd.drivers.address import TcpAddress


def test_the_factory_setting_is_tried_first_and_every_way_once() -> None:
    search = SerialSearch(port="/dev/ttyS9", units=(1,), timeout=0.1)
    said = [str(attempt) for attempt in search.attempts]
    assert said[:4] == [
        "Modbus RTU at 9600 Bd, parity N",
        "DCON at 9600 Bd",
        "Modbus RTU at 9600 Bd, parity E",
        "ITV at 9600 Bd",
    ]
    # Four speeds, RTU with two parities and DCON with one; ITV has one speed.
    assert len(said) == len(set(said)) == 4 * 3 + 1


def test_what_is_known_is_not_searched() -> None:
    search = SerialSearch(
        port="/dev/ttyS9",
        units=(1,),
        timeout=0.1,
        bauds=(115_200,),
        parities=("E",),
        protocols=(Protocol.RTU,),
    )
    assert list(map(str, search.attempts)) == ["Modbus RTU at 115200 Bd, parity E"]


def test_the_longest_time_counts_every_silence() -> None:
    (serial,) = SerialSearch(
        port="/dev/ttyS9",
        units=(1, 2, 3),
        timeout=0.1,
        bauds=(19_200,),
        parities=("N",),
        protocols=(Protocol.DCON,),
    ).attempts
    # Silence before the first, then time-out and silence for each of three.
    assert serial.longest == pytest.approx(0.7)
    tcp = Attempt(TcpAddress(host="h", port=502, timeout=0.5), (1, 2))
    assert tcp.longest == pytest.approx(1.4)
