from pathlib import Path

import pytest

from gripperd.config.bus_section import SerialSection, TcpSection
from gripperd.config.bus_sharing import check_one_way


def tcp(address: str, timeout: float = 200.0) -> TcpSection:
    return TcpSection.model_validate({"tcp": address, "timeout_ms": timeout})


def serial(port: Path, baud: int = 9600) -> SerialSection:
    return SerialSection.model_validate(
        {"serial": str(port), "protocol": "rtu", "baud": baud}
    )


def test_one_line_may_be_named_alike_by_many(tmp_path: Path) -> None:
    port = tmp_path / "ttyUSB0"
    check_one_way({"a": serial(port), "b": serial(port), "c": tcp("plc:502")})


def test_two_settings_of_one_port_name_both_places(tmp_path: Path) -> None:
    port = tmp_path / "ttyUSB0"
    with pytest.raises(ValueError, match="one line") as refused:
        check_one_way({"a": serial(port), "b": serial(port, 19_200)})
    assert "a.bus (" in str(refused.value)
    assert "baud 9600" in str(refused.value)
    assert "b.bus (" in str(refused.value)
    assert "baud 19200" in str(refused.value)


def test_a_port_and_a_link_to_it_are_one_line(tmp_path: Path) -> None:
    port, link = tmp_path / "ttyUSB0", tmp_path / "usb-FTDI"
    port.touch()
    link.symlink_to(port)
    with pytest.raises(ValueError, match="usb-FTDI") as refused:
        check_one_way({"a": serial(port), "b": serial(link)})
    assert f"are one line, {port}:" in str(refused.value)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("PLC.local:502", "plc.local:502"),
        ("localhost:502", "127.0.0.1:502"),
        ("[::1]:502", "[0:0:0:0:0:0:0:1]:502"),
        ("10.0.0.7:502", "10.0.0.7:0502"),
    ],
)
def test_a_host_spelt_otherwise_is_the_same(one: str, other: str) -> None:
    with pytest.raises(ValueError, match="one line"):
        check_one_way({"a": tcp(one), "b": tcp(other, 300.0)})


def test_other_ports_and_hosts_are_other_lines(tmp_path: Path) -> None:
    check_one_way({"a": tcp("plc:502"), "b": tcp("plc:503", 300.0)})
    check_one_way({"a": tcp("plc:502"), "b": tcp("plc2:502", 300.0)})
    one, other = serial(tmp_path / "a"), serial(tmp_path / "b", 19_200)
    check_one_way({"a": one, "b": other})
