"""The OpenAPI document and the page made from it."""

import re
from typing import Any

import pytest

from gripperd.service.problems import PROBLEMS

from .conftest import Daemon

OPERATIONS = {
    "GET /v1/health/live",
    "GET /v1/health/ready",
    "GET /v1/info",
    "GET /v1/grippers",
    "GET /v1/grippers/{gripper}",
    "POST /v1/grippers/{gripper}/commands",
    "GET /v1/grippers/{gripper}/commands",
    "GET /v1/grippers/{gripper}/commands/{id}",
    "DELETE /v1/grippers/{gripper}/commands/{id}",
    "POST /v1/grippers/{gripper}/stop",
    "POST /v1/grippers/{gripper}/enable",
    "POST /v1/grippers/{gripper}/disable",
    "POST /v1/grippers/{gripper}/reset",
    "GET /v1/grippers/{gripper}/faults",
    "POST /v1/grippers/{gripper}/faults/{id}/acknowledge",
    "GET /v1/history",
    "GET /v1/events",
    "GET /v1/grippers/{gripper}/lease",
    "PUT /v1/grippers/{gripper}/lease",
    "DELETE /v1/grippers/{gripper}/lease",
    "GET /v1/profiles",
    "POST /v1/profiles",
    "GET /v1/profiles/{profile}",
    "PUT /v1/profiles/{profile}",
    "DELETE /v1/profiles/{profile}",
    "POST /v1/profiles/{profile}/evaluate",
    "POST /v1/predictions",
    "GET /v1/models",
    "GET /v1/models/{version}",
    "POST /v1/models/{version}/activate",
    "GET /v1/recordings",
    "POST /v1/recordings",
    "GET /v1/recordings/{id}",
    "GET /v1/diagnoses",
    "POST /v1/diagnoses",
    "GET /v1/diagnoses/{id}",
    "GET /v1/diagnoses/{id}/report",
    "DELETE /v1/diagnoses/{id}",
    "POST /v1/diagnoses/{id}/accept",
    "GET /v1/config",
    "POST /v1/config/validate",
    "POST /v1/config/reload",
    "GET /v1/bench",
    "PUT /v1/bench/object",
    "DELETE /v1/bench/object",
    "PUT /v1/bench/faults",
    "DELETE /v1/bench/faults",
    "PUT /v1/bench/wire-faults",
    "DELETE /v1/bench/wire-faults",
}


@pytest.fixture
def schema(daemon: Daemon) -> dict[str, Any]:
    found: dict[str, Any] = daemon.http.get("/openapi.json").json()
    return found


def operations(schema: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {
        f"{method.upper()} {path}": operation
        for path, methods in schema["paths"].items()
        for method, operation in methods.items()
    }


def test_every_operation_is_described(schema: dict[str, Any]) -> None:
    found = operations(schema)
    assert set(found) == OPERATIONS
    assert all(operation["description"] for operation in found.values())
    names = [operation["operationId"] for operation in found.values()]
    assert len(set(names)) == len(names)


def test_every_failure_is_a_problem_document(schema: dict[str, Any]) -> None:
    for operation in operations(schema).values():
        failed = operation["responses"]["default"]["content"]
        assert failed == {
            "application/problem+json": {
                "schema": {"$ref": "#/components/schemas/Problem"}
            }
        }
        assert "422" not in operation["responses"]
    assert "HTTPValidationError" not in schema["components"]["schemas"]


def test_every_reference_leads_somewhere(schema: dict[str, Any]) -> None:
    names = set(re.findall(r"#/components/schemas/(\w+)", str(schema)))
    assert names
    assert names <= set(schema["components"]["schemas"])


def test_the_page_lists_everything_and_loads_nothing(daemon: Daemon) -> None:
    answer = daemon.http.get("/docs")
    page = answer.text
    assert answer.headers["content-type"].startswith("text/html")
    for operation in OPERATIONS:
        method, path = operation.split()
        assert f"<b>{method}</b> <code>{path}</code>" in page
    for code in PROBLEMS:
        assert f"<code>{code}</code>" in page
    assert "<script" not in page
    assert not re.search(r"(src|href)=[\"']?(https?:)?//", page)
    assert "default-src 'none'" in answer.headers["content-security-policy"]


def test_the_front_leads_to_the_page(daemon: Daemon) -> None:
    answer = daemon.http.get("/")
    assert (answer.status_code, answer.headers["location"]) == (307, "/docs")
