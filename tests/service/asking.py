"""What tests ask about recordings and diagnoses."""

from datetime import UTC, datetime
from typing import Any

import httpx

from gripperd.store.diagnoses import Status, StoredDiagnosis

from .conftest import Daemon

CSV = {"content-type": "text/csv"}
NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)


def sent(daemon: Daemon, content: bytes) -> str:
    path = "/v1/recordings?name=rig.csv"
    found: str = daemon.http.post(path, content=content, headers=CSV).json()["id"]
    return found


def asked(daemon: Daemon, recording: str, **more: object) -> httpx.Response:
    return daemon.http.post("/v1/diagnoses", json={"recording": recording, **more})


def over(daemon: Daemon, place: str) -> dict[str, Any]:
    return daemon.until(place, lambda found: found["progress"] is None)


def problem(answer: httpx.Response) -> tuple[int, str, str]:
    assert answer.headers["content-type"] == "application/problem+json"
    found = answer.json()
    return found["status"], found["code"], found["detail"]


def stored(status: Status) -> StoredDiagnosis:
    return StoredDiagnosis(
        id=status.value.encode().hex().ljust(32, "0"),
        recording="f" * 64,
        gripper="g0",
        model="as-drawn",
        version=0,
        seed=0,
        created_at=NOON,
        status=status,
    )
