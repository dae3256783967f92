from hypothesis import given
from hypothesis import strategies as st

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol.modbus import (
    HEADER,
    Read,
    Refusal,
    Request,
    Table,
    Write,
    decode_reply,
    decode_request,
    encode_refusal,
    encode_reply,
    encode_request,
    frame_length,
)

registers = st.integers(0, 0xFFFF)
units = st.integers(0, 255)
requests = st.one_of(
    st.builds(Read, units, st.sampled_from(Table), registers, st.integers(1, 125)),
    st.builds(
        Write,
        units,
        registers,
        st.lists(registers, min_size=1, max_size=123).map(tuple),
    ),
)


@given(requests, st.integers(1, 0xFFFF))
def test_a_request_arrives_as_it_was_meant(request: Request, transaction: int) -> None:
    frame = encode_request(request, transaction)
    assert frame_length(frame) == len(frame)
    assert decode_request(frame) == request


@given(requests, st.integers(1, 0xFFFF), st.data())
def test_a_reply_arrives_as_it_was_meant(
    request: Request, transaction: int, draw: st.DataObject
) -> None:
    values: tuple[int, ...]
    if isinstance(request, Read):
        count = request.count
        lists = st.lists(registers, min_size=count, max_size=count)
        values = tuple(draw.draw(lists))
    else:
        values = request.values
    frame = encode_reply(request, transaction, values)
    assert frame_length(frame) == len(frame)
    assert decode_reply(request, transaction, frame) == values


# Mostly plausible octets: pure noise never comes past the function code.
plausible = st.one_of(
    st.sampled_from([0, 1, 2, 3, 4, 6, 16, 0x83]), st.integers(0, 255)
)
bodies = st.lists(plausible, min_size=2, max_size=40).map(bytes)
frames = bodies.map(lambda body: b"\0\1\0\0" + len(body).to_bytes(2) + body)


@given(st.binary(max_size=300))
def test_no_stream_of_octets_breaks_the_measuring(stream: bytes) -> None:
    try:
        length = frame_length(stream)
    except BadReply:
        return
    assert length is None or HEADER < length <= 260


@given(requests, frames)
def test_no_frame_breaks_the_reading_of_replies(request: Request, frame: bytes) -> None:
    try:
        values = decode_reply(request, 1, frame)
    except (BadReply, DeviceRefused):
        return
    # What is believed is, octet for octet, the one frame that says so.
    assert frame == encode_reply(request, 1, values)


@given(frames)
def test_no_frame_breaks_the_reading_of_requests(frame: bytes) -> None:
    request = decode_request(frame)
    if isinstance(request, Refusal):
        assert frame_length(encode_refusal(frame, request)) == 9
