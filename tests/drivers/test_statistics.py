from gripperd.drivers.statistics import LATENCY_BOUNDS, BusStatistics, Histogram


def test_each_latency_is_counted_under_the_first_bound_that_holds_it() -> None:
    found = Histogram()
    for duration in (0.0, 0.5e-3, 0.6e-3, 2.0, 2.1):
        found.add(duration)
    assert LATENCY_BOUNDS[:2] == (0.5e-3, 1e-3)
    assert LATENCY_BOUNDS[-1] == 2.0
    assert found.counts == [2, 1, *[0] * 9, 1, 1]
    assert found.total == 0.0 + 0.5e-3 + 0.6e-3 + 2.0 + 2.1


def test_bounds_rise() -> None:
    assert list(LATENCY_BOUNDS) == sorted(set(LATENCY_BOUNDS))


def test_a_snapshot_stays_as_it_was() -> None:
    statistics = BusStatistics()
    statistics.errors["BadReply"] += 1
    before = statistics.snapshot()
    statistics.requests += 1
    statistics.errors["BadReply"] += 1
    statistics.latency.add(1.0)
    assert before.requests == 0
    assert before.errors == {"BadReply": 1}
    assert sum(before.latency_counts) == 0
