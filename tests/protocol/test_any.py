from hypothesis import given
from hypothesis import strategies as st

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol import itv
from gripperd.protocol.dcon import Ask, Command, Dcon
from gripperd.protocol.itv import Itv
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request
from gripperd.protocol.rtu import ModbusRtu, crc

from .strategies import asks, found, itv_requests, requests

TCP = ModbusTcp()
RTU = ModbusRtu()
ITV = Itv()
LINES = st.sampled_from([TCP, RTU])
DCON = st.builds(Dcon, checksum=st.booleans())


@given(LINES, requests, st.integers(1, 0xFFFF))
def test_a_request_arrives_as_it_was_meant(
    line: ModbusTcp | ModbusRtu, request: Request, sequence: int
) -> None:
    frame = line.encode(request, sequence)
    assert line.request_length(frame) == len(frame)
    assert line.decode_request(frame) == request


@given(LINES, requests, st.integers(1, 0xFFFF), st.data())
def test_a_reply_arrives_as_it_was_meant(
    line: ModbusTcp | ModbusRtu, request: Request, sequence: int, draw: st.DataObject
) -> None:
    values = draw.draw(found(request))
    frame = line.encode_reply(line.encode(request, sequence), request, values)
    assert line.frame_length(request, frame) == len(frame)
    assert line.decode(request, sequence, frame) == values


@given(requests, st.data())
def test_a_reply_behind_its_echo_arrives_as_it_was_meant(
    request: Request, draw: st.DataObject
) -> None:
    values = draw.draw(found(request))
    asked = RTU.encode(request, 1)
    stream = asked + RTU.encode_reply(asked, request, values)
    line = ModbusRtu(local_echo=True)
    assert line.frame_length(request, stream) == len(stream)
    assert line.decode(request, 1, stream) == values


@given(DCON, asks, st.text(st.characters(min_codepoint=0x20, max_codepoint=0x7E)))
def test_lines_of_dcon_arrive_as_they_were_meant(
    line: Dcon, ask: Ask, text: str
) -> None:
    asked = line.encode(ask, 1)
    assert line.decode_request(asked) == Command(ask.unit, ask.text, ask.lead)
    answered = line.encode_reply(ask, ask.good, text)
    try:
        assert line.decode(ask, 1, answered) == text
        assert ask.payload in {None, len(text)}
    except BadReply:
        assert ask.payload not in {None, len(text)}
    except DeviceRefused:
        raise AssertionError from None


@given(itv_requests, st.integers(0, 1023))
def test_lines_of_an_itv_arrive_as_they_were_meant(
    request: itv.Request, count: int
) -> None:
    count = request.count if isinstance(request, itv.Set) else count
    assert ITV.decode_request(ITV.encode(request, 1)) == request
    assert ITV.decode(request, 1, ITV.encode_reply(count)) == count


# Mostly plausible octets: pure noise never comes past the function code.
plausible = st.one_of(
    st.sampled_from([0, 1, 2, 3, 4, 5, 6, 16, 0x83]), st.integers(0, 255)
)
bodies = st.lists(plausible, min_size=2, max_size=40).map(bytes)
tcp_frames = bodies.map(lambda body: b"\0\1\0\0" + len(body).to_bytes(2) + body)
rtu_frames = bodies.map(lambda body: body + crc(body).to_bytes(2, "little"))
line_octets = st.one_of(
    st.binary(max_size=40), st.from_regex(rb"[#$~%!?>0-9A-F+.* ]{0,20}\r?\n?")
)


@given(requests, tcp_frames)
def test_no_frame_of_modbus_tcp_breaks_the_reading(
    request: Request, frame: bytes
) -> None:
    try:
        values = TCP.decode(request, 1, frame)
    except (BadReply, DeviceRefused):
        return
    if isinstance(request, Read) and request.table.of_bits:
        return
    # What is believed is, octet for octet, the one frame that says so.
    assert frame == TCP.encode_reply(frame, request, values)


@given(requests, st.one_of(rtu_frames, st.binary(max_size=40)))
def test_no_frame_of_modbus_rtu_breaks_the_reading(
    request: Request, frame: bytes
) -> None:
    try:
        values = RTU.decode(request, 1, frame)
    except (BadReply, DeviceRefused):
        return
    if isinstance(request, Read) and request.table.of_bits:
        return
    assert frame == RTU.encode_reply(frame, request, values)


@given(st.one_of(tcp_frames, st.binary(max_size=300)))
def test_no_stream_of_modbus_tcp_breaks_a_server(stream: bytes) -> None:
    try:
        length = TCP.request_length(stream)
    except BadReply:
        return
    if length is None:
        return
    assert 8 <= length <= min(260, len(stream))
    request = TCP.decode_request(stream[:length])
    if isinstance(request, Refusal):
        assert len(TCP.encode_refusal(stream[:length], request)) == 9


@given(st.one_of(rtu_frames, st.binary(max_size=300)))
def test_no_stream_of_modbus_rtu_breaks_a_server(stream: bytes) -> None:
    try:
        length = RTU.request_length(stream)
    except BadReply:
        return
    if length is None:
        return
    assert 4 <= length <= min(256, len(stream))
    request = RTU.decode_request(stream[:length])
    if isinstance(request, Refusal):
        assert len(RTU.encode_refusal(stream[:length], request)) == 5


@given(DCON, asks, line_octets)
def test_no_line_of_dcon_breaks_either_half(
    line: Dcon, ask: Ask, octets: bytes
) -> None:
    command = line.decode_request(octets)
    if command is not None:
        assert line.encode(command, 1) == octets
    try:
        line.frame_length(ask, octets)
        text = line.decode(ask, 1, octets)
    except (BadReply, DeviceRefused):
        return
    assert octets == line.encode_reply(ask, ask.good, text)


@given(itv_requests, line_octets)
def test_no_line_of_an_itv_breaks_either_half(
    request: itv.Request, octets: bytes
) -> None:
    ITV.decode_request(octets)
    try:
        ITV.frame_length(request, octets)
        count = ITV.decode(request, 1, octets)
    except (BadReply, DeviceRefused):
        return
    assert int(octets) == count
