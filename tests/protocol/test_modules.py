from math import inf, nan

import pytest

from gripperd.errors import InputError
from gripperd.protocol.modules import INPUTS, OUTPUTS

OUTPUT = OUTPUTS["waveshare_ao_8ch"]
INPUT = INPUTS["waveshare_ai_8ch"]


@pytest.mark.parametrize(
    ("current", "count"),
    [(0.0, 0), (0.004, 4000), (0.0107, 0x29CC), (0.020, 20_000), (0.0107004, 10_700)],
)
def test_an_output_counts_microamperes(current: float, count: int) -> None:
    assert OUTPUT.encode(current) == count
    assert OUTPUT.decode(count) == pytest.approx(current, abs=0.5e-6)


@pytest.mark.parametrize("current", [-1e-6, 0.0200001, 10.7, inf, nan])
def test_a_current_the_module_cannot_drive_is_refused_not_clamped(
    current: float,
) -> None:
    with pytest.raises(InputError, match="waveshare_ao_8ch") as refused:
        OUTPUT.encode(current)
    assert refused.value.key == "current_mA"


def test_the_refusal_names_value_and_limit_in_milliamperes() -> None:
    with pytest.raises(InputError, match=r"20\.5 mA is outside 0 to 20 mA"):
        OUTPUT.encode(0.0205)


def test_channels_have_consecutive_registers() -> None:
    assert [OUTPUT.register(channel) for channel in range(8)] == list(range(8))


@pytest.mark.parametrize("count", [0, 3600, 10_700, 20_000, 65_535])
def test_an_input_counts_microamperes(count: int) -> None:
    assert INPUT.decode(count) == pytest.approx(count / 1e6)
    assert INPUT.encode(INPUT.decode(count)) == count


def test_the_shipped_input_is_read_as_0_to_20_milliamperes() -> None:
    # Waveshare's protocol table: range codes from 0x1000 on, 2 is 0-20 mA in µA.
    assert (INPUT.range_address, INPUT.range_code) == (0x1000, 2)
