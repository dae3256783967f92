"""Recordings over REST."""

import hashlib
from pathlib import Path
from typing import Any

import httpx
import pyarrow.csv
import pyarrow.parquet
import pytest

from gripperd.config import Settings

from .conftest import Daemon
from .test_guard import raw

CSV = {"content-type": "text/csv"}
BINARY = {"content-type": "application/octet-stream"}


def send(
    daemon: Daemon, content: bytes, name: str = "rig.csv", **headers: str
) -> httpx.Response:
    path = f"/v1/recordings?name={name}"
    return daemon.http.post(path, content=content, headers=headers or CSV)


def rows(rig_folder: Path) -> list[bytes]:
    return (rig_folder / "rig.csv").read_bytes().splitlines(keepends=True)


def problem(answer: httpx.Response) -> dict[str, Any]:
    assert answer.headers["content-type"] == "application/problem+json"
    found: dict[str, Any] = answer.json()
    return found


def test_a_recording_is_kept_once_under_the_hash_of_its_content(
    drawn: Daemon, rig_folder: Path
) -> None:
    content = b"".join(rows(rig_folder)[:121])
    sent = send(drawn, content)
    assert sent.status_code == 201
    found = sent.json()
    assert found["id"] == hashlib.sha256(content).hexdigest()
    assert sent.headers["location"] == f"/v1/recordings/{found['id']}"
    assert (found["name"], found["file"]) == ("rig", "rig.csv")
    assert found["size_octets"] == len(content)
    # 60 rows 0.4 s apart are 23.6 s.
    assert found["runs"] == [
        {"name": f"isometric_{number}", "samples": 60, "duration_s": 23.6}
        for number in (0, 1)
    ]
    assert found["columns"] == [
        "t_s",
        "current_mA",
        "pressure_kPa",
        "contraction",
        "force_N",
    ]
    again = send(drawn, content, "other.csv")
    assert (again.status_code, again.json()) == (200, found)
    assert drawn.http.get(sent.headers["location"]).json() == found
    assert found in drawn.http.get("/v1/recordings").json()["recordings"]


def test_a_parquet_file_is_told_by_its_content(
    drawn: Daemon, rig_folder: Path, tmp_path: Path
) -> None:
    table = pyarrow.csv.read_csv(rig_folder / "rig.csv").slice(0, 100)
    pyarrow.parquet.write_table(table, tmp_path / "rig.parquet")
    content = (tmp_path / "rig.parquet").read_bytes()
    found = send(drawn, content, "from_a_table", **BINARY).json()
    assert (found["file"], found["name"]) == ("from_a_table.parquet", "from_a_table")
    assert sum(run["samples"] for run in found["runs"]) == 100


@pytest.mark.parametrize(
    ("line", "spoilt", "said"),
    [
        (11, b"isometric_0,4,4.2,x7,0.01,3\n", 'rig.csv:12: pressure_kPa: "x7" is not'),
        (11, b"isometric_0,4,4.2\n", "rig.csv:12: 3 cells under 6 names"),
        (0, b"run,t_s,current_mA,pressure_bar,contraction,force_N\n", "pressure_bar"),
        (0, b"run,time,current_mA,x,contraction,force_N\n", "t_s"),
    ],
)
def test_what_is_no_recording_is_refused_with_its_place(
    drawn: Daemon, rig_folder: Path, line: int, spoilt: bytes, said: str
) -> None:
    lines = rows(rig_folder)[:60]
    lines[line] = spoilt
    before = drawn.http.get("/v1/recordings").json()
    refused = problem(send(drawn, b"".join(lines)))
    assert (refused["status"], refused["code"]) == (422, "invalid")
    assert said in refused["detail"]
    # The place is the client's, not one on this machine.
    assert "/" not in refused["detail"]
    assert drawn.http.get("/v1/recordings").json() == before


def test_nothing_is_left_of_what_was_refused(
    drawn: Daemon, drawn_settings: Settings
) -> None:
    assert send(drawn, b"no table").status_code == 422
    folder = drawn_settings.state_dir / "recordings"
    assert [left.name for left in folder.iterdir() if left.name.startswith(".")] == []


def test_a_body_of_another_type_is_refused_with_the_right_ones(drawn: Daemon) -> None:
    form = {"content-type": "application/x-www-form-urlencoded"}
    refused = problem(send(drawn, b"run,t_s\n", **form))
    assert (refused["status"], refused["code"]) == (415, "unsupported-media-type")
    assert "text/csv" in refused["hints"][0]


def test_a_body_that_is_too_large_is_refused_before_it_is_read(drawn: Daemon) -> None:
    head = (
        "POST /v1/recordings HTTP/1.1\r\nHost: localhost\r\n"
        f"Content-Type: text/csv\r\nContent-Length: {65 * 2**20}\r\n\r\n"
    )
    answer = raw(drawn, head.encode())
    assert answer.startswith(b"HTTP/1.1 413")
    assert b"up to 64 MB; this one has 65 MB" in answer


@pytest.mark.parametrize("name", ["../rig.csv", "a%2Fb.csv", ".hidden", "", "x" * 81])
def test_a_name_that_leads_elsewhere_is_refused(drawn: Daemon, name: str) -> None:
    refused = problem(send(drawn, b"run,t_s\n", name))
    assert refused["status"] == 422
    assert refused["errors"][0]["parameter"] == "name"


@pytest.mark.parametrize("recording", ["0" * 64, "..", "rig"])
def test_what_is_not_there_is_not_found(drawn: Daemon, recording: str) -> None:
    answer = drawn.http.get(f"/v1/recordings/{recording.replace('.', '%2E')}")
    assert problem(answer)["status"] == 404


def test_other_requests_may_still_not_be_large(drawn: Daemon) -> None:
    json = {"content-type": "application/json"}
    answer = drawn.http.post("/v1/diagnoses", content=b" " * 65537, headers=json)
    assert problem(answer)["status"] == 413
