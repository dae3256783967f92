"""From a kind of case to what the rig hides, and how strongly."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.hidden_rig.campaign import Weather, campaign
from tests.hidden_rig.course import Array, Course
from tests.hidden_rig.hidden import PLACES, TEXTBOOK, Hidden
from tests.hidden_rig.plant import LAWS, World, march
from tests.hidden_rig.protocol import Sweep
from tests.hidden_rig.rig import Rig
from tests.hidden_rig.sensors import late, seen

PEAK = 95.0
"""Percentile that counts as the peak: the few steps of a jump do not."""


@dataclass(frozen=True)
class Change:
    """What an effect does to its signal, as a fraction of full scale."""

    run: NDArray[np.int64]
    values: Array

    @property
    def peak(self) -> float:
        """The size reached, but seldom exceeded, in the run that shows it most."""
        sizes = np.abs(self.values)
        runs = [sizes[self.run == number] for number in np.unique(self.run)]
        seen_in = [run for run in runs if not np.isnan(run).all()]
        return max(float(np.nanpercentile(run, PEAK)) for run in seen_in)

    @property
    def rms(self) -> float:
        """Over the whole recording."""
        return float(np.sqrt(np.nanmean(self.values**2)))


@dataclass(frozen=True)
class Bench:
    """All of a case but what it hides."""

    family: str
    rig: Rig
    sweeps: list[Sweep]
    rests: Array
    day: Weather
    late: str
    """The channel that a delay would strike."""

    def run(self, hidden: Hidden) -> tuple[Course, dict[str, Array]]:
        """Give the course and each column without noise, every step."""
        # One machine code for all: a whole number would call for another.
        hidden = Hidden(*map(float, hidden))
        course = campaign(self.sweeps, self.rests, self.day, hidden)
        truth = march(World(LAWS[self.family], self.rig, hidden, course))
        columns = seen(course, truth, hidden, self.family)
        columns[self.late] = late(course, columns[self.late], hidden.channel_delay)
        return course, columns

    def signal(self, name: str) -> str:
        """Name the column in which an effect shows."""
        return self.late if name == "channel_delay" else PLACES[name].signal

    def change(self, hidden: Hidden, name: str) -> Change:
        """Compare the rig with and without one of its effects."""
        without = hidden._replace(**{name: -1.0 if name in TEXTBOOK else 0.0})
        column = self.signal(name)
        course, columns = self.run(hidden)
        plain = self.run(without)[1][column]
        return Change(course.run, (columns[column] - plain) / full_scale(column, plain))


def full_scale(column: str, values: Array) -> float:
    """Largest value of a column; a contraction counts to 0.25."""
    return 0.25 if column == "contraction" else float(np.nanmax(np.abs(values)))


def hide(
    bench: Bench, strengths: dict[str, float], random: np.random.Generator
) -> Hidden:
    """Choose amounts so that each effect alone has the peak asked of it."""
    hidden = Hidden()
    for name, strength in strengths.items():
        amount = _amount(bench, name, strength, float(random.choice([-1, 1])))
        hidden = hidden._replace(**{name: amount})
    return hidden


def _amount(bench: Bench, name: str, strength: float, sign: float) -> float:
    if name in TEXTBOOK:
        return 0.0 if bench.family == "A" else 1.0
    sign = sign if name in SIGNED else 1.0
    size, last, gave = PLACES[name].trial, 0.0, 0.0
    for _ in range(8):
        hidden = Hidden()._replace(**{name: sign * size})
        reached = bench.change(hidden, name).peak
        if abs(reached / strength - 1) < 0.03:
            break
        # Secant, held within a factor of 5.
        slope = max((reached - gave) / (size - last), 1e-12)
        last, gave = size, reached
        size = min(max(size + (strength - reached) / slope, 0.2 * size), 5 * size)
    return sign * size


SIGNED = frozenset(
    {
        "valve_offset",
        "valve_gain",
        "valve_nonlinearity",
        "pressure_sensor_bias",
        "pressure_sensor_gain",
        "force_sensor_bias",
        "force_sensor_gain",
        "force_sensor_drift",
        "length_datum",
        "ambient_pressure",
        "nonlinear_elasticity",
        "temperature_stiffness",
        "mount_slip",
        "local_bump",
    }
)
