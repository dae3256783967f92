"""What a diagnosis takes, as a whole process, and how that grows with the rows.

A recording of the hidden rig is resampled to the rows asked for, each sweep alike.
"""

import csv
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.table import Table

from gripperd.config import load_model
from gripperd.diagnose.diagnosis import diagnose
from gripperd.effects import EFFECTS
from gripperd.recordings import read_recording
from tests.benchmarks.sample import median
from tests.exam.peers.baseline import baseline
from tests.exam.peers.exhibit import shown
from tests.hidden_rig import make_case

ROWS = 12_000
GROWTH = (10_000, 100_000, 1_000_000)
TIMES = 3
SEED = 5
KIB_PER_MIB = 1024
NOISE = 2e-3
"""Of what is resampled, of the largest reading of each column. [-]"""


def resampled(recording: Path, rows: int, target: Path) -> None:
    """Write the same sweeps with other rows between, and noise of their own."""
    with recording.open(newline="") as file:
        header, *lines = list(csv.reader(file))
    names = np.array([line[0] for line in lines])
    values = np.array(
        [[float(cell or "nan") for cell in line[1:]] for line in lines], np.float64
    )
    random = np.random.default_rng(SEED)
    with target.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        for name in dict.fromkeys(names.tolist()):
            sweep = values[names == name]
            size = max(2, round(rows * len(sweep) / len(values)))
            writer.writerows(
                [name, *("" if np.isnan(cell) else f"{cell:.7g}" for cell in row)]
                for row in _between(sweep, size, values, random)
            )


def _between(
    sweep: np.ndarray, size: int, every: np.ndarray, random: np.random.Generator
) -> Iterator[list[float]]:
    places = np.linspace(0, len(sweep) - 1, size)
    known = np.arange(len(sweep))
    columns = []
    for index in range(sweep.shape[1]):
        column = np.interp(places, known, sweep[:, index])
        loud = NOISE * np.nanmax(np.abs(every[:, index])) if index > 1 else 0.0
        columns.append(column + random.normal(0.0, loud or 0.0, size))
    yield from np.stack(columns, axis=1).tolist()


def whole(recording: Path, model: Path) -> tuple[float, float]:
    """Seconds and MiB of ``gripperd diagnose``, from start to end."""
    since = time.perf_counter()
    command = ["-m", "gripperd", "diagnose", str(recording), "--model", str(model)]
    child = os.posix_spawn(
        sys.executable,
        [sys.executable, *command],
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
    )
    _, status, usage = os.wait4(child, 0)
    if status:
        message = f"gripperd {' '.join(command[2:])} ended with {status}"
        raise RuntimeError(message)
    return time.perf_counter() - since, usage.ru_maxrss / KIB_PER_MIB


def plain(recording: Path, model: Path) -> float:
    """Seconds of the plain baseline on the same rows, our front end not counted."""
    file = load_model(model)
    found = diagnose(
        read_recording(recording), file.explanation(), file.tolerances, EFFECTS
    )
    exhibit = shown(found, SEED)
    since = time.perf_counter()
    baseline(exhibit)
    return time.perf_counter() - since


def table() -> Table:
    result = Table("rows", "seconds", "MiB", "yardstick", title="Diagnosis, whole")
    with tempfile.TemporaryDirectory() as folder:
        case = make_case(
            Path(folder), seed=SEED, family="A", kind="single", names=("creep",)
        )
        model, source = case.model, case.recording
        target = Path(folder) / "rows.csv"
        resampled(source, ROWS, target)
        takes = [whole(target, model) for _ in range(TIMES)]
        yardstick = f"scipy fits ranked by BIC: {plain(target, model):.1f} s"
        result.add_row(
            f"{ROWS}",
            f"{median([seconds for seconds, _ in takes]):.1f}",
            f"{max(memory for _, memory in takes):.0f}",
            f"{yardstick}; goal 15 s, 700 MiB",
        )
        before = 0.0
        for rows in GROWTH:
            resampled(source, rows, target)
            seconds, memory = whole(target, model)
            ratio = f"{seconds / before:.1f}x for 10x; goal 12x" if before else ""
            result.add_row(f"{rows}", f"{seconds:.1f}", f"{memory:.0f}", ratio)
            before = seconds
    return result
