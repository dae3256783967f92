"""Reading and diagnosing recordings, in a process of its own: it may take its time.

::

    python -m gripperd.service.worker read FILE
    python -m gripperd.service.worker diagnose FILE FOLDER SEED

It knows no HTTP. Each line it prints is a message of :mod:`gripperd.service.child`.
"""

import ctypes
import json
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from gripperd import __version__
from gripperd.config import load_model
from gripperd.config.durable import replace_file
from gripperd.diagnose.readings.columns import COLUMNS
from gripperd.diagnose.readings.recording import Recording
from gripperd.effects import EFFECTS
from gripperd.errors import GripperdError, InputError, Refused
from gripperd.link.frames import failed
from gripperd.recordings import read_recording
from gripperd.service.child import Broken, Judged, Progress, Read, say
from gripperd.store.diagnoses import (
    MODEL,
    REPORT,
    RESULT,
    Why,
    write_improvement,
)
from gripperd.store.recordings import Contents, RejectedSamples, RunContents
from gripperd.store.records import writing

if TYPE_CHECKING:
    from gripperd.diagnose.diagnosis import Diagnosis

NICENESS = 10
"""Below the service, which is below control."""
FIRST_TO_GO = "1000"
"""When memory runs out, the kernel ends this process first (proc_pid_oom_score_adj)."""
PR_SET_PDEATHSIG = 1
"""prctl(2): signal to get when the parent dies."""


def main(arguments: Sequence[str]) -> None:
    """Do one job, and say what came of it."""
    _step_back()
    # A broken pipe: the service is gone, and its next life does not ask for this.
    with suppress(BrokenPipeError):
        _work(arguments)


def _work(arguments: Sequence[str]) -> None:
    try:
        match arguments:
            case ["read", file]:
                say(Read(_contents(read_recording(Path(file)))))
            case ["diagnose", file, folder, seed]:
                say(_judged(Path(file), Path(folder), int(seed)))
            case _:
                message = f"{' '.join(arguments)} is no job"
                raise InputError(message)
    except GripperdError as error:
        say(Broken(failed(error)))


def _step_back() -> None:
    """Be in nobody's way, and end with the service."""
    os.nice(NICENESS)
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(FIRST_TO_GO, encoding="ascii")
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _contents(recording: Recording) -> Contents:
    measured = [
        name
        for name, column in COLUMNS.items()
        if column.quantity == "time" or recording.has(column.quantity)
    ]
    return Contents(
        name=recording.name,
        sha256=recording.digest,
        columns=tuple(measured),
        runs=tuple(
            RunContents(
                name=run.name,
                samples=len(run),
                duration_s=float(run.columns["time"][-1] - run.columns["time"][0]),
            )
            for run in recording.runs
        ),
        rejected_samples=tuple(
            RejectedSamples(
                run=one.run, column=one.column, count=one.count, reason=one.reason
            )
            for one in recording.rejected
        ),
        remarks=recording.remarks,
    )


def _judged(file: Path, folder: Path, seed: int) -> Judged:
    """Diagnose, and leave everything that can be asked for in a folder."""
    # Imported here: who only reads need not wait for all of this.
    from gripperd.diagnose.diagnosis import diagnose
    from gripperd.diagnose.document import document
    from gripperd.store.improvement import improvement

    model = load_model(folder / MODEL)
    say(Progress("reading", 0.0))
    found = diagnose(
        read_recording(file),
        model.explanation(),
        model.tolerances,
        EFFECTS,
        seed,
        lambda what, share: say(Progress(what, share)),
        len(os.sched_getaffinity(0)),
    )
    say(Progress("report", 0.95))
    said = document(found, model=model.name, program=__version__)
    text = json.dumps(said, ensure_ascii=False, allow_nan=False)
    with writing(folder):
        replace_file(folder / RESULT, f"{text}\n")
    unprinted = _print(found, model.name, folder)
    try:
        better = improvement(model, found, __version__)
    except Refused as error:
        objection = Why(code=error.code, message=str(error))
        return Judged(found.verdict, objection, unprinted)
    write_improvement(better.model, better.provenance, folder)
    return Judged(found.verdict, None, unprinted)


def _print(found: "Diagnosis", model: str, folder: Path) -> str | None:
    """Write the page, or say why there is none."""
    from gripperd.report import page

    try:
        html = page(found, model=model, program=__version__)
    except InputError as error:
        return str(error)
    with writing(folder):
        replace_file(folder / REPORT, html)
    return None


if __name__ == "__main__":
    main(sys.argv[1:])
