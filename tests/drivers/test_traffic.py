from dataclasses import dataclass

from gripperd.drivers.exchange import Exchange, Trace
from gripperd.drivers.traffic import FORGOTTEN_AFTER, KEPT, Traffic


@dataclass
class Line:
    """A bus, as far as it is listened to."""

    trace: Trace | None = None
    now: float = 0.0

    def listened_to(self) -> bool:
        return self.trace is not None

    def exchange(self) -> None:
        if self.trace is not None:
            asked = Exchange(time=self.now, request=b"?", reply=b"!", error=None)
            self.trace(asked)


def test_nothing_is_listened_to_until_somebody_looks() -> None:
    line = Line()
    traffic = Traffic(line, lambda: line.now)
    line.exchange()
    assert not line.listened_to()
    assert traffic.since(0) == ()
    line.exchange()
    line.exchange()
    assert [heard.number for heard in traffic.since(0)] == [1, 2]
    assert [heard.number for heard in traffic.since(1)] == [2]


def test_it_costs_nothing_again_once_nobody_has_looked_for_a_while() -> None:
    line = Line()
    traffic = Traffic(line, lambda: line.now)
    traffic.since(0)
    line.now = FORGOTTEN_AFTER
    line.exchange()
    assert line.listened_to()
    line.now += 0.1
    line.exchange()
    assert not line.listened_to()
    assert traffic.since(0) == ()


def test_a_watcher_that_is_late_finds_the_newest_and_can_tell_the_gap() -> None:
    line = Line()
    traffic = Traffic(line, lambda: line.now)
    traffic.since(0)
    for _ in range(KEPT + 5):
        line.exchange()
    found = traffic.since(0)
    assert (len(found), found[0].number, found[-1].number) == (KEPT, 6, KEPT + 5)


def test_an_exchange_ends_when_it_was_heard() -> None:
    line = Line(now=3.0)
    traffic = Traffic(line, lambda: line.now)
    traffic.since(0)
    line.exchange()
    (heard,) = traffic.since(0)
    assert (heard.exchange.time, heard.ended) == (3.0, 3.0)
