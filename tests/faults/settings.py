"""Settings that are edited and read again while an egg is held."""

import os
import shutil
import signal
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from gripperd.config import shipped
from tests.daemon import until
from tests.faults.held import Held, held_egg
from tests.faults.row import Row

WITHIN = 2.0
"""Longest time to say something. [s]"""
SETTINGS, APPLE = "gripperd.yaml", "profiles/apple.yaml"


class Edit(NamedTuple):
    """Something that is replaced in a file."""

    name: str
    file: str
    old: str
    new: str


UNUSABLE = (
    Edit("not YAML", SETTINGS, "grippers:", "grippers: ["),
    Edit("unknown key", SETTINGS, "fail_mode:", "fial_mode:"),
    Edit("missing key", SETTINGS, "    model: ", "    # model: "),
    Edit("wrong type", SETTINGS, "rate_Hz: 100", "rate_Hz: fast"),
    Edit("wrong unit", APPLE, "mass_g: 180", "mass_kg: 0.18"),
    Edit("out of range", APPLE, "mass_g: 180", "mass_g: -180"),
    Edit("missing folder", SETTINGS, "profiles: profiles", "profiles: nowhere"),
)
RESTART = Edit("restart needed", SETTINGS, "rate_Hz: 100", "rate_Hz: 50")
AT_ONCE = Edit("profile", "profiles/raw_egg.yaml", "mass_g: 58", "mass_g: 60")


@contextmanager
def held_with_files() -> Iterator[Held]:
    """A daemon that holds an egg, and whose files may be edited."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(shipped("profiles"), folder / "profiles")
        with held_egg(folder) as held:
            yield held


@contextmanager
def edited(held: Held, edit: Edit) -> Iterator[Path]:
    """A file with something replaced; it is as it was afterwards."""
    path = held.folder / edit.file
    before = path.read_text()
    assert edit.old in before, f"{edit.file} has no {edit.old!r}"
    path.write_text(before.replace(edit.old, edit.new, 1))
    try:
        yield path
    finally:
        path.write_text(before)


def refused(held: Held, edit: Edit) -> Row:
    """Have an unusable file read."""
    wrong = set[str]()
    before = held.answer("/config"), held.answer("/profiles")
    with edited(held, edit) as path:
        start = time.monotonic()
        answer = held.http.post("/config/reload")
        took = time.monotonic() - start
        checked = held.http.post("/config/validate")
    said = answer.json()
    if (answer.status_code, said["code"]) != (422, "invalid"):
        wrong.add(f"{answer.status_code}")
    if f"{path}:" not in said["detail"] or checked.json()["detail"] != said["detail"]:
        wrong.add("no place is named")
    if (held.answer("/config"), held.answer("/profiles")) != before:
        wrong.add("something was changed")
    return _row(f"{edit.name}: reload", "422 with file and line", took, held, wrong)


def waiting(held: Held) -> Row:
    """Have a file read that only a start can take up."""
    wrong = set[str]()
    with edited(held, RESTART):
        start = time.monotonic()
        said = held.http.post("/config/reload").json()
        took = time.monotonic() - start
        target = held.answer("/info")["timing"]["g0"]["target_ms"]
    if (said["at_restart"], said["applied"]) != (["grippers.g0"], []):
        wrong.add(f"{said}")
    if target != 10.0:
        wrong.add("the loop runs otherwise")
    return _row("another rate: reload", "`at_restart` names it", took, held, wrong)


def taken_up(held: Held) -> Row:
    """Have another profile read of what is being held."""
    wrong = set[str]()
    start = time.monotonic()
    with edited(held, AT_ONCE):
        said = held.http.post("/config/reload").json()
        took = time.monotonic() - start
        mass = held.answer("/profiles/raw_egg")["mass_g"]
    if (said["applied"], mass) != (["profiles.raw_egg"], 60):
        wrong.add(f"{said}")
    held.http.post("/config/reload").raise_for_status()
    return _row("another egg profile: reload", "the next grasp's", took, held, wrong)


def hung_up(held: Held) -> Row:
    """Control is told to hang up with an unusable file: it ends, and cannot start."""
    wrong = set[str]()
    old = held.process("control")
    with edited(held, UNUSABLE[1]):
        start = time.monotonic()
        os.kill(old, signal.SIGHUP)
        held.since(start, lambda: not held.ready())
        took = time.monotonic() - start
        # It is started on the unusable file, and ends again.
        until(lambda: held.process("control") not in {0, old})
        until(lambda: not held.process("control"))
        if abs(held.answer("/bench")["force_N"] - held.force) > 0.02 * held.force:
            wrong.add("the force changed")
    held.since(start, lambda: held.process("control") not in {0, old} and held.ready())
    if not held.answer("/grippers/g0")["adopted"]:
        wrong.add("not adopted")
    return _row("SIGHUP to control, unusable", "not ready; adopted", took, held, wrong)


def _row(fault: str, noticed: str, took: float, held: Held, wrong: set[str]) -> Row:
    told = tuple(sorted(wrong | held.wrong()))
    return Row(fault=fault, noticed=noticed, took=(took,), limit=WITHIN, wrong=told)


def rows() -> Iterator[Row]:
    """Every edit while the egg is held."""
    with held_with_files() as held:
        for edit in UNUSABLE:
            yield refused(held, edit)
        yield waiting(held)
        yield taken_up(held)
        yield hung_up(held)
