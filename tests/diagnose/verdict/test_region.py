import pytest

from gripperd.diagnose.verdict.region import region_document, span, way


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("time", "820 to 880"),
        ("pressure", "0 to 434"),
        ("contraction", "0.105"),
        ("temperature", "-"),
    ],
)
def test_a_region_is_told_in_the_units_of_the_file(name: str, said: str) -> None:
    region = {
        "time": (819.8, 880.3),
        "pressure": (-120.0, 433.6e3),
        "contraction": (0.1051, 0.1052),
    }
    assert span(region, name) == said


def test_a_program_reads_the_time_of_the_file_however_long_ago_it_began() -> None:
    """Seconds since 1970, and six digits of a pressure."""
    found = region_document(
        {"time": (1.7e9 + 12.3456, 1.7e9 + 56.7), "pressure": (100e3, 123456.789)}
    )
    assert found == {
        "t_s": [1700000012.346, 1700000056.7],
        "pressure_kPa": [100.0, 123.457],
    }


@pytest.mark.parametrize(
    ("region", "said"),
    [
        ({"direction": (1.0, 1.0)}, "contracting"),
        ({"direction": (-1.0, 1.0)}, ""),
        ({"direction": (-1.0, 0.0), "pressure_direction": (-1.0, 1.0)}, "extending"),
        ({"direction": (0.0, 0.0), "pressure_direction": (-1.0, -1.0)}, "falling"),
        ({"direction": (0.0, 0.0)}, ""),
    ],
)
def test_a_region_says_which_way_alone_it_went(
    region: dict[str, tuple[float, float]], said: str
) -> None:
    assert way(region) == said
