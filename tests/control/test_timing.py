import random

import pytest

from gripperd.control.timing import Histogram


def test_quantiles_are_those_of_the_values_to_a_class() -> None:
    rng = random.Random(3)
    values = [rng.lognormvariate(-8, 1.5) for _ in range(5000)]
    histogram = Histogram()
    for value in values:
        histogram.add(value)
    found = histogram.read()
    values.sort()
    for share in (0.5, 0.9, 0.99, 0.999):
        exact = values[int(share * len(values)) - 1]
        told = found.quantile(share)
        assert told is not None
        assert exact <= told <= exact * 1.2
    assert found.quantile(1.0) == found.largest == values[-1]
    assert found.total == pytest.approx(sum(values))
    assert found.count == 5000


def test_nothing_has_no_quantile() -> None:
    assert Histogram().read().quantile(0.5) is None


def test_what_is_longer_than_all_classes_is_counted_too() -> None:
    histogram = Histogram()
    histogram.add(0.0)
    histogram.add(3600.0)
    found = histogram.read()
    assert found.count == 2
    assert found.quantile(1.0) == 3600.0


def test_since_an_earlier_one_only_the_new_ones_count() -> None:
    histogram = Histogram()
    histogram.add(2.0)
    before = histogram.read()
    for _ in range(10):
        histogram.add(1e-3)
    later = histogram.read().since(before)
    assert later.count == 10
    assert later.total == pytest.approx(0.01)
    assert later.largest == pytest.approx(1e-3, rel=0.2)
    assert later.quantile(1.0) == later.largest
