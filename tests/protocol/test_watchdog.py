import pytest

from gripperd.protocol.modbus import Table, Write, WriteCoil
from gripperd.protocol.phrase import Phrase
from gripperd.protocol.watchdog import PhraseWatchdog, Setting


@pytest.mark.parametrize(
    ("digits", "radix", "timeout", "text"),
    [(2, 16, 25.5, "FF"), (2, 16, 0.1, "01"), (4, 10, 2.0, "0020")],
)
def test_a_time_out_is_written_in_the_digits_of_its_module(
    digits: int, radix: int, timeout: float, text: str
) -> None:
    watchdog = PhraseWatchdog(
        step=0.1,
        longest=25.5,
        acts="",
        arm=Phrase("~{unit}31{time}", "!{unit}"),
        digits=digits,
        radix=radix,
    )
    assert watchdog.time_text(timeout) == text


def test_a_setting_is_written_to_its_table() -> None:
    assert Setting(Table.HOLDING, 0x1003, 5).write(2) == Write(2, 0x1003, (5,))
    assert Setting(Table.COILS, 260, 1).write(2) == WriteCoil(2, 260, on=True)
    assert Setting(Table.COILS, 260, 0).write(2) == WriteCoil(2, 260, on=False)
