"""The rig's recording and the drawing's model, as files like anybody's."""

import csv
from math import degrees
from pathlib import Path

import numpy as np
import yaml

from gripperd.demo.hidden import Hidden
from gripperd.demo.programme import PAUSE, programmes
from gripperd.demo.rig import ANGLE, CURRENT, DIAMETER, LENGTH, PRESSURE, Rig
from gripperd.errors import InputError
from gripperd.units import KILO, MILLI

STEP = 0.15
"""Time between samples; gives about 2500 rows. [s]"""
FILES = ("rig.csv", "rig.yaml", "model.yaml", "report.html", "diagnosis.json")
"""Everything that a demonstration writes beside its versions."""
HEADER = ("run", "t_s", "current_mA", "pressure_kPa", "contraction", "force_N")


def write_rig(folder: Path, hidden: Hidden, seed: int, step: float = STEP) -> None:
    """Write ``rig.csv`` with its side file, and ``model.yaml``.

    Parameters
    ----------
    folder
        Where to; it exists.
    hidden
        What the rig hides from the model.
    seed
        Of the muscle as built and of the noise.
    step
        Time between samples. [s]

    Raises
    ------
    InputError
        A file that would be replaced is not of an earlier demonstration.
    OSError
        It cannot be written.
    """
    _check_folder(folder)
    # No report of an earlier demonstration stands beside the recording of this one.
    for name in FILES:
        (folder / name).unlink(missing_ok=True)
    # Before the recording, so that what an interruption leaves is known again.
    for name, text in _same_always().items():
        (folder / name).write_bytes(text)
    draws = np.random.default_rng(seed)
    rig = Rig.built(hidden, draws)
    start = 0.0
    with (folder / "rig.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        for programme in programmes(step):
            said = rig.run(programme, draws)
            columns = (
                start + said.time,
                said.current / MILLI,
                said.pressure / KILO,
                said.contraction,
                said.force,
            )
            for row in zip(*(column.tolist() for column in columns), strict=True):
                writer.writerow((programme.name, *(f"{value:.6g}" for value in row)))
            start += float(said.time[-1]) + PAUSE


def _check_folder(folder: Path) -> None:
    """Refuse to replace a file of somebody's own."""
    there = [name for name in FILES if (folder / name).exists()]
    for name, text in _same_always().items():
        place = folder / name
        if there and not (place.exists() and place.read_bytes() == text):
            own = place if place.exists() else folder / there[0]
            message = (
                f"{own}: is of no earlier demonstration and would be replaced;"
                " name another folder for --out"
            )
            raise InputError(message, key="--out")


def _same_always() -> dict[str, bytes]:
    """Content of the files that are the same whatever is hidden, by name."""
    kinds = {one.name: {"kind": one.kind} for one in programmes(STEP)}
    side: dict[str, object] = {"rig": "demonstration", "runs": kinds}
    return {"rig.yaml": _yaml(side), "model.yaml": _yaml(_model())}


def _model() -> dict[str, object]:
    """The muscle as drawn, without any effect."""
    return {
        "name": "as-drawn",
        "muscle": {
            "rest_length_mm": LENGTH / MILLI,
            "diameter_mm": DIAMETER / MILLI,
            "braid_angle_deg": round(degrees(ANGLE), 9),
            "wall_thickness_mm": 2.0,
            "elastic_modulus_MPa": 1.3,
            "friction_coefficient": 0.002,
        },
        "valve": {
            "current_mA": [end / MILLI for end in CURRENT],
            "pressure_kPa": [end / KILO for end in PRESSURE],
        },
        "effects": [],
    }


def _yaml(content: dict[str, object]) -> bytes:
    text = yaml.safe_dump(content, sort_keys=False, default_flow_style=None)
    return text.encode()
