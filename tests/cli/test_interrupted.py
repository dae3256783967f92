"""Ctrl-C in the middle of long work: what it says, and what it leaves."""

import os
import signal
import subprocess
from pathlib import Path

import pytest

from gripperd.demo.files import write_rig
from gripperd.demo.rig import Hidden
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


def test_no_report_is_left_beside_the_recording_of_another_rig(tmp_path: Path) -> None:
    write_rig(tmp_path, Hidden.CREEP, 1, 0.5)
    for name in REPORT:
        (tmp_path / name).write_text("of the first")
    write_rig(tmp_path, Hidden.THRESHOLD, 2, 0.5)
    assert not any((tmp_path / name).exists() for name in REPORT)
