"""The rig's recording and the drawing's model, as files like anybody's."""

import csv
from math import degrees
from pathlib import Path

import numpy as np
import yaml

from gripperd.demo.programme import PAUSE, programmes
from gripperd.demo.rig import ANGLE, CURRENT, DIAMETER, LENGTH, PRESSURE, Hidden, Rig
from gripperd.units import KILO, MILLI

STEP = 0.15
"""Time between samples; gives about 2500 rows. [s]"""
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
    OSError
        It cannot be written.
    """
    draws = np.random.default_rng(seed)
    rig = Rig.built(hidden, draws)
    kinds: dict[str, dict[str, str]] = {}
    start = 0.0
    with (folder / "rig.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        for programme in programmes(step):
            said = rig.run(programme, draws)
            kinds[programme.name] = {"kind": programme.kind}
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
    _write_yaml(folder / "rig.yaml", {"rig": "demonstration", "runs": kinds})
    _write_yaml(folder / "model.yaml", _model())


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


def _write_yaml(path: Path, content: dict[str, object]) -> None:
    text = yaml.safe_dump(content, sort_keys=False, default_flow_style=None)
    path.write_text(text, encoding="utf-8")
