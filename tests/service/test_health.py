"""Health and what one has to know."""

import httpx

from .conftest import Daemon
from .test_bad_input import is_problem


def test_a_whole_daemon_is_ready(daemon: Daemon) -> None:
    assert daemon.http.get("/v1/health/live").json() == {"status": "live"}
    assert daemon.http.get("/v1/health/ready").json() == {"status": "ready"}


def test_a_service_alone_lives_but_is_not_ready(lonely: httpx.Client) -> None:
    assert lonely.get("/v1/health/live").status_code == 200
    found = is_problem(lonely.get("/v1/health/ready"), 503, "not-ready")
    assert "the control process is not running" in found["detail"]


def test_info_says_what_one_has_to_know(daemon: Daemon) -> None:
    found = daemon.http.get("/v1/info").json()
    assert (found["version"], found["mode"]) == ("1.2.3", "simulated")
    assert found["started_at"] == "2023-11-14T22:13:20Z"
    assert found["models"] == {"g0": "reference"}
    assert found["fail_modes"] == {"g0": "freeze"}
    assert (found["control"], found["real_time"]) == ("up", False)
    assert found["overruns"] >= 0
    assert set(found["timing"]) == {"g0"}
    timing = found["timing"]["g0"]
    assert timing["target_ms"] == 10
    lateness = timing["lateness"]
    assert 0 <= lateness["p50_ms"] <= lateness["p99_ms"] <= lateness["longest_ms"]
    # It started a period at 10 ms, however late, so none was much shorter.
    assert timing["period"]["p50_ms"] > 5
    said = " ".join(found["warnings"])
    assert "not a safety function" in said
    assert "waveshare_ao_8ch: the module keeps the last current" in said
    assert "without real-time priority" in said


def test_info_says_what_the_modules_confirm_and_what_they_do_on_their_own(
    daemon: Daemon,
) -> None:
    rig = daemon.http.get("/v1/info").json()["modules"]["g0"]
    output = rig["output"]
    assert (output["module"], output["evidence"]) == ("waveshare_ao_8ch", "manual")
    assert output["title"] == "Waveshare Modbus RTU Analog Output 8CH"
    # It has no range register; the input module has, and it was read.
    assert (output["range"], output["range_verified"]) == ("0-20mA", False)
    assert (rig["input"]["range"], rig["input"]["range_verified"]) == ("0-20mA", True)
    assert (output["watchdog"], output["watchdog_timeout_s"]) == ("none", None)
    assert output["safe_mA"] is None
    assert "keeps the last current" in output["when_silent"]
    assert output["read_back_measured"] is False


def test_info_is_there_without_control(lonely: httpx.Client) -> None:
    found = lonely.get("/v1/info").json()
    assert found["mode"] == "hardware"
    assert "not running" in found["control"]
    assert (found["real_time"], found["overruns"]) == (None, None)
    assert found["timing"] == {}
    assert (found["buses"], found["modules"]) == ([], {})
