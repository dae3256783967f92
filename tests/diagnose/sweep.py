"""Sweeps of a muscle that nobody modelled: smooth curves plus noise."""

import numpy as np

from gripperd.diagnose.readings.recording import Kind, Run
from gripperd.model.track import Array

SEED = 20240229


def run(name: str = "a", kind: Kind | None = None, **columns: Array) -> Run:
    """A run from its columns in SI; ten samples a second unless it has a time."""
    size = next(iter(columns.values())).size
    columns.setdefault("time", np.linspace(0.0, 0.1 * (size - 1), size))
    return Run(name, columns, kind)


def triangle(size: int = 400, low: float = 50e3, high: float = 500e3) -> Array:
    """Pressure up and down once. [Pa]"""
    return low + (high - low) * (1.0 - np.abs(np.linspace(-1.0, 1.0, size)))


def noise(size: int, std: float, seed: int = SEED, memory: float = 0.0) -> Array:
    """First-order autoregressive noise of this standard deviation."""
    fresh = np.random.default_rng(seed).normal(0.0, std, size)
    values = fresh.copy()
    for index in range(1, size):
        values[index] = memory * values[index - 1] + fresh[index] * np.sqrt(
            1 - memory**2
        )
    return values


def pulled(
    name: str = "a",
    *,
    contraction: float = 0.1,
    gain: float = 1.0,
    seed: int = SEED,
    step: float = 0.0,
) -> Run:
    """An isometric inflation and deflation: 0.4 % noise, force 2 N/kPa."""
    pressure = triangle()
    force = gain * 2e-3 * pressure - 1000 * contraction
    measured = force + noise(pressure.size, 4.0, seed)
    if step:
        measured = np.round(measured / step) * step
    return run(
        name,
        pressure=pressure + noise(pressure.size, 1.5e3, seed + 1),
        contraction=np.full(pressure.size, contraction),
        force=measured,
    )
