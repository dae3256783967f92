"""Diagnoses of the demonstration's rig, each made once."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from gripperd.config import ModelFile, load_model
from gripperd.demo.files import write_rig
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.effects import EFFECTS
from gripperd.recordings import read_recording

STEP = 0.4
"""Time between samples; gives about 900 rows. [s]"""
SEED = 11


@cache
def example(hidden: Hidden) -> tuple[ModelFile, Diagnosis]:
    """Give the drawing's model and what is found of a rig that hides an effect."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_rig(folder, hidden, SEED, STEP)
        model = load_model(folder / "model.yaml")
        recording = read_recording(folder / "rig.csv")
    found = diagnose(recording, model.explanation(), model.tolerances, EFFECTS, SEED)
    return model, found
