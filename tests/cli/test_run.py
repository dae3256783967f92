"""The daemon as a service manager and a kill signal see it."""

import os
import signal
import socket
import stat
import subprocess
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from tests.daemon import (
    PATIENCE,
    START,
    Daemon,
    children,
    document,
    found,
    gripperd,
    running,
    running_daemon,
    settings_file,
    until,
)


def answers(url: str) -> bool:
    try:
        return httpx.get(f"{url}/v1/health/ready", timeout=PATIENCE).is_success
    except httpx.TransportError:
        return False


def hold_an_egg(daemon: Daemon) -> float:
    with httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http:
        http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()
        body = {"type": "grasp", "profile": "raw_egg"}
        done = http.post(
            "/grippers/g0/commands", json=body, headers={"Prefer": "wait=60"}
        ).json()
    assert done["status"] == "succeeded", str(done)
    return float(done["result"]["force_N"])


def true_force(daemon: Daemon) -> float:
    return float(document(f"{daemon.url}/v1/bench")["force_N"])


def test_readiness_is_told_when_the_interface_answers_and_not_before(
    tmp_path: Path,
) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(PATIENCE)
        arguments = ("run", "--config", str(settings_file(tmp_path)))
        with running(*arguments, NOTIFY_SOCKET=str(tmp_path / "notify")) as process:
            told = manager.recv(4096).decode()
            assert "READY=1" in told.splitlines()
            assert process.stdout is not None
            (url,) = found(process.stdout, r"(http://\S+)")
            assert answers(url)
            until(lambda: document(f"{url}/v1/grippers/g0")["machine"] == "ready")


def test_what_runs_for_months_loads_no_numerics_that_it_does_not_use(
    tmp_path: Path,
) -> None:
    with running_daemon(tmp_path) as daemon:
        pids = {"run": daemon.process.pid, **children(daemon.process)}
        assert set(pids) == {"run", "bench", "control", "service"}
        for name, pid in pids.items():
            mapped = Path(f"/proc/{pid}/maps").read_text()
            assert "/numpy/" in mapped, name
            for heavy in ("scipy", "pyarrow", "llvmlite", "matplotlib"):
                assert f"/{heavy}/" not in mapped, f"{name} loads {heavy}"


def test_the_service_is_killed_and_the_grip_does_not_notice(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        held = hold_an_egg(daemon)
        egg = document(f"{daemon.url}/v1/profiles/raw_egg")
        mine = egg | {"name": "duck_egg", "diameter_mm": 45}
        httpx.post(
            f"{daemon.url}/v1/profiles", json=mine, timeout=PATIENCE
        ).raise_for_status()
        service = children(daemon.process)["service"]
        os.kill(service, signal.SIGKILL)
        until(lambda: children(daemon.process).get("service", service) != service)
        until(lambda: answers(daemon.url))
        kept = document(f"{daemon.url}/v1/profiles/duck_egg")
        assert kept["diameter_mm"] == 45
        assert true_force(daemon) == pytest.approx(held, rel=0.05)
        state = document(f"{daemon.url}/v1/grippers/g0")
        assert (state["grip"], state["holding"]) == ("holding", "raw_egg")


def test_control_is_killed_and_adopts_what_it_held(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        held = hold_an_egg(daemon)
        written = document(f"{daemon.url}/v1/bench")["current_mA"]
        first = children(daemon.process)["control"]
        os.kill(first, signal.SIGKILL)
        until(lambda: children(daemon.process).get("control", first) != first)
        until(lambda: answers(daemon.url))
        state = document(f"{daemon.url}/v1/grippers/g0")
        assert (state["grip"], state["adopted"]) == ("holding", True)
        assert document(f"{daemon.url}/v1/bench")["current_mA"] == written
        assert true_force(daemon) == pytest.approx(held, rel=0.05)


def test_the_children_end_with_their_supervisor(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        pids = children(daemon.process).values()
        daemon.process.kill()
        daemon.process.wait(PATIENCE)
        until(lambda: not any(Path(f"/proc/{pid}/task").exists() for pid in pids))


def test_a_second_daemon_in_the_same_place_is_refused(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        second = gripperd("run", "--config", str(tmp_path / "gripperd.yaml"))
        assert second.returncode == 1
        assert f"runs already in {tmp_path / 'run'}" in second.stderr
        assert str(daemon.process.pid) in second.stderr
        assert answers(daemon.url)


def test_a_port_that_is_taken_is_one_clear_line(tmp_path: Path) -> None:
    settings = settings_file(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        text = settings.read_text().replace("port: 0", f"port: {port}")
        settings.write_text(text)
        ended = gripperd("run", "--config", str(settings))
    assert ended.returncode == 1
    assert f"http.port = {port}: another program listens there" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_only_the_user_may_speak_to_control(tmp_path: Path) -> None:
    with running_daemon(tmp_path):
        mode = (tmp_path / "run" / "control.sock").stat().st_mode
        assert stat.S_IMODE(mode) == 0o600
        assert stat.S_IMODE((tmp_path / "run").stat().st_mode) == 0o700


def test_a_file_that_breaks_takes_nothing_down(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        held = hold_an_egg(daemon)
        control = children(daemon.process)["control"]
        settings = tmp_path / "gripperd.yaml"
        good = settings.read_text()
        settings.write_text("grippers: broken\n")
        service = children(daemon.process)["service"]
        os.kill(service, signal.SIGKILL)
        until(lambda: children(daemon.process).get("service", service) != service)
        # This life of the service ends with 78 before it serves.
        until(lambda: "service" not in children(daemon.process))
        assert daemon.process.poll() is None
        folder = tmp_path / "state" / "profiles"
        folder.mkdir(parents=True)
        (folder / "plum.yaml").write_text("name: plum\nversion: many\n")
        settings.write_text(good)
        until(lambda: answers(daemon.url))
        assert children(daemon.process)["control"] == control
        assert true_force(daemon) == pytest.approx(held, rel=0.05)
        warnings = document(f"{daemon.url}/v1/info")["warnings"]
        assert any(f"{folder}/plum.yaml:2: version" in warning for warning in warnings)
    checked = gripperd("config", "check", str(settings))
    assert checked.returncode == 0
    assert f"warning: {folder}/plum.yaml:2: version" in checked.stdout


def test_who_is_told_to_end_in_the_middle_of_the_start_ends_quietly(
    tmp_path: Path,
) -> None:
    arguments = [*START, "run", "--config", str(settings_file(tmp_path))]
    with (tmp_path / "log").open("w+") as log:
        process = subprocess.Popen(arguments, stdout=log, stderr=log, text=True)
        until(lambda: "control" in children(process))
        # Until it is killed, control goes on with its start.
        os.kill(children(process)["service"], signal.SIGSTOP)
        process.terminate()
        assert process.wait(PATIENCE) == 0
        log.seek(0)
        said = log.read()
    assert "Traceback" not in said
    assert "nobody hears" not in said
    assert "SIGTERM: ending" in said


def test_a_report_that_nobody_hears_ends_nothing(tmp_path: Path) -> None:
    arguments = [*START, "bench", "--config", str(settings_file(tmp_path))]
    nowhere = os.environ | {"NOTIFY_SOCKET": str(tmp_path / "nowhere")}
    with (tmp_path / "log").open("w+") as log:
        process = subprocess.Popen(arguments, stderr=log, env=nowhere)
        until(lambda: "nobody hears" in (tmp_path / "log").read_text())
        process.terminate()
        assert process.wait(PATIENCE) == 0
    assert "Traceback" not in (tmp_path / "log").read_text()


def test_a_process_without_its_supervisor_does_not_start(tmp_path: Path) -> None:
    settings = settings_file(tmp_path)
    ended = gripperd("bench", "--config", str(settings), GRIPPERD_SUPERVISED="0")
    assert ended.returncode == 1
    assert "the supervisor, process 0, is not there any more" in ended.stderr
    assert "Traceback" not in ended.stderr


def a_file(folder: Path) -> None:
    folder.write_text("")


def a_link(folder: Path) -> None:
    folder.with_name("elsewhere").mkdir()
    folder.symlink_to(folder.with_name("elsewhere"))


def a_linked_lock(folder: Path) -> None:
    folder.mkdir(mode=0o700)
    folder.with_name("precious").write_text("precious")
    (folder / "lock").symlink_to(folder.with_name("precious"))


def a_hard_lock(folder: Path) -> None:
    folder.mkdir(mode=0o700)
    folder.with_name("precious").write_text("precious")
    (folder / "lock").hardlink_to(folder.with_name("precious"))


def a_folder_as_socket(folder: Path) -> None:
    (folder / "bench.notify").mkdir(parents=True)


@pytest.mark.parametrize(
    "occupy", [a_file, a_link, a_linked_lock, a_hard_lock, a_folder_as_socket]
)
def test_a_runtime_dir_that_is_not_ours_is_one_clear_line(
    tmp_path: Path, occupy: Callable[[Path], None]
) -> None:
    occupy(tmp_path / "run")
    ended = gripperd("run", "--config", str(settings_file(tmp_path)))
    assert ended.returncode == 78
    (line,) = ended.stderr.splitlines()
    assert line.startswith("error: ")
    assert str(tmp_path / "run") in line
    if (tmp_path / "precious").exists():
        assert (tmp_path / "precious").read_text() == "precious"


@pytest.mark.parametrize("command", ["run", "bench", "control", "service"])
def test_a_runtime_dir_that_is_too_long_is_one_clear_line(
    tmp_path: Path, command: str
) -> None:
    settings = settings_file(tmp_path)
    text = settings.read_text().replace(f"{tmp_path}/run", "r" * 100)
    settings.write_text(text)
    ended = gripperd(command, "--config", str(settings))
    assert ended.returncode == 78
    (line,) = ended.stderr.splitlines()
    assert "at most 107 are possible" in line


def test_an_unusable_configuration_ends_with_78(tmp_path: Path) -> None:
    settings = settings_file(tmp_path)
    text = settings.read_text().replace("rate_Hz: 100", "rate_Hz: 5000")
    settings.write_text(text)
    line = text[: text.index("rate_Hz: 5000")].count("\n") + 1
    for command in (("run", "--config"), ("config", "check")):
        ended = gripperd(*command, str(settings))
        assert ended.returncode == 78
        assert ended.stderr == (
            f"error: {settings}:{line}: grippers.g0.rate_Hz: 5000 Hz is above 500 Hz\n"
        )
