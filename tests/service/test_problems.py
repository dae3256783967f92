"""Problem documents and their table."""

import json

import pytest

from gripperd import errors
from gripperd.service.problems import (
    PROBLEMS,
    ProblemResponse,
    code_of,
    problem,
)


def test_every_error_of_ours_has_a_status_that_fits() -> None:
    statuses = {
        errors.NotFound("x"): 404,
        errors.InputError("x"): 422,
        errors.DomainError("x"): 422,
        errors.ConfigError("x"): 422,
        errors.LinkLost("x"): 503,
        errors.ReplyTimeout("x"): 503,
        errors.BadReply("x"): 503,
        errors.DeviceRefused("x", exception_code=4): 503,
        errors.Refused("x", code="wrong-state"): 409,
        errors.Refused("x", code="object-held"): 409,
        errors.Refused("x", code="queue-full"): 429,
        errors.Refused("x", code="infeasible"): 422,
        errors.Refused("x", code="some-new-reason"): 409,
        errors.Refused("x", code="link-down"): 503,
        errors.Refused("x", code="storage-full"): 507,
        errors.Refused("x", code="storage-failed"): 503,
        errors.GripperdError("x"): 500,
    }
    for error, status in statuses.items():
        found = problem(code_of(error), str(error), instance="/")
        assert (type(error).__name__, found.status) == (type(error).__name__, status)


def test_only_what_may_pass_is_retryable() -> None:
    again = {code for code, kind in PROBLEMS.items() if kind.retryable}
    assert {"link-lost", "queue-full", "object-held"} <= again
    assert again.isdisjoint({"invalid", "infeasible", "not-found", "internal"})


def test_text_that_is_no_text_is_answered_all_the_same() -> None:
    answer = ProblemResponse(problem("invalid", "\ud800 µ", instance="/"))
    assert "µ".encode() in bytes(answer.body)
    assert json.loads(bytes(answer.body))["detail"] == "\ud800 µ"


@pytest.mark.parametrize(("code", "after"), [("queue-full", "1"), ("invalid", None)])
def test_a_busy_service_says_when_to_come_back(code: str, after: str | None) -> None:
    answer = ProblemResponse(problem(code, "x", instance="/"))
    assert answer.headers.get("retry-after") == after
