"""From the truth at every step to the sheet of readings that a person gets."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.hidden_rig.course import Array, Course
from tests.hidden_rig.sensors import Noise, drift, late, noise
from tests.hidden_rig.truth import full_scale

MOST_ROWS = 12_000

DIGITS = {
    "t_s": 3,
    "current_mA": 4,
    "pressure_kPa": 3,
    "contraction": 6,
    "force_N": 3,
    "opening_mm": 3,
    "grip_N": 3,
    "object_mm": 1,
    "temperature_C": 2,
    "supply_kPa": 1,
    "ambient_kPa": 2,
}
"""Decimals of each column, in the order of the sheet."""


@dataclass(frozen=True)
class Readings:
    """One array a column, the number of the run, and what the noise truly was."""

    run: NDArray[np.int64]
    columns: dict[str, Array]
    noises: dict[str, Noise]


def instruments(
    columns: dict[str, Array], drifts: bool, random: np.random.Generator
) -> dict[str, Noise]:
    """Draw the noise of each sensor; force and pressure may drift."""
    noises = {}
    for name, values in columns.items():
        scale = full_scale(name, values)
        std = float(random.uniform(0.002, 0.006)) * scale
        if name == "contraction":
            std = _of_length(float(random.random())) * scale
        if name == "opening_mm":
            std = 0.1
        wanders = drifts and name in ("force_N", "pressure_kPa")
        noises[name] = Noise(
            std=std,
            correlation=float(random.uniform(0, 0.6)),
            drift_std=float(random.uniform(0.001, 0.002)) * scale if wanders else 0.0,
            drift_kind=str(random.choice(["ou", "walk", "sinusoid"])),
            drift_memory=float(random.uniform(20, 200)),
        )
    return noises


def _of_length(place: float) -> float:
    """Noise of a contraction, of full scale: half of the rigs have an encoder."""
    encoder, potentiometer = (0.0005, 0.001), (0.002, 0.006)
    ends = encoder if place < 0.5 else potentiometer
    return float(np.interp(2 * place % 1.0, (0.0, 1.0), ends))


def measured(
    course: Course,
    columns: dict[str, Array],
    artefacts: tuple[str, ...],
    drifts: bool,
    random: np.random.Generator,
) -> Readings:
    """Sample, add noise, and spoil what an artefact spoils."""
    if "offset_80ms" in artefacts:
        shifted = late(course, columns["force_N"], 0.08)
        columns = {**columns, "force_N": shifted}
    noises = instruments(columns, drifts, random)
    kept = _sampling(course, random)
    clock = course.clock[kept]
    read = {}
    for name, model in noises.items():
        values = columns[name][kept] + noise(clock.size, model, random)
        values = values + drift(clock, model, random)
        if name == "force_N" and "slack_clipped" in artefacts:
            values = np.maximum(values, 0.0)
        if "quantised_8bit" in artefacts:
            lsb = full_scale(name, values) / 255
            values = np.round(values / lsb) * lsb
        read[name] = values
    read["t_s"] = clock
    read["current_mA"] = course.current[kept]
    read["object_mm"] = course.object_size[kept] * 1e3
    read["temperature_C"] = course.temperature[kept] + _small(clock, 0.05, random)
    read["supply_kPa"] = course.supply[kept] / 1e3 + _small(clock, 0.3, random)
    read["ambient_kPa"] = course.ambient[kept] / 1e3 + _small(clock, 0.02, random)
    return Readings(course.run[kept], {name: read[name] for name in DIGITS}, noises)


def _small(clock: Array, std: float, random: np.random.Generator) -> Array:
    return random.normal(0.0, std, clock.size)


def _sampling(course: Course, random: np.random.Generator) -> NDArray[np.int64]:
    """Steps that are sampled: 10 to 20 a second, each run from its start."""
    first = np.flatnonzero(course.starts)[course.run]
    since = np.arange(course.clock.size) - first
    strides = [s for s in (5, 8, 10) if (since % s == 0).sum() <= MOST_ROWS] or [10]
    stride = int(random.choice(strides))
    return np.flatnonzero(since % stride == 0)
