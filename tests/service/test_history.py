"""What happened, read from the disk and followed as it happens."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from tests.daemon import PATIENCE

from .conftest import Daemon
from .test_bad_input import COMMANDS, is_problem

RELEASE = {"type": "release"}


def released(daemon: Daemon) -> dict[str, Any]:
    """A command that is over, and in the history."""
    answer = daemon.http.post(f"{COMMANDS}?wait_s=60", json=RELEASE)
    command: dict[str, Any] = answer.json()
    daemon.until(
        f"/v1/history?command={command['id']}", lambda page: len(page["events"]) == 3
    )
    return command


def events(answer: httpx.Response) -> Iterator[dict[str, Any]]:
    """Events of a stream, with their ids."""
    found: dict[str, Any] = {}
    for line in answer.iter_lines():
        field, _, value = line.partition(": ")
        if field == "data":
            found["data"] = json.loads(value)
        elif field in {"id", "event"}:
            found[field] = value
        elif not line and found:
            yield found
            found = {}


@contextmanager
def following(daemon: Daemon, **headers: str) -> Iterator[Iterator[dict[str, Any]]]:
    """Events as they happen."""
    accept = {"accept": "text/event-stream"}
    with (
        httpx.Client(base_url=daemon.url, timeout=PATIENCE) as http,
        http.stream("GET", "/v1/events", headers=accept | headers) as answer,
    ):
        assert answer.headers["content-type"].startswith("text/event-stream")
        yield events(answer)


def test_a_command_is_told_from_its_begin_to_its_end(daemon: Daemon) -> None:
    command = released(daemon)
    page = daemon.http.get(f"/v1/history?command={command['id']}").json()
    told = [event["command"]["status"] for event in page["events"]]
    assert told == ["succeeded", "running", "queued"]
    assert page["events"][0]["command"] == command
    assert page["next"] is None


def test_pages_lead_to_the_beginning(daemon: Daemon) -> None:
    released(daemon)
    place, seen = "/v1/history?kind=command&limit=2", list[int]()
    page = daemon.http.get(place).json()
    while page["next"] is not None:
        seen += [event["number"] for event in page["events"]]
        page = daemon.http.get(f"{place}&before={page['next']}").json()
    seen += [event["number"] for event in page["events"]]
    assert seen == sorted(set(seen), reverse=True)
    whole = daemon.http.get("/v1/history?kind=command&limit=500").json()["events"]
    assert seen == [event["number"] for event in whole][: len(seen)]


def test_states_and_adoptions_are_told(daemon: Daemon) -> None:
    kinds = {"state", "adoption", "control"}
    query = "&".join(f"kind={kind}" for kind in sorted(kinds))
    found = daemon.until(
        f"/v1/history?{query}&limit=500",
        lambda page: {event["kind"] for event in page["events"]} == kinds,
    )["events"]
    adopted = [each["text"] for each in found if each["kind"] == "adoption"]
    assert any("mA as found" in text for text in adopted)
    assert {each["machine"] for each in found if each["kind"] == "state"} >= {"ready"}


def test_a_time_is_a_filter(daemon: Daemon) -> None:
    command = released(daemon)
    query = {"since": command["completed_at"], "command": command["id"]}
    found = daemon.http.get("/v1/history", params=query).json()["events"]
    told = [event["command"]["status"] for event in found]
    assert told[0] == "succeeded"
    assert "queued" not in told


@pytest.mark.parametrize(
    "query",
    ["kind=rumour", "since=yesterday", "since=2026-01-01T00:00:00", "limit=0", "x=1"],
)
def test_what_cannot_be_asked_for_is_refused(daemon: Daemon, query: str) -> None:
    is_problem(daemon.http.get(f"/v1/history?{query}"), 422, "invalid")


def test_events_come_as_they_happen(daemon: Daemon) -> None:
    with following(daemon) as told:
        given = daemon.http.post(COMMANDS, json=RELEASE).json()
        statuses = list[str]()
        while statuses != ["queued", "running", "succeeded"]:
            event = next(told)
            if event["event"] == "command":
                assert event["data"]["command"]["id"] == given["id"]
                assert int(event["id"]) == event["data"]["number"]
                statuses.append(event["data"]["command"]["status"])


def test_who_comes_back_gets_what_was_missed_and_nothing_twice(daemon: Daemon) -> None:
    command = released(daemon)
    page = daemon.http.get(f"/v1/history?command={command['id']}").json()["events"]
    over, running, _ = (str(event["number"]) for event in page)
    with following(daemon, **{"last-event-id": running}) as told:
        assert next(told)["id"] > running
        later = released(daemon)["id"]
        numbers, seen = [int(running)], ""
        while seen != "succeeded":
            event = next(told)
            numbers.append(int(event["id"]))
            about = event["data"].get("command") or {}
            seen = about["status"] if about.get("id") == later else ""
    assert numbers == sorted(set(numbers))
    assert int(over) <= numbers[-1]


def test_what_is_no_event_id_is_refused(daemon: Daemon) -> None:
    answer = daemon.http.get("/v1/events", headers={"last-event-id": "-1"})
    found = is_problem(answer, 422, "invalid")
    assert "'-1' is not the id of an event" in found["detail"]


def test_commands_of_an_earlier_life_are_still_listed(daemon: Daemon) -> None:
    command = released(daemon)
    listed = daemon.http.get(f"{COMMANDS}?limit=200").json()["commands"]
    assert listed[0] == command
    times = [each["created_at"] for each in listed]
    assert times == sorted(times, reverse=True)
