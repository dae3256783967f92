"""Diagnoses take turns, and outlive the service."""

import os
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from gripperd.config import Settings
from gripperd.store.diagnoses import RESULT, Diagnoses, Status
from tests.daemon import PATIENCE

from .asking import asked, over, problem, sent, stored
from .conftest import Daemon, running, service


@pytest.fixture(scope="module")
def whole(drawn_daemon: Daemon, rig_folder: Path) -> str:
    """Id of the recording of a rig with creep."""
    return sent(drawn_daemon, (rig_folder / "rig.csv").read_bytes())


def test_one_runs_niced_and_the_others_wait_and_all_can_be_cancelled(
    drawn: Daemon, whole: str
) -> None:
    first, second = (asked(drawn, whole) for _ in range(2))
    assert (first.status_code, second.status_code) == (201, 201)
    assert second.json()["status"] == "queued"
    assert second.json()["progress"] == {"doing": "waiting", "share": 0.0}
    running_place, waiting_place = (one.headers["location"] for one in (first, second))
    drawn.until(running_place, lambda found: found["progress"]["doing"] == "reading")
    (worker,) = workers()
    assert os.getpriority(os.PRIO_PROCESS, worker) == os.nice(0) + 10
    status, code, _ = problem(drawn.http.get(f"{running_place}/report"))
    assert (status, code) == (409, "not-finished")
    for place in (waiting_place, running_place):
        assert drawn.http.delete(place).status_code == 202
        found = drawn.http.get(place).json()
        assert (found["status"], found["progress"]) == ("cancelled", None)
        status, code, _ = problem(drawn.http.delete(place))
        assert (status, code) == (409, "already-final")
        status, code, _ = problem(drawn.http.post(f"{place}/accept"))
        assert (status, code) == (409, "nothing-found")
    assert workers() == []


def workers() -> list[int]:
    """Worker processes of this process."""
    children = [
        int(child)
        for listing in Path("/proc/self/task").glob("*/children")
        for child in _text(listing).split()
    ]
    commands = {one: _text(Path(f"/proc/{one}/cmdline")) for one in children}
    return [one for one in children if "gripperd.service.worker" in commands[one]]


def _text(entry: Path) -> str:
    """What it says; nothing of a thread or a process that has just ended."""
    try:
        return entry.read_text()
    except OSError:
        return ""


def test_no_more_wait_than_there_is_room_for(drawn: Daemon, whole: str) -> None:
    answers = [asked(drawn, whole) for _ in range(18)]
    try:
        # One runs and sixteen wait.
        assert [answer.status_code for answer in answers] == [201] * 17 + [429]
        assert problem(answers[-1])[1:] == (
            "queue-full",
            "16 diagnoses are waiting already",
        )
    finally:
        for answer in reversed(answers[:-1]):
            drawn.http.delete(answer.headers["location"])


def test_a_new_life_finds_what_is_over_and_calls_the_rest_failed(
    drawn_settings: Settings, tmp_path: Path
) -> None:
    kept = Diagnoses(tmp_path / "diagnoses")
    done, begun = stored(Status.SUCCEEDED), stored(Status.QUEUED)
    for one in (done, begun):
        kept.put(one)
    (kept.place(done.id) / RESULT).write_text('{"verdict": "none"}')
    apart = replace(drawn_settings, state_dir=tmp_path, runtime_dir=tmp_path)
    with (
        running(lambda report: service(apart, report, bench=False)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        found = http.get(f"/v1/diagnoses/{done.id}").json()
        assert (found["status"], found["result"]) == ("succeeded", {"verdict": "none"})
        found = http.get(f"/v1/diagnoses/{begun.id}").json()
        assert (found["status"], found["error"]["code"]) == ("failed", "interrupted")


@pytest.mark.parametrize("draft", [".record.draft", ".result.draft"])
def test_what_the_disk_does_not_take_has_failed(
    drawn: Daemon, drawn_settings: Settings, rig_folder: Path, draft: str
) -> None:
    lines = (rig_folder / "rig.csv").read_bytes().splitlines(keepends=True)
    short = sent(drawn, b"".join(lines[:45]))
    place = asked(drawn, short).headers["location"]
    folder = drawn_settings.state_dir / place.removeprefix("/v1/")
    # A folder where a file is to be written: nobody can, not even root.
    (folder / draft).mkdir()
    found = over(drawn, place)
    assert (found["status"], found["error"]["code"]) == ("failed", "storage-failed")
    assert "nothing was kept" in found["error"]["message"]
    status, code, _ = problem(drawn.http.post(f"{place}/accept"))
    assert (status, code) == (409, "nothing-found")


def test_a_service_that_ends_leaves_no_worker_and_its_next_life_says_so(
    drawn_settings: Settings, rig_folder: Path, tmp_path: Path
) -> None:
    apart = replace(drawn_settings, state_dir=tmp_path, runtime_dir=tmp_path)
    with (
        running(lambda report: service(apart, report, bench=False)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        daemon = Daemon(url, http)
        whole = sent(daemon, (rig_folder / "rig.csv").read_bytes())
        place = asked(daemon, whole).headers["location"]
        daemon.until(place, lambda found: found["status"] == "running")
    assert workers() == []
    with (
        running(lambda report: service(apart, report, bench=False)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        found = http.get(place).json()
        assert (found["status"], found["error"]["code"]) == ("failed", "interrupted")
        assert len(http.get("/v1/recordings").json()["recordings"]) == 1
