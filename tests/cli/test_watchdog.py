import os

import pytest

from gripperd.cli.watchdog import Watchdog, longest_silence


class Fed:
    def __init__(self) -> None:
        self.time = 0.0
        self.times: list[float] = []

    def now(self) -> float:
        return self.time

    def feed(self) -> None:
        self.times.append(self.time)

    def watchdog(self, *names: str, silence: float | None = 4.0) -> Watchdog:
        return Watchdog(names, silence, self.feed, self.now)


def test_progress_feeds_it_often_enough_and_no_oftener() -> None:
    fed = Fed()
    watchdog = fed.watchdog("g0")
    for step in range(1, 501):
        fed.time = step / 100
        watchdog.advanced("g0")
    assert fed.times == [1.0, 2.0, 3.0, 4.0, 5.0]


def test_one_that_stands_still_starves_it_however_the_others_run() -> None:
    fed = Fed()
    watchdog = fed.watchdog("g0", "g1")
    for step in range(1, 101):
        fed.time = step / 10
        watchdog.advanced("g0")
        if fed.time < 2:
            watchdog.advanced("g1")
    assert fed.times == [1.0, 2.0]


def test_it_takes_new_progress_of_all_each_time() -> None:
    fed = Fed()
    watchdog = fed.watchdog("g0", "g1")
    fed.time = 1.0
    watchdog.advanced("g0")
    watchdog.advanced("g1")
    fed.time = 2.0
    watchdog.advanced("g1")
    fed.time = 3.0
    watchdog.advanced("g1")
    assert fed.times == [1.0]


def test_nobody_is_told_when_nobody_watches() -> None:
    fed = Fed()
    fed.time = 99.0
    fed.watchdog("g0", silence=None).advanced("g0")
    assert fed.times == []


@pytest.mark.parametrize(
    ("environment", "silence"),
    [
        ({}, None),
        ({"WATCHDOG_USEC": "2500000"}, 2.5),
        ({"WATCHDOG_USEC": "2500000", "WATCHDOG_PID": str(os.getpid())}, 2.5),
        ({"WATCHDOG_USEC": "2500000", "WATCHDOG_PID": "1"}, None),
        ({"WATCHDOG_USEC": "0"}, None),
        ({"WATCHDOG_USEC": "soon"}, None),
    ],
)
def test_it_is_asked_for_as_systemd_does(
    environment: dict[str, str], silence: float | None
) -> None:
    assert longest_silence(environment) == silence
