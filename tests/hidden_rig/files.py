"""The four files of a case."""

import json
from pathlib import Path

import numpy as np
import yaml

from tests.hidden_rig.measurement import DIGITS, Readings
from tests.hidden_rig.protocol import Sweep
from tests.hidden_rig.rig import Rig

UNITS = {
    "muscle": {
        "rest_length": ("rest_length_mm", 1e3),
        "diameter": ("diameter_mm", 1e3),
        "braid_angle": ("braid_angle_deg", 180 / np.pi),
        "wall": ("wall_thickness_mm", 1e3),
        "modulus": ("elastic_modulus_MPa", 1e-6),
        "friction": ("friction_coefficient", 1.0),
    },
    "gripper": {
        "open_width": ("open_width_mm", 1e3),
        "ratio": ("width_per_contraction", 1.0),
        "preload": ("spring_preload_N", 1.0),
        "spring_rate": ("spring_rate_N_per_mm", 1e-3),
    },
}
"""Section of the model file: constant of the rig: its key there and its scale."""


def write_recording(path: Path, readings: Readings, sweeps: list[Sweep]) -> Path:
    """Write the readings; an empty cell where nothing was measured."""
    texts = [
        ["" if v != v else f"{v:.{digits}f}" for v in readings.columns[name].tolist()]
        for name, digits in DIGITS.items()
    ]
    runs = [sweeps[number].name for number in readings.run.tolist()]
    lines = [",".join(["run", *DIGITS])]
    lines += map(",".join, zip(runs, *texts, strict=True))
    path.write_text("\n".join(lines) + "\n")
    return path


def write_side_file(
    path: Path, sweeps: list[Sweep], notes: str, noise: dict[str, float]
) -> Path:
    """Write what the experimenter would note down."""
    side: dict[str, object] = {
        "rig": "bench 2",
        "muscle_serial": "H-20-250",
        "notes": notes,
        "runs": {sweep.name: {"kind": sweep.kind} for sweep in sweeps},
    }
    if noise:
        side["noise"] = {name: float(f"{std:.4g}") for name, std in noise.items()}
    path.write_text(yaml.safe_dump(side, sort_keys=False))
    return path


def write_model(path: Path, effects: list[str], tolerance: float | None) -> Path:
    """Write the constants as drawn, with one relative tolerance (1 sigma) or none."""
    drawn = Rig()._asdict()

    def number(value: float) -> float | dict[str, float]:
        value = float(f"{value:.6g}")
        if tolerance is None:
            return value
        return {"value": value, "tolerance": float(f"{value * tolerance:.4g}")}

    model: dict[str, object] = {"name": "as-drawn"}
    for section, keys in UNITS.items():
        model[section] = {
            key: number(drawn[constant] * scale)
            for constant, (key, scale) in keys.items()
        }
    span = number(drawn["pressure_span"] / 1e3)
    model["valve"] = {"current_mA": [4, 20], "pressure_kPa": [0, span]}
    model["effects"] = effects
    path.write_text(yaml.safe_dump(model, sort_keys=False))
    return path


def write_truth(path: Path, truth: dict[str, object]) -> Path:
    """Write what the rig hides."""
    path.write_text(json.dumps(truth, indent=1) + "\n")
    return path
