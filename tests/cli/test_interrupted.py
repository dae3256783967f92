"""Ctrl-C in the middle of long work: what it says, and what it leaves."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer

from gripperd.cli.interrupt import AGAIN, interruptible
from gripperd.demo.files import write_rig
from gripperd.demo.hidden import Hidden
from tests.daemon import PATIENCE, START, until

REPORT = ("report.html", "diagnosis.json")


TICKS = os.sysconf("SC_CLK_TCK")


def worked(process: int) -> float:
    """Time that a process has had a processor, without its children. [s]"""
    words = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    # proc_pid_stat(5): utime and stime are the 12th and 13th after the name.
    return (int(words[11]) + int(words[12])) / TICKS


def interrupted(folder: Path, arguments: list[str], seconds: float) -> tuple[int, str]:
    """Exit status and complaint of a command that a terminal interrupts."""
    process = subprocess.Popen(
        [*START, *arguments], cwd=folder, stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL, text=True, start_new_session=True,
    )  # fmt: skip
    until(lambda: (folder / "discrepancy/rig.csv").exists())
    until(lambda: worked(process.pid) > seconds)
    # A terminal interrupts the whole group.
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE)
    return process.returncode, said


# The search has begun after 2.5 s of work, and shares its work with other processes.
@pytest.mark.parametrize("seconds", [0.0, 2.5])
def test_a_demonstration_says_what_it_leaves_and_can_be_run_again(
    tmp_path: Path, seconds: float
) -> None:
    status, said = interrupted(tmp_path, ["demo-discrepancy"], seconds)
    assert status == 130
    assert said == "interrupted; discrepancy holds rig.csv, rig.yaml, model.yaml\n"
    write_rig(tmp_path / "discrepancy", Hidden.CREEP, 1)


def test_a_diagnosis_says_that_it_wrote_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "discrepancy"
    folder.mkdir()
    write_rig(folder, Hidden.CREEP, 1, 0.02)
    status, said = interrupted(
        tmp_path,
        ["diagnose", str(folder / "rig.csv"), "--model", str(folder / "model.yaml"),
         "--report", "found.html"],
        2.5,
    )  # fmt: skip
    assert (status, said) == (130, "interrupted; wrote nothing\n")
    assert not (tmp_path / "found.html").exists()


def struck_in_c() -> None:
    """Be interrupted where C calls Python, and makes of it what CPython does."""
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException as struck:
        # Objects/call.c, _Py_CheckFunctionResult.
        said = "returned a result with an exception set"
        raise SystemError(said) from struck


def test_an_interrupt_that_comes_out_of_c_as_another_error_is_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(typer.Exit) as left, interruptible(lambda: "wrote nothing"):
        struck_in_c()
    assert left.value.exit_code == 130
    assert capsys.readouterr().err == "interrupted; wrote nothing\n"


class Swallowing:
    """What is raised while it is taken away comes out nowhere."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


def test_an_interrupt_that_is_swallowed_comes_again(
    capsys: pytest.CaptureFixture[str],
) -> None:
    done = []

    def work() -> None:
        Swallowing()
        time.sleep(200 * AGAIN)
        done.append("all of it")

    with pytest.raises(typer.Exit) as left, interruptible(lambda: "wrote nothing"):
        work()
    assert left.value.exit_code == 130
    assert capsys.readouterr().err == "interrupted; wrote nothing\n"
    assert not done


def test_nothing_comes_again_once_the_work_is_done() -> None:
    def handlers() -> tuple[object, ...]:
        numbers = (signal.SIGINT, signal.SIGALRM)
        return (*map(signal.getsignal, numbers), sys.unraisablehook)

    before = handlers()
    with pytest.raises(typer.Exit), interruptible(lambda: "wrote all of it"):
        Swallowing()
    time.sleep(2 * AGAIN)
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert handlers() == before


def test_an_error_that_nobody_asked_for_goes_on() -> None:
    with pytest.raises(SystemError), interruptible(lambda: "wrote nothing"):
        raise SystemError


# A dataclass is made by a string that is run: Ctrl-C may strike it at any import.
STRING = """
import signal, sys, typer
from gripperd.cli.interrupt import interruptible
try:
    with interruptible(lambda: "wrote nothing"):
        exec("signal.raise_signal(signal.SIGINT)")
except typer.Exit as left:
    sys.exit(left.exit_code)
"""


def test_a_string_that_is_interrupted_leaves_the_status(tmp_path: Path) -> None:
    (tmp_path / "made.py").write_text(STRING)
    # As a module, as `python -m gripperd` is: of a script Python keeps no such account.
    ended = subprocess.run([sys.executable, "-m", "made"], cwd=tmp_path, check=False)
    assert ended.returncode == 130


def test_no_report_is_left_beside_the_recording_of_another_rig(tmp_path: Path) -> None:
    write_rig(tmp_path, Hidden.CREEP, 1, 0.5)
    for name in REPORT:
        (tmp_path / name).write_text("of the first")
    write_rig(tmp_path, Hidden.THRESHOLD, 2, 0.5)
    assert not any((tmp_path / name).exists() for name in REPORT)
