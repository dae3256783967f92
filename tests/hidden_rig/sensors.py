"""What the instruments make of the truth: their own faults, noise and drift."""

from dataclasses import dataclass

import numpy as np

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import Array, Course, Response
from tests.hidden_rig.hidden import Hidden


def seen(
    course: Course, truth: Response, hidden: Hidden, family: str
) -> dict[str, Array]:
    """Give each column as its sensor would show it without noise, every step."""
    pressure = truth.pressure / 1e3
    if hidden.ambient_pressure:
        # An absolute transducer, its tare taken at the start.
        pressure = pressure + (course.ambient - course.ambient[0]) / 1e3
    pressure = pressure * (1 + hidden.pressure_sensor_gain)
    force = truth.force * (1 + hidden.force_sensor_gain)
    share = course.clock / course.clock[-1]
    # A: nearly straight. B: warms up.
    course_of_drift = (
        0.8 * share + 0.2 * share**2
        if family == "A"
        else (1 - np.exp(-share / 0.4)) / (1 - np.exp(-2.5))
    )
    force = force + hidden.force_sensor_bias
    force = force + hidden.force_sensor_drift * course_of_drift
    force = force + hidden.mount_slip * (share > 0.55)
    held = ~np.isnan(course.contraction)
    return {
        "pressure_kPa": pressure + hidden.pressure_sensor_bias / 1e3,
        "contraction": truth.contraction + hidden.length_datum,
        "force_N": force,
        "opening_mm": np.where(held, np.nan, truth.opening * 1e3),
        "grip_N": np.where(held, np.nan, truth.grip),
    }


def late(course: Course, column: Array, delay: float) -> Array:
    """Give a column as sampled ``delay`` seconds too late, run by run."""
    if delay == 0:
        return column
    first = course.clock[np.flatnonzero(course.starts)][course.run]
    told = np.maximum(course.clock - delay, first)
    out: Array = np.interp(told, course.clock, column)
    return out


@dataclass(frozen=True)
class Noise:
    """Of one column, in its unit."""

    std: float
    correlation: float
    drift_std: float = 0.0
    drift_kind: str = "none"
    drift_memory: float = 60.0


def noise(size: int, model: Noise, random: np.random.Generator) -> Array:
    """First-order autoregressive noise of that standard deviation."""
    fresh = random.normal(0, 1, size)
    fresh[1:] *= np.sqrt(1 - model.correlation**2)
    out: Array = model.std * _remembered(fresh, model.correlation)
    return out


@compiled
def _remembered(fresh: Array, kept: float) -> Array:
    """Sum of what comes and what is kept of what was, sample by sample."""
    out = fresh.copy()
    for i in range(1, out.size):
        out[i] += kept * out[i - 1]
    return out


def drift(clock: Array, model: Noise, random: np.random.Generator) -> Array:
    """Slow wandering over the clock, of that standard deviation."""
    if model.drift_kind == "none":
        return np.zeros(clock.size)
    if model.drift_kind == "sinusoid":
        phase = random.uniform(0, 2 * np.pi)
        angle = 2 * np.pi * clock / (2 * model.drift_memory) + phase
        wave: Array = model.drift_std * 2**0.5 * np.sin(angle)
        return wave
    grid = np.arange(0.0, clock[-1] + 2.0)
    kept = float(np.exp(-1 / model.drift_memory)) if model.drift_kind == "ou" else 1.0
    path = _remembered(random.normal(0, 1, grid.size), kept)
    path -= path.mean()
    out: Array = np.interp(clock, grid, path * model.drift_std / path.std())
    return out
