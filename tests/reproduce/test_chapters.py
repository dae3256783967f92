"""Tables of the page against the published values."""

import pytest

from gripperd.model import Chain
from gripperd.reproduce.chapters import Table, chapters
from gripperd.reproduce.paper import Paper


@pytest.fixture(scope="module")
def tables(chain: Chain) -> dict[str, Table]:
    return {
        table.caption: table
        for chapter in chapters(Paper(chain.muscle))
        for table in chapter.tables
    }


@pytest.mark.parametrize(
    ("caption", "row"),
    [
        ("Geometry", ("0.20", "43.53", "32.59")),
        ("Geometry", ("0.00", "25.00", "20.00")),
        (
            "Ideal force [N] at a gauge pressure",
            ("0.00", "257.5", "515.1", "772.6", "1030.2", "1287.7"),
        ),
        ("Rubber at 0.4 MPa gauge", ("0.05", "124.5", "736.7", "14")),
        ("Rubber at 0.4 MPa gauge", ("0.25", "250.0", "21.7", "92")),
        ("Friction [N]", ("0.10", "0.00", "12.77", "2.27", "15.82")),
        ("Friction [N]", ("0.20", "0.00", "12.27", "1.80", "16.13")),
    ],
)
def test_a_row_is_the_published_one(
    tables: dict[str, Table], caption: str, row: tuple[str, ...]
) -> None:
    assert row in tables[caption].rows


def test_every_row_fills_every_column(tables: dict[str, Table]) -> None:
    for table in tables.values():
        assert {len(row) for row in table.rows} == {len(table.columns)}


def test_the_constants_are_those_of_the_paper(tables: dict[str, Table]) -> None:
    values = [row[-1] for row in tables["Constants of the muscle"].rows]
    assert values == ["250 mm", "20 mm", "25°", "2 mm", "1.3 MPa", "0.002"]


def test_the_four_modules_stand_in_the_papers_order(chain: Chain) -> None:
    titles = [chapter.title for chapter in chapters(Paper(chain.muscle))]
    assert titles == [
        "Parameters",
        "Ideal force",
        "Elastic force of the rubber",
        "Friction",
    ]
