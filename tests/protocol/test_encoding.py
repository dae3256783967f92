import struct
from math import isnan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.protocol.encoding import Encoding, Range, ValueType, WordOrder

WORDS = st.integers(0, 0xFFFF)


@given(WORDS)
def test_a_signed_word_is_a_twos_complement(word: int) -> None:
    (wanted,) = struct.unpack(">h", word.to_bytes(2, "big"))
    encoding = Encoding(type=ValueType.S16)
    assert encoding.decode((word,)) == wanted
    assert encoding.encode(wanted) == (word,)


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_a_float_is_two_words_in_either_order(value: float) -> None:
    octets = struct.pack(">f", value)
    high, low = octets[:2], octets[2:]
    words = (int.from_bytes(high, "big"), int.from_bytes(low, "big"))
    for order, wanted in (
        (WordOrder.HIGH_FIRST, words),
        (WordOrder.LOW_FIRST, words[::-1]),
    ):
        encoding = Encoding(type=ValueType.F32, word_order=order)
        assert encoding.encode(value) == wanted
        assert encoding.decode(wanted) == value


def test_no_number_stays_no_number() -> None:
    assert isnan(Encoding(type=ValueType.F32).decode((0x7FC0, 0)))


@given(WORDS)
def test_bits_below_the_resolution_are_no_value(word: int) -> None:
    encoding = Encoding(resolution=8)
    assert encoding.decode((word,)) == word & 0xFFF8


@given(st.integers(0, 4095))
def test_what_is_written_is_read_back(count: int) -> None:
    encoding = Encoding()
    assert encoding.decode(encoding.encode(count)) == count


def test_a_range_is_a_straight_line_through_both_ends() -> None:
    line = Range(
        name="4-20mA",
        current_low=0.004,
        current_high=0.020,
        count_low=0.0,
        count_high=4095.0,
    )
    assert [line.count(current) for current in (0.004, 0.012, 0.020)] == [
        0.0,
        pytest.approx(2047.5),
        4095.0,
    ]
    assert line.current(4095.0) == pytest.approx(0.020)
    # An input may read on beyond its ends.
    assert line.current(-1023.75) == pytest.approx(0.0)
