"""Lines of text, octet by octet as the manuals print them."""

from collections.abc import Iterable

import pytest

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.text_speaker import DconSpeaker, ItvSpeaker
from gripperd.errors import InputError

from .line import DESCRIBED, fitted


def exchange(rig: Rig, name: str, lines: Iterable[tuple[bytes, bytes]]) -> None:
    speaker = DconSpeaker(Modules(rig, *fitted(name)))
    for asked, answered in lines:
        assert speaker.answer(asked) == answered, asked


def test_an_i_7024_is_set_and_read_back(rig: Rig) -> None:
    exchange(
        rig,
        "icpdas_i_7024",
        [
            (b"#010+10.700\r", b">\r"),
            (b"$0160\r", b"!01+10.700\r"),
            (b"$0180\r", b"!01+10.700\r"),
            (b"#013+20.000\r", b">\r"),
            (b"$0163\r", b"!01+20.000\r"),
        ],
    )
    assert rig.plant.current == pytest.approx(0.0107)


def test_over_the_range_it_says_so_and_goes_to_the_end(rig: Rig) -> None:
    lines = [(b"#010+21.000\r", b"?\r"), (b"$0160\r", b"!01+20.000\r")]
    exchange(rig, "icpdas_i_7024", lines)
    assert rig.plant.current == pytest.approx(0.020)


def test_a_brainboxes_goes_to_the_end_of_its_range_without_a_word(rig: Rig) -> None:
    lines = [(b"#010+21.000\r", b">\r"), (b"$0160\r", b"!01+20.000\r")]
    exchange(rig, "brainboxes_ed_560", lines)
    assert rig.plant.current == pytest.approx(0.020)


# As the manuals print them: 9600 Bd and 4-20 mA.
@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("icpdas_i_7024", [(b"$012\r", b"!01310600\r"), (b"$01M\r", b"!017024\r")]),
        (
            "brainboxes_ed_560",
            [(b"$0193\r", b"!013100\r"), (b"$01M0\r", b"!01ED-560\r")],
        ),
        (
            "adam_4017_plus",
            [(b"$018C5\r", b"!01C5R07\r"), (b"$01M\r", b"!014017P\r")],
        ),
        ("adam_4024", [(b"$01M\r", b"!014024\r")]),
    ],
)
def test_a_module_tells_its_range_and_its_name(
    rig: Rig, name: str, lines: list[tuple[bytes, bytes]]
) -> None:
    exchange(rig, name, lines)


@pytest.mark.parametrize(
    "line", [b"#010+1.7\r", b"#014+10.700\r", b"$01Z\r", b"$01\r", b"~0131ZZ\r"]
)
def test_what_it_does_not_understand_is_invalid(rig: Rig, line: bytes) -> None:
    exchange(rig, "icpdas_i_7024", [(line, b"?01\r")])
    assert rig.plant.current == pytest.approx(0.004)


@pytest.mark.parametrize("line", [b"#020+10.700\r", b"hello\r", b"#0\r", b"\xff\r"])
def test_a_line_that_is_damaged_or_for_another_has_no_reply(
    rig: Rig, line: bytes
) -> None:
    exchange(rig, "icpdas_i_7024", [(line, b"")])


def test_a_checksum_is_wanted_and_given(rig: Rig) -> None:
    speaker = DconSpeaker(Modules(rig, *fitted("icpdas_i_7024")), checksum=True)
    # 0x24 + 0x30 + 0x31 + 0x36 + 0x30 = 0xEB; the reply sums to 0x1CF.
    assert speaker.answer(b"$0160EB\r") == b"!01+04.000CF\r"
    assert speaker.answer(b"$0160EC\r") == b""
    assert speaker.answer(b"$0160\r") == b""


def test_an_adam_4024_repeats_what_it_was_told(rig: Rig) -> None:
    exchange(
        rig,
        "adam_4024",
        [
            (b"#01C0+10.700\r", b"!01C0+10.700\r"),
            (b"$016C0\r", b"!01+10.700\r"),
            (b"$01X1\r", b"!010000\r"),
            (b"$01X00050\r", b"!01\r"),
            (b"$01X1\r", b"!010050\r"),
            # The clearing of DCON is not of ADAM ASCII.
            (b"~011\r", b"?01\r"),
        ],
    )
    assert rig.plant.current == pytest.approx(0.0107)


def test_an_adam_4017_gives_eight_channels_in_one_line(rig: Rig) -> None:
    speaker = DconSpeaker(Modules(rig, *fitted("adam_4017_plus")))
    reply = speaker.answer(b"#01\r").decode()
    assert (reply[0], reply[-1], len(reply)) == (">", "\r", 58)
    values = [float(reply[1 + 7 * n : 8 + 7 * n]) for n in range(8)]
    # Both contacts are closed; nothing is on the rest.
    assert values == pytest.approx([4, 17.6, 4, 20, 20, 0, 0, 0], abs=0.04)


def test_the_host_watchdog_trips_latches_and_is_cleared(rig: Rig) -> None:
    modules = Modules(rig, *fitted("icpdas_i_7024"))
    speaker = DconSpeaker(modules)

    def say(*lines: tuple[bytes, bytes]) -> None:
        for asked, answered in lines:
            assert speaker.answer(asked) == answered, asked

    say(
        (b"#010+10.700\r", b">\r"),
        (b"~0150\r", b"!01\r"),
        (b"~0140\r", b"!01+10.700\r"),
        (b"#010+20.000\r", b">\r"),
        (b"~012\r", b"!01000\r"),
        (b"~013105\r", b"!01\r"),
        (b"~012\r", b"!01105\r"),
        (b"~010\r", b"!0100\r"),
    )
    # Only the sign of the host counts, not the requests of others.
    modules.advance(0.4)
    say((b"~**\r", b""))
    modules.advance(0.8)
    say((b"~010\r", b"!0100\r"), (b"$0160\r", b"!01+20.000\r"))
    modules.advance(1.0)
    say(
        (b"#010+20.000\r", b"!\r"),
        (b"~010\r", b"!0104\r"),
        (b"$0160\r", b"!01+10.700\r"),
    )
    assert rig.plant.current == pytest.approx(0.0107)
    modules.power_cycle(1)
    say((b"#010+20.000\r", b"!\r"), (b"~011\r", b"!01\r"), (b"~010\r", b"!0100\r"))
    say((b"#010+20.000\r", b">\r"))
    assert rig.plant.current == pytest.approx(0.020)


def test_a_disarmed_watchdog_does_not_trip(rig: Rig) -> None:
    modules = Modules(rig, *fitted("icpdas_i_7024"))
    speaker = DconSpeaker(modules)
    assert speaker.answer(b"~013105\r") == b"!01\r"
    assert speaker.answer(b"~013005\r") == b"!01\r"
    modules.advance(10.0)
    assert speaker.answer(b"~010\r") == b"!0100\r"


def test_the_power_on_value_is_the_one_that_was_stored(rig: Rig) -> None:
    modules = Modules(rig, *fitted("icpdas_i_7024"))
    speaker = DconSpeaker(modules)
    for line in (b"#010+12.000\r", b"$0140\r", b"#010+20.000\r"):
        speaker.answer(line)
    modules.power_cycle(1)
    assert speaker.answer(b"$0160\r") == b"!01+12.000\r"


def test_modules_of_one_line_answer_by_their_units(rig: Rig) -> None:
    names = ("icpdas_i_7024", "adam_4017_plus", "adam_4024")
    speaker = DconSpeaker(Modules(rig, *fitted(*names)))
    assert speaker.answer(b"#010+10.700\r") == b">\r"
    assert speaker.answer(b"#02\r").startswith(b">+04.0")
    assert speaker.answer(b"#03C0+10.700\r") == b"!03C0+10.700\r"


def test_two_modules_of_a_line_of_text_cannot_share_a_unit(rig: Rig) -> None:
    both = [(DESCRIBED["icpdas_i_7024"], 1), (DESCRIBED["adam_4017_plus"], 1)]
    with pytest.raises(InputError, match="both unit 1"):
        DconSpeaker(Modules(rig, *both))


def test_a_regulator_is_set_and_measures(rig: Rig) -> None:
    modules = Modules(rig, *fitted("smc_itv_rc"))
    speaker = ItvSpeaker(modules)
    for asked, answered in (
        (b"MON\r\n", b"0\r\n"),
        (b"SET 428\r\n", b"428\r\n"),
        (b"REQ\r\n", b"428\r\n"),
        (b"SET 1024\r\n", b"OUT OF RANGE\r\n"),
        (b"VER\r\n", b"UNKNOWN COMMAND\r\n"),
    ):
        assert speaker.answer(asked) == answered
    modules.advance(2.0)
    assert speaker.answer(b"MON\r\n") == b"428\r\n"
    # 428 of 1023 counts of 500 kPa.
    assert rig.plant.pressure == pytest.approx(500e3 * 428 / 1023, rel=1e-3)


def test_a_regulator_is_alone_on_its_line(rig: Rig) -> None:
    with pytest.raises(InputError, match="one regulator alone"):
        ItvSpeaker(Modules(rig, *fitted("smc_itv_rc", "smc_itv_rc")))
