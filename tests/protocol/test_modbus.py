import pytest

from gripperd.errors import InputError
from gripperd.protocol.modbus import Read, Table, Write, WriteCoil


@pytest.mark.parametrize(
    ("request_", "function"),
    [
        # MODBUS Application Protocol V1.1b3, sections 6.1 to 6.6 and 6.12.
        (Read(1, Table.COILS, 0), 1),
        (Read(1, Table.DISCRETE, 0), 2),
        (Read(1, Table.HOLDING, 0), 3),
        (Read(1, Table.INPUT, 0), 4),
        (WriteCoil(1, 0, on=True), 5),
        (Write(1, 0, (1,)), 6),
        (Write(1, 0, (1,), multiple=True), 16),
        (Write(1, 0, (1, 2)), 16),
    ],
)
def test_function_codes_are_those_of_the_specification(
    request_: Read | Write | WriteCoil, function: int
) -> None:
    assert request_.function == function


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (Read(2, Table.INPUT, 0, 8), "read 8 input register(s) at 0 of unit 2"),
        (Read(2, Table.COILS, 269), "read 1 coils at 269 of unit 2"),
        (Write(1, 3, (4, 5)), "write 4, 5 to holding register 3 of unit 1"),
        (WriteCoil(1, 260, on=True), "set coil 260 of unit 1"),
        (WriteCoil(1, 260, on=False), "clear coil 260 of unit 1"),
    ],
)
def test_a_request_reads_as_a_person_would_say_it(
    request_: Read | Write | WriteCoil, words: str
) -> None:
    assert str(request_) == words


@pytest.mark.parametrize("unit", [-1, 256])
def test_a_unit_that_no_octet_holds_is_refused(unit: int) -> None:
    with pytest.raises(InputError, match=f"unit {unit} is no Modbus unit: 0 to 255"):
        Read(unit, Table.HOLDING, 0)
    with pytest.raises(InputError, match="no Modbus unit"):
        Write(unit, 0, (0,))
    with pytest.raises(InputError, match="no Modbus unit"):
        WriteCoil(unit, 0, on=True)


@pytest.mark.parametrize("address", [-1, 65_536])
def test_an_address_that_no_word_holds_is_refused(address: int) -> None:
    with pytest.raises(InputError, match="0 to 65535") as refused:
        Read(1, Table.HOLDING, address)
    assert refused.value.key == "address"


@pytest.mark.parametrize(
    ("table", "most"),
    [
        (Table.COILS, 2000),
        (Table.DISCRETE, 2000),
        (Table.HOLDING, 125),
        (Table.INPUT, 125),
    ],
)
def test_no_more_is_read_than_a_frame_holds(table: Table, most: int) -> None:
    assert Read(1, table, 0, most).count == most
    for count in (0, most + 1):
        with pytest.raises(InputError, match=f"1 to {most} can"):
            Read(1, table, 0, count)


@pytest.mark.parametrize("count", [0, 124])
def test_no_more_is_written_than_a_frame_holds(count: int) -> None:
    assert len(Write(1, 0, (0,) * 123).values) == 123
    with pytest.raises(InputError, match="1 to 123 can"):
        Write(1, 0, (0,) * count)


@pytest.mark.parametrize("value", [-1, 65_536])
def test_a_value_that_no_register_holds_is_refused_not_wrapped(value: int) -> None:
    with pytest.raises(InputError, match=f"{value} does not fit in a register"):
        Write(1, 0, (0, value))
