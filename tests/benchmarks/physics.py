"""Predictions: one at a time, and a million at once."""

import math
from math import cos, pi, sin, tan

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from gripperd.config import reference_chain
from tests.benchmarks.sample import median, repeated

LENGTH, DIAMETER, ANGLE, WALL = 0.25, 0.02, math.radians(25), 0.002
MODULUS, FRICTION = 1.3e6, 0.002
POINTS = 1_000_000
CALLS = 10_000


def textbook_scalar(p: float, h: float) -> float:
    """Eq. (7), contracting, as anybody would write it down with `math`."""
    theta = math.acos((1 - h) * cos(ANGLE))
    s = sin(theta) / sin(ANGLE)
    ideal = (
        p
        * (pi * DIAMETER**2 / 4)
        * (3 * (1 - h) ** 2 / tan(ANGLE) ** 2 - 1 / sin(ANGLE) ** 2)
    )
    rubber = (
        MODULUS
        * WALL
        * pi
        * DIAMETER
        * ((1 - h) ** 2 / tan(ANGLE) ** 2 * (1 - 1 / s) + h * s)
    )
    hoop = 2 * MODULUS * WALL
    friction = FRICTION * pi * LENGTH * (1 - h) * ((p * DIAMETER - hoop) * s + hoop)
    return ideal - rubber - max(friction, 0.0)


def textbook_numpy(
    p: NDArray[np.float64], h: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Eq. (7), contracting, as anybody would write it down with numpy."""
    theta = np.arccos((1 - h) * np.cos(ANGLE))
    s = np.sin(theta) / np.sin(ANGLE)
    ideal = (
        p
        * (np.pi * DIAMETER**2 / 4)
        * (3 * (1 - h) ** 2 / np.tan(ANGLE) ** 2 - 1 / np.sin(ANGLE) ** 2)
    )
    rubber = (
        MODULUS
        * WALL
        * np.pi
        * DIAMETER
        * ((1 - h) ** 2 / np.tan(ANGLE) ** 2 * (1 - 1 / s) + h * s)
    )
    hoop = 2 * MODULUS * WALL
    friction = FRICTION * np.pi * LENGTH * (1 - h) * ((p * DIAMETER - hoop) * s + hoop)
    force: NDArray[np.float64] = ideal - rubber - np.maximum(friction, 0.0)
    return force


def table() -> Table:
    static = reference_chain().static
    rng = np.random.default_rng(1)
    p = rng.uniform(0, 500e3, POINTS)
    h = rng.uniform(-0.03, 0.25, POINTS)
    assert np.allclose(static.force(p, h), textbook_numpy(p, h), rtol=1e-9, atol=1e-6)

    ours = median(repeated(lambda: static.force(p, h), 9)) / POINTS
    numpys = median(repeated(lambda: textbook_numpy(p, h), 9)) / POINTS
    one = median(repeated(lambda: [static.force(2e5, 0.1) for _ in range(CALLS)], 9))
    bare = median(
        repeated(lambda: [textbook_scalar(2e5, 0.1) for _ in range(CALLS)], 9)
    )

    found = Table(
        "predicted force, eq. (7)", "per second", "yardstick", "ratio", "goal"
    )
    found.add_row(
        f"{POINTS:,} points",
        f"{1 / ours:,.0f}",
        f"bare numpy {1 / numpys:,.0f}",
        f"{ours / numpys:.2f}x the time",
        "<= 0.6x",
    )
    found.add_row(
        "one point",
        f"{CALLS / one:,.0f}",
        f"bare math {CALLS / bare:,.0f}",
        f"{one / bare:.2f}x the time",
        "<= 5x",
    )
    return found
