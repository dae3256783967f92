import numpy as np
import pytest

from gripperd.model import StaticMuscle
from gripperd.model.real import CHUNK, positive_part


@pytest.mark.parametrize("size", [1, CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK + 3])
def test_every_point_of_a_long_array_equals_the_point_alone(
    static: StaticMuscle, size: int
) -> None:
    pressure = np.linspace(0, 8e5, size)
    contraction = np.linspace(-0.03, 0.3, size)
    direction = np.where(np.arange(size) % 2, 1.0, -1.0)
    force = static.force(pressure, contraction, direction)
    back = static.pressure(force, contraction, direction)
    assert isinstance(force, np.ndarray)
    assert isinstance(back, np.ndarray)
    # The seams of the pieces, both ends and a few in between.
    for at in {0, size // 2, size - 1, *(s for s in (8191, 8192, 8193) if s < size)}:
        point = float(pressure[at]), float(contraction[at]), float(direction[at])
        assert force[at] == pytest.approx(static.force(*point), rel=1e-12, abs=1e-9)
    assert back == pytest.approx(pressure, abs=1e-4)


def test_a_long_array_is_the_same_as_its_halves(static: StaticMuscle) -> None:
    pressure = np.linspace(0, 8e5, 3 * CHUNK)
    whole = static.force(pressure, 0.1)
    parts = [static.force(part, 0.1) for part in np.split(pressure, 6)]
    assert np.array_equal(np.asarray(whole), np.concatenate([*map(np.asarray, parts)]))


def test_a_table_of_two_dimensions_keeps_its_shape(static: StaticMuscle) -> None:
    pressure = np.linspace(0, 8e5, 120)[:, None]
    contraction = np.linspace(-0.03, 0.3, 90)[None, :]
    table = static.force(pressure, contraction)
    assert isinstance(table, np.ndarray)
    assert table.shape == (120, 90)
    assert table.size > CHUNK
    for row, column in [(0, 0), (17, 89), (91, 2), (119, 89)]:
        alone = static.force(float(pressure[row, 0]), float(contraction[0, column]))
        assert table[row, column] == pytest.approx(alone, rel=1e-12)


def test_a_table_in_column_order_is_read_in_the_right_order(
    static: StaticMuscle,
) -> None:
    pressure = np.asfortranarray(np.linspace(0, 8e5, 20_000).reshape(100, 200))
    table = np.asarray(static.force(pressure, 0.1))
    assert table[3, 150] == pytest.approx(static.force(float(pressure[3, 150]), 0.1))


def test_an_array_without_dimensions_is_one_value(static: StaticMuscle) -> None:
    force = static.force(np.array(2e5), np.array(0.1))
    assert np.shape(force) == ()
    assert float(force) == pytest.approx(static.force(2e5, 0.1), rel=1e-14)


def test_an_empty_array_gives_an_empty_array(static: StaticMuscle) -> None:
    assert np.shape(static.force(np.empty(0), 0.1)) == (0,)


def test_the_positive_part_is_exact_for_one_value_and_for_many() -> None:
    values = np.array([-1e300, -3.0, -5e-324, -0.0, 0.0, 5e-324, 0.1, 3.0, 1e300])
    expected = np.maximum(values, 0.0)
    assert np.array_equal(np.asarray(positive_part(values)), expected)
    alone = [positive_part(float(value)) for value in values]
    assert alone == expected.tolist()
