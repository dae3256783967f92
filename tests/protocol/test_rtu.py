import pytest

from gripperd.errors import BadReply, DeviceRefused, InputError, LocalEcho
from gripperd.protocol.modbus import Read, Refusal, Table, Write, WriteCoil
from gripperd.protocol.rtu import ModbusRtu, crc, silence

octets = bytes.fromhex
LINE = ModbusRtu()
ECHOING = ModbusRtu(local_echo=True)
WRITE = Write(1, 0, (1000,))
BY_16 = Write(1, 0, (1000,), multiple=True)
READ = Read(1, Table.HOLDING, 0x6B, 3)


def sealed(text: str) -> bytes:
    """A frame with its checksum, worked out bit by bit (V1.02, section 6.2.2)."""
    frame, register = octets(text), 0xFFFF
    for octet in frame:
        register ^= octet
        for _ in range(8):
            carry = register & 1
            register >>= 1
            if carry:
                register ^= 0xA001
    return frame + bytes((register & 0xFF, register >> 8))


def heard(line: ModbusRtu, request: Read | Write, stream: bytes) -> tuple[int, ...]:
    length = line.frame_length(request, stream)
    assert length is not None
    return line.decode(request, 1, stream[:length])


def believed(line: ModbusRtu, request: Read | Write, stream: bytes) -> tuple[int, ...]:
    assert line.frame_length(request, stream) == len(stream)
    return heard(line, request, stream)


def test_1_milliampere_as_waveshare_prints_it() -> None:
    frame = octets("01 06 00 00 03 E8 89 74")
    assert LINE.encode(WRITE, 1) == frame
    assert believed(LINE, WRITE, frame) == (1000,)
    assert LINE.decode_request(frame) == WRITE
    assert LINE.encode_reply(frame, WRITE) == frame


def test_the_check_value_of_the_checksum() -> None:
    # CRC-16/MODBUS of the digits 1 to 9, as catalogues of checksums list it.
    assert crc(b"123456789") == 0x4B37


def test_the_example_of_the_serial_line_guide() -> None:
    # MODBUS over Serial Line V1.02, appendix B: unit 2, function 7.
    frame = octets("02 07 41 12")
    assert sealed("02 07") == frame
    assert crc(frame) == 0
    assert LINE.decode_request(frame) == Refusal.ILLEGAL_FUNCTION


@pytest.mark.parametrize(
    ("baud", "pause"),
    [(9600, 4.0104e-3), (19_200, 2.0052e-3), (38_400, 1.75e-3), (115_200, 1.75e-3)],
)
def test_the_silence_of_the_guide(baud: int, pause: float) -> None:
    assert silence(baud) == pytest.approx(pause, rel=1e-4)


def test_three_registers_are_read() -> None:
    reply = sealed("01 03 06 02 2b 00 00 00 64")
    assert LINE.encode(READ, 1) == sealed("01 03 00 6b 00 03")
    assert believed(LINE, READ, reply) == (0x022B, 0, 0x64)


def test_a_reply_is_complete_with_its_last_octet_and_not_before() -> None:
    reply = sealed("01 03 06 02 2b 00 00 00 64")
    for cut in range(len(reply)):
        assert LINE.frame_length(READ, reply[:cut]) is None
    assert LINE.frame_length(READ, bytearray(reply + b"more")) == len(reply)


@pytest.mark.parametrize(
    ("stream", "why"),
    [
        ("02", "another unit"),
        ("ff 01 03", "another unit"),
        ("01 04", "another function"),
        ("01 06 00 00 03 e8", "another function"),
        ("01 84", "another function"),
        ("01 03 02", "byte count"),
        ("01 03 08", "byte count"),
    ],
)
def test_noise_is_noticed_before_the_line_falls_silent(stream: str, why: str) -> None:
    with pytest.raises(BadReply, match=why):
        LINE.frame_length(READ, octets(stream))


@pytest.mark.parametrize(
    "lie",
    [
        pytest.param(octets("01 06 00 00 03 e8 89 75"), id="checksum"),
        pytest.param(octets("01 06 00 00 03 e8 74 89"), id="checksum turned round"),
        pytest.param(octets("01 06 00 00 03 e9 89 74"), id="garbled value"),
        pytest.param(sealed("01 06 00 00 03 e9"), id="other value"),
        pytest.param(sealed("01 06 00 01 03 e8"), id="other address"),
        pytest.param(sealed("02 06 00 00 03 e8"), id="other unit"),
        pytest.param(sealed("01 10 00 00 00 01"), id="other function"),
        pytest.param(sealed("01 06 00 00 03"), id="short"),
        pytest.param(sealed("01 06 00 00 03 e8 00"), id="long"),
        pytest.param(sealed("02 86 02"), id="exception of another unit"),
        pytest.param(octets("01 86 02 00 00"), id="exception with a bad checksum"),
        pytest.param(sealed("01"), id="unit only"),
        pytest.param(b"\xff\xff", id="checksum only"),
        pytest.param(b"", id="nothing"),
    ],
)
def test_a_lie_is_not_believed(lie: bytes) -> None:
    with pytest.raises(BadReply, match="not believed"):
        LINE.decode(WRITE, 1, lie)


def test_a_trailing_octet_is_not_believed() -> None:
    with pytest.raises(BadReply):
        LINE.decode(WRITE, 1, sealed("01 06 00 00 03 e8") + b"\0")


@pytest.mark.parametrize("code", list(Refusal))
def test_a_refusal_arrives_as_one(code: Refusal) -> None:
    reply = LINE.encode_refusal(LINE.encode(READ, 1), code)
    assert reply == sealed(f"01 83 {code:02x}")
    with pytest.raises(DeviceRefused) as refused:
        believed(LINE, READ, reply)
    assert refused.value.exception_code == code


def test_a_broadcast_is_never_sent() -> None:
    with pytest.raises(InputError, match="every unit of a serial line"):
        LINE.encode(Write(0, 0, (1000,)), 1)


@pytest.mark.parametrize("request_", [READ, BY_16, Read(1, Table.INPUT, 0x1000, 8)])
def test_an_echo_that_nobody_announced_is_named(request_: Read | Write) -> None:
    echo = LINE.encode(request_, 1)
    values = range(request_.count) if isinstance(request_, Read) else ()
    reply = LINE.encode_reply(echo, request_, values)
    with pytest.raises(LocalEcho, match="set 'local_echo: true'"):
        heard(LINE, request_, echo + reply)


def test_half_an_echo_is_waited_for() -> None:
    echo = LINE.encode(READ, 1)
    assert [LINE.frame_length(READ, echo[:cut]) for cut in range(8)] == [None] * 8
    with pytest.raises(LocalEcho):
        LINE.frame_length(READ, echo)


def test_an_echo_of_function_6_is_a_reply_and_of_function_16_is_none() -> None:
    assert believed(LINE, WRITE, LINE.encode(WRITE, 1)) == (1000,)
    assert believed(LINE, BY_16, sealed("01 10 00 00 00 01")) == (1000,)
    with pytest.raises(LocalEcho):
        LINE.decode(BY_16, 1, LINE.encode(BY_16, 1)[:8])


def test_an_announced_echo_is_taken_off() -> None:
    stream = sealed("01 03 00 6b 00 03") + sealed("01 03 06 02 2b 00 00 00 64")
    for cut in range(len(stream)):
        assert ECHOING.frame_length(READ, stream[:cut]) is None
    assert believed(ECHOING, READ, stream) == (0x022B, 0, 0x64)
    twice = octets("01 06 00 00 03 E8 89 74") * 2
    assert ECHOING.frame_length(WRITE, twice[:8]) is None
    assert believed(ECHOING, WRITE, twice) == (1000,)


def test_an_announced_echo_that_does_not_come_is_named() -> None:
    reply = sealed("01 03 06 02 2b 00 00 00 64")
    with pytest.raises(BadReply, match="'local_echo: true' is set"):
        ECHOING.frame_length(READ, reply[:3])
    with pytest.raises(BadReply, match="'local_echo: true' is set"):
        ECHOING.decode(READ, 1, reply)


REQUESTS = [
    READ,
    WRITE,
    BY_16,
    WriteCoil(1, 260, on=True),
    Read(1, Table.COILS, 0, 9),
    Write(1, 0, tuple(range(123))),
]


@pytest.mark.parametrize("request_", REQUESTS)
def test_a_device_finds_the_end_of_every_request(
    request_: Read | Write | WriteCoil,
) -> None:
    frame = LINE.encode(request_, 1)
    for cut in range(len(frame)):
        assert LINE.request_length(frame[:cut]) is None
    assert LINE.request_length(frame + frame) == len(frame)
    assert LINE.decode_request(frame) == request_


def test_a_request_of_an_unknown_function_ends_with_its_checksum() -> None:
    frame = sealed("01 2b 0e 01 00")
    for cut in range(len(frame)):
        assert LINE.request_length(frame[:cut]) is None
    assert LINE.request_length(frame + b"\1\3") == len(frame)
    assert LINE.decode_request(frame) == Refusal.ILLEGAL_FUNCTION


@pytest.mark.parametrize(
    "frame", [b"\1\3\0\0", sealed("01 06 00 00 03 e8")[:-1], sealed("01"), b""]
)
def test_a_device_stays_silent_on_a_damaged_request(frame: bytes) -> None:
    assert LINE.decode_request(frame) is None


@pytest.mark.parametrize(
    "stream", [b"\1\x10\0\0\0\x7f\xff", b"\1\x2b" + bytes(range(255))]
)
def test_what_is_longer_than_any_frame_cannot_be_followed(stream: bytes) -> None:
    with pytest.raises(BadReply, match="not a frame of Modbus RTU"):
        LINE.request_length(stream)
