import pytest

from gripperd.control.pace import Pace

pytestmark = pytest.mark.anyio


class Clock:
    """A time that passes when somebody waits or works."""

    def __init__(self) -> None:
        self.time = 100.0
        self.late = 0.0
        """How much too late it wakes who waits. [s]"""
        self.wakes: list[float] = []

    def now(self) -> float:
        return self.time

    async def until(self, when: float) -> None:
        self.time = max(self.time, when) + self.late
        self.wakes.append(self.time)


async def test_deadlines_do_not_drift_with_the_work() -> None:
    clock = Clock()
    pace = Pace(0.01, clock.now)
    for work in (0.001, 0.009, 0.004):
        clock.time += work
        await pace.next(clock.until)
    assert clock.wakes == pytest.approx([100.01, 100.02, 100.03])
    assert pace.overruns == 0


async def test_lateness_does_not_add_up() -> None:
    clock = Clock()
    clock.late = 0.002
    pace = Pace(0.01, clock.now)
    for _ in range(3):
        await pace.next(clock.until)
    assert clock.wakes == pytest.approx([100.012, 100.022, 100.032])
    timing = pace.timing()
    assert timing.lateness.total == pytest.approx(0.006)
    assert timing.lateness.count == timing.period.count == 3
    assert timing.period.total == pytest.approx(0.032)


async def test_an_overrun_is_counted_and_the_beat_starts_anew() -> None:
    clock = Clock()
    pace = Pace(0.01, clock.now)
    clock.time += 0.5
    await pace.next(clock.until)
    assert pace.overruns == 1
    assert pace.timing().lateness.largest == pytest.approx(0.49)
    # No burst of periods to make up for the lost ones.
    await pace.next(clock.until)
    assert clock.wakes == pytest.approx([100.5, 100.51])
    assert pace.overruns == 1


async def test_time_before_the_beginning_does_not_count() -> None:
    clock = Clock()
    pace = Pace(0.01, clock.now)
    clock.time += 5
    pace.begin()
    await pace.next(clock.until)
    assert clock.wakes == pytest.approx([105.01])
    assert pace.overruns == 0
