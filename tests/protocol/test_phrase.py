import pytest

from gripperd.errors import BadReply
from gripperd.protocol.dcon import Dcon
from gripperd.protocol.phrase import Phrase

DCON = Dcon()
VALUE = {"channel": "0", "value": "+10.700"}


@pytest.mark.parametrize(
    ("phrase", "octets", "reply"),
    [
        (Phrase("#{unit}{channel}{value}", ">"), b"#010+10.700\r", b">\r"),
        (
            Phrase("#{unit}C{channel}{value}", "!{unit}C{channel}{value}"),
            b"#01C0+10.700\r",
            b"!01C0+10.700\r",
        ),
        (Phrase("~{unit}1", "!{unit}"), b"~011\r", b"!01\r"),
    ],
)
def test_a_template_becomes_a_line_that_its_reply_grants(
    phrase: Phrase, octets: bytes, reply: bytes
) -> None:
    question = phrase.question(1, VALUE)
    assert DCON.encode(question, 1) == octets
    phrase.value(DCON.decode(question, 1, reply), VALUE)


def test_a_unit_is_two_hexadecimal_digits() -> None:
    question = Phrase("${unit}6{channel}", "!{unit}{value}").question(0x1F, VALUE, 7)
    assert DCON.encode(question, 1) == b"$1F60\r"


def test_a_reply_of_another_length_is_not_believed() -> None:
    question = Phrase("${unit}6{channel}", "!{unit}{value}").question(
        1, {"channel": "0"}, 7
    )
    assert DCON.decode(question, 1, b"!01+10.700\r") == "+10.700"
    with pytest.raises(BadReply):
        DCON.decode(question, 1, b"!01+10.70\r")


def test_what_has_no_answer_is_a_broadcast() -> None:
    assert DCON.encode(Phrase("~**").question(1, {}), 1) == b"~**\r"


@pytest.mark.parametrize("answer", ["114", "", "0140", "214"])
def test_a_part_that_is_filled_in_must_come_back(answer: str) -> None:
    phrase = Phrase("~{unit}2", "!{unit}1{time}")
    assert phrase.value("120", {"time": "20"}) == ""
    with pytest.raises(BadReply):
        phrase.value(answer, {"time": "20"})


def test_a_value_between_two_parts_is_cut_out() -> None:
    phrase = Phrase("${unit}9{channel}", "!{unit}C{value}E")
    assert phrase.value("C31E", {}) == "31"
    with pytest.raises(BadReply):
        phrase.value("C31", {})
