"""What a person gets who asks for something that cannot be."""

from typing import Any

import httpx
import pytest

from .conftest import Daemon

COMMANDS = "/v1/grippers/g0/commands"
JSON = {"content-type": "application/json"}

BODIES: list[tuple[str, int, str, str | None, str]] = [
    # body, status, code, pointer, what the detail says
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": "10,7"}',
        422,
        "invalid",
        "/current_mA",
        '"10,7" is not a number (mA); write 10.7',
    ),
    (
        '{"type": "grasp", "params": {"profile": "raw_egg", "current_mA": "10.7"}}',
        422,
        "invalid",
        "/params/current_mA",
        '"10.7" is not a number (mA); write 10.7',
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": 10,7}',
        400,
        "malformed-json",
        None,
        "line 1, column 58",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": true}',
        422,
        "invalid",
        "/current_mA",
        "true is not a number (mA)",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": NaN}',
        422,
        "invalid",
        "/current_mA",
        "not a finite number (mA)",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": -Infinity}',
        422,
        "invalid",
        "/current_mA",
        "not a finite number (mA)",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": 1e999}',
        422,
        "invalid",
        "/current_mA",
        "not a finite number (mA)",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": 30}',
        422,
        "invalid",
        "/current_mA",
        "30 mA is outside 4 to 20 mA",
    ),
    (
        '{"type": "grasp", "params": {"profile": "raw_egg", "current_mA": 30}}',
        422,
        "invalid",
        "/params/current_mA",
        "30 mA is outside 4 to 20 mA",
    ),
    (
        '{"type": "grasp", "force_N": 12, "diameter_mm": -41}',
        422,
        "invalid",
        "/diameter_mm",
        "-41 mm is not above 0 mm",
    ),
    (
        '{"type": "grasp", "profile": "raw_eg"}',
        422,
        "invalid",
        "/profile",
        'did you mean "raw_egg"?',
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "curent_mA": 10.7}',
        422,
        "invalid",
        "/curent_mA",
        'did you mean "current_mA"?',
    ),
    (
        '{"type": "grasp", "params": {"profile": "raw_egg", "curent_mA": 10.7}}',
        422,
        "invalid",
        "/params/curent_mA",
        'did you mean "current_mA"?',
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": 10.7, "force_N": 12}',
        422,
        "invalid",
        "",
        "give current_mA or force_N, not both",
    ),
    (
        '{"type": "grasp", "profile": "apple", "current_mA": 10.7, "mode": "force"}',
        422,
        "invalid",
        "",
        "mode force contradicts current_mA",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "params": {"force_N": 12}}',
        422,
        "invalid",
        "",
        "not in both",
    ),
    (
        '{"type": "grasp", "force_N": 12}',
        422,
        "invalid",
        "/profile",
        "give diameter_mm",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "deadline_s": 121}',
        422,
        "invalid",
        "/deadline_s",
        "121 s is above 120 s",
    ),
    (
        '{"type": "juggle", "force_N": 12}',
        422,
        "invalid",
        "/type",
        "supported are: grasp, release, adjust, hold, move, vent, tare, self_test",
    ),
    ("{}", 422, "invalid", "/type", "is missing"),
    ("[]", 422, "invalid", "", "needs a JSON object"),
    ("null", 422, "invalid", "", "needs a JSON object"),
    ("", 422, "invalid", "", "needs a JSON object"),
    (
        '{"type": "grasp", "type": "release"}',
        400,
        "malformed-json",
        None,
        '"type" stands twice',
    ),
    ("[" * 60_000, 400, "malformed-json", None, "nested too deeply"),
    ("1" * 5000, 400, "malformed-json", None, "too many digits"),
    (
        '{"type": "\\ud800"}',
        422,
        "invalid",
        "/type",
        "supported are: grasp, release, adjust, hold, move, vent, tare, self_test",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "force_N": 30}',
        422,
        "infeasible",
        None,
        "raw_egg is damaged at 35 N",
    ),
    (
        '{"type": "grasp", "profile": "raw_egg", "current_mA": 4.5}',
        422,
        "infeasible",
        None,
        "raw_egg slips at 1.07 N",
    ),
    (
        '{"type": "grasp", "profile": "apple", "diameter_mm": 90}',
        422,
        "infeasible",
        None,
        "an object of 90 mm does not fit",
    ),
]


def is_problem(answer: httpx.Response, status: int, code: str) -> dict[str, Any]:
    """Check that an answer is a whole problem document."""
    assert answer.headers["content-type"] == "application/problem+json"
    found: dict[str, Any] = answer.json()
    assert (answer.status_code, found["status"], found["code"]) == (
        status,
        status,
        code,
    )
    assert {"type", "title", "detail", "instance", "category", "retryable"} <= set(
        found
    )
    return found


@pytest.mark.parametrize(("body", "status", "code", "pointer", "says"), BODIES)
def test_an_unusable_command_is_named_and_nothing_moves(
    daemon: Daemon, body: str, status: int, code: str, pointer: str | None, says: str
) -> None:
    before = daemon.http.get(f"{COMMANDS}?limit=200").json()
    answer = daemon.http.post(COMMANDS, content=body, headers=JSON)
    found = is_problem(answer, status, code)
    assert says in found["detail"]
    assert found["instance"] == COMMANDS
    pointers = [fault["pointer"] for fault in found["errors"]]
    assert pointers == ([] if pointer is None else [pointer])
    assert daemon.http.get(f"{COMMANDS}?limit=200").json() == before


def test_a_decimal_comma_outside_quotes_is_understood(daemon: Daemon) -> None:
    body = '{"type": "grasp", "profile": "raw_egg", "current_mA": 10,7}'
    found = daemon.http.post(COMMANDS, content=body, headers=JSON).json()
    assert found["hints"] == [
        "a decimal number is written with a point: 10.7, not 10,7"
    ]


def test_octets_that_are_no_text_are_refused(daemon: Daemon) -> None:
    answer = daemon.http.post(COMMANDS, content=b'{"type": "\xff"}', headers=JSON)
    found = is_problem(answer, 400, "malformed-json")
    assert found["detail"] == "line 1, column 11: not UTF-8 text"


def test_every_fault_of_a_body_is_said_at_once(daemon: Daemon) -> None:
    body = {"type": "grasp", "diameter_mm": -1, "force_N": "x", "nope": 1}
    found = daemon.http.post(COMMANDS, json=body).json()
    assert {fault["pointer"] for fault in found["errors"]} == {
        "/diameter_mm",
        "/force_N",
        "/nope",
    }


@pytest.mark.parametrize(
    ("query", "says"),
    [
        ("wait_s=nan", "not a number"),
        ("wait_s=-1", "below 0 s"),
        ("waits=1", "is not a parameter here"),
    ],
)
def test_an_unusable_query_is_named(daemon: Daemon, query: str, says: str) -> None:
    answer = daemon.http.post(f"{COMMANDS}?{query}", json={"type": "release"})
    found = is_problem(answer, 422, "invalid")
    assert says in found["detail"]
    assert found["errors"][0]["parameter"] == query.partition("=")[0]


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("GET", "/nothing", 404, "not-found"),
        ("GET", "/v1/grippers/", 404, "not-found"),
        ("GET", "/v1/grippers/g9", 404, "not-found"),
        ("POST", "/v1/grippers/g9/stop", 404, "not-found"),
        ("GET", f"{COMMANDS}/nope", 404, "not-found"),
        ("DELETE", f"{COMMANDS}/nope", 404, "not-found"),
        ("GET", "/v1/profiles/nope", 404, "not-found"),
        ("POST", "/v1/profiles/nope/evaluate", 404, "not-found"),
        ("POST", "/v1/info", 405, "method-not-allowed"),
        ("GET", "/v1/grippers/g0/stop", 405, "method-not-allowed"),
    ],
)
def test_what_is_not_there_is_a_problem_too(
    daemon: Daemon, method: str, path: str, status: int, code: str
) -> None:
    is_problem(daemon.http.request(method, path), status, code)


def test_a_wrong_method_names_every_right_one(daemon: Daemon) -> None:
    answer = daemon.http.get("/v1/bench/object")
    assert answer.headers["allow"] == "DELETE, PUT"
