"""The commands a person types, run for real."""

import json
import os
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import httpx
import pytest

from gripperd import __version__
from gripperd.config import shipped
from tests.daemon import (
    PATIENCE,
    START,
    Daemon,
    document,
    gripperd,
    running_daemon,
    settings_file,
)


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    with running_daemon(tmp_path_factory.mktemp("daemon")) as daemon:
        yield daemon


def test_predict_gives_the_published_force() -> None:
    said = gripperd("predict", "--current", "10.7", "--diameter", "65")
    assert said.returncode == 0
    assert said.stdout.startswith("47.6 N per jaw, ± ")


def test_predict_inverts_itself() -> None:
    asked = gripperd("predict", "--force", "12", "--diameter", "58", "--json")
    current = json.loads(asked.stdout)["current_mA"]
    back = gripperd("predict", "--current", str(current), "--diameter", "58", "--json")
    assert json.loads(back.stdout)["force_N"] == pytest.approx(12, abs=0.01)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--current", "30", "--diameter", "65"], "30.00 mA is outside 4 to 20 mA"),
        (["--current", "10.7", "--diameter", "-41"], "-41 mm is not above 0 mm"),
        (
            ["--current", "nan", "--diameter", "41"],
            "--current nan is no finite number (mA)",
        ),
        (["--diameter", "41"], "either --current in mA or --force in N"),
        (["--current", "10.7", "--diameter", "90"], "they open 85 mm"),
        (["--current", "10,7", "--diameter", "65"], "Invalid value for '--current'"),
    ],
)
def test_unusable_input_is_one_clear_message(
    arguments: list[str], complaint: str
) -> None:
    said = gripperd("predict", *arguments)
    assert said.returncode == 2
    assert complaint in said.stderr
    assert "Traceback" not in said.stderr


def test_the_shipped_configuration_is_usable() -> None:
    said = gripperd("config", "check")
    assert said.returncode == 0
    assert "gripper g0: model reference" in said.stdout
    found = json.loads(gripperd("config", "check", "--json").stdout)
    assert found["models"] == {"g0": "reference"}
    assert found["warnings"] == []


def test_a_grasp_from_the_command_line(daemon: Daemon) -> None:
    url = daemon.url
    httpx.put(
        f"{url}/v1/bench/object", json={"profile": "apple"}, timeout=PATIENCE
    ).raise_for_status()
    held = gripperd("grasp", "apple", "--current", "10.7", GRIPPERD_URL=url)
    assert held.returncode == 0, held.stderr
    assert held.stdout.startswith("held: 46.")
    shown = gripperd("status", GRIPPERD_URL=url)
    assert shown.stdout.startswith("g0: ready, holding")
    # The valve of the shipped bench keeps its air, and a leak takes it in a minute.
    assert re.search(r"without air \d+\.\d s, .* without bus stays\n", shown.stdout)
    again = gripperd("grasp", "apple", GRIPPERD_URL=url)
    assert again.returncode == 1
    assert "apple is being held" in again.stderr
    assert "release first" in again.stderr
    stopped = gripperd("stop", GRIPPERD_URL=url)
    assert stopped.stdout == "stopping, holding\n"
    released = gripperd("release", "--json", GRIPPERD_URL=url)
    assert json.loads(released.stdout)["status"] == "succeeded"
    missed = gripperd("grasp", "apple", GRIPPERD_URL=url)
    assert missed.returncode == 1
    assert "no_object: the jaws closed past 57.0 mm" in missed.stdout


def test_enabling_and_disabling_moves_nothing(daemon: Daemon) -> None:
    url = daemon.url
    before = document(f"{url}/v1/bench")["current_mA"]
    assert gripperd("disable", GRIPPERD_URL=url).stdout.startswith("disabled, ")
    refused = gripperd("grasp", "apple", GRIPPERD_URL=url)
    assert refused.returncode == 1
    assert "a command is not possible while the gripper is disabled" in refused.stderr
    assert "possible now: enable" in refused.stderr
    assert gripperd("enable", GRIPPERD_URL=url).stdout.startswith("ready, ")
    assert document(f"{url}/v1/bench")["current_mA"] == before


def test_help_names_units_and_the_version_is_told() -> None:
    assert "[mm]" in gripperd("predict", "--help").stdout
    assert gripperd("--version").stdout == f"gripperd {__version__}\n"


def test_no_command_waits_for_libraries_that_it_does_not_need() -> None:
    """They take longer than all else that a command has to load."""
    loaded = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "gripperd", "--version"],
        check=True, capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip
    names = {line.rpartition("|")[2].strip() for line in loaded.stderr.splitlines()}
    assert "gripperd.demo.hidden" in names
    assert not names & {"numpy", "scipy", "numba", "yaml", "matplotlib"}


def test_what_would_be_refused_later_is_warned_of(tmp_path: Path) -> None:
    shutil.copytree(shipped(), tmp_path / "config")
    egg = tmp_path / "config" / "profiles" / "raw_egg.yaml"
    egg.write_text(egg.read_text().replace("force_N: 12", "force_N: 34"))
    settings = tmp_path / "config" / "gripperd.yaml"
    text = settings.read_text().replace("opening_mm: [0, 100]", "opening_mm: [0, 50]")
    settings.write_text(text)
    said = gripperd("config", "check", str(settings))
    assert said.returncode == 0
    assert "warning: raw_egg on g0: 34.00 N per jaw is over 26.92 N" in said.stdout
    assert "ends at 50 mm, the jaws open to 85 mm" in said.stdout


def test_a_bench_that_cannot_listen_says_so_in_a_line(daemon: Daemon) -> None:
    host, port = daemon.bench
    said = gripperd("bench", "--tcp", f"{host}:{port}")
    assert said.returncode == 1
    assert f"the bench cannot listen on {host}:{port}" in said.stderr
    assert "Traceback" not in said.stderr


def test_without_a_daemon_it_says_so() -> None:
    said = gripperd("status", GRIPPERD_URL="http://127.0.0.1:9")
    assert said.returncode == 1
    assert "no daemon answers at http://127.0.0.1:9" in said.stderr


def test_reproduce_writes_a_page(tmp_path: Path) -> None:
    said = gripperd("reproduce", "--output", str(tmp_path / "paper"))
    assert said.returncode == 0, said.stderr
    assert (tmp_path / "paper" / "index.html").stat().st_size > 100_000
    assert "does not hold" in said.stdout


@contextmanager
def stranger(body: bytes) -> Iterator[str]:
    """A web server that answers everything with one text."""

    class Stranger(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            pass

    with HTTPServer(("127.0.0.1", 0), Stranger) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
        thread.join()


@pytest.mark.parametrize("body", [b"<html>", b"", b"[1]", b"{}", b"\xff"])
def test_what_is_no_gripperd_is_named(body: bytes) -> None:
    with stranger(body) as url:
        said = gripperd("status", GRIPPERD_URL=url)
    assert said.returncode == 1
    (line,) = said.stderr.splitlines()
    assert line.endswith("is no gripperd: status 200")


@pytest.mark.parametrize(
    "url",
    [
        "127.0.0.1:8765",
        "localhost",
        "",
        "ftp://localhost",
        "http://a:port",
    ],
)
def test_an_address_that_is_none_is_wrong_use(url: str) -> None:
    said = gripperd("status", "--url", url)
    assert said.returncode == 2
    (line,) = said.stderr.splitlines()
    assert line.startswith("error: --url: ")


def test_a_number_that_is_none_is_wrong_use(daemon: Daemon) -> None:
    said = gripperd("grasp", "apple", "--force", "nan", GRIPPERD_URL=daemon.url)
    assert said.returncode == 2
    assert "Traceback" not in said.stderr


def test_a_proxy_of_the_environment_is_not_asked(daemon: Daemon) -> None:
    proxy = "http://127.0.0.1:9"
    said = gripperd(
        "status",
        GRIPPERD_URL=daemon.url,
        HTTP_PROXY=proxy,
        http_proxy=proxy,
        NO_PROXY="",
    )
    assert said.returncode == 0, said.stderr


def test_the_service_listens_for_this_machine_alone() -> None:
    said = gripperd("service", "--http", "0.0.0.0:0")
    assert said.returncode == 2
    assert "put a reverse proxy with authentication in front" in said.stderr


@pytest.mark.parametrize(("journal", "stamped"), [("", True), ("8:1", False)])
def test_the_journal_gets_no_time_stamps(
    tmp_path: Path, journal: str, stamped: bool
) -> None:
    process = subprocess.Popen(
        [*START, "bench", "--config", str(settings_file(tmp_path))],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"JOURNAL_STREAM": journal},
    )
    assert process.stderr is not None
    with process.stderr as log:
        line = log.readline()
        process.terminate()
        process.wait(PATIENCE)
    assert "bench listens" in line
    assert (re.match(r"\d\d:\d\d:\d\d ", line) is not None) is stamped
