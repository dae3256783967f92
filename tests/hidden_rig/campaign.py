"""A day at the rig: the sweeps one after the other, and the air around them."""

from dataclasses import dataclass

import numpy as np

from tests.hidden_rig.course import STEP, Array, Course
from tests.hidden_rig.hidden import Hidden
from tests.hidden_rig.protocol import Sweep


@dataclass(frozen=True)
class Weather:
    """What surrounds the rig that day."""

    warming: float
    """Of the muscle, over the day. [K]"""
    warm_up: float
    """Time constant of it. [s]"""
    ambient: float
    """At the start. [Pa]"""
    sessions: tuple[float, ...]
    """How much the ambient pressure differs in each third, of the largest change."""


def weather(random: np.random.Generator) -> Weather:
    """Draw a day."""
    rest = float(random.uniform(0.4, 0.9))
    return Weather(
        warming=float(random.uniform(6, 14)),
        warm_up=float(random.uniform(300, 900)),
        ambient=float(random.uniform(99e3, 102.5e3)),
        sessions=(0.0, 1.0, rest - 1.0),
    )


def campaign(sweeps: list[Sweep], rests: Array, day: Weather, hidden: Hidden) -> Course:
    """Lay the sweeps end to end with a rest before each but the first."""
    clocks, columns, numbers, starts = [], [], [], []
    now = 0.0
    for number, (sweep, rest) in enumerate(zip(sweeps, rests, strict=True)):
        now += rest if number else 0.0
        since = np.arange(0.0, sweep.time[-1] + STEP / 2, STEP)
        clocks.append(now + since)
        numbers.append(np.full(since.size, number))
        starts.append(np.arange(since.size) == 0)
        columns.append(_columns(sweep, since))
        now += since[-1]
    clock = np.concatenate(clocks)
    pressure, length, size, stiffness = np.concatenate(columns, axis=1)
    third = np.minimum((3 * clock / clock[-1]).astype(int), 2)
    swing = np.array(day.sessions)[third]
    warmth = 1 - np.exp(-clock / day.warm_up)
    supply = 620e3 + _compressor(clock)
    if hidden.supply_saturation:
        # Held up by a large tank, but too low.
        top = pressure.max() * 1e3 * (1 - hidden.supply_saturation)
        supply = np.full(clock.size, top + 15e3)
    return Course(
        clock=clock,
        starts=np.concatenate(starts),
        run=np.concatenate(numbers),
        current=4.0 + 16.0 * pressure / 500.0,
        contraction=length,
        object_size=size,
        object_stiffness=stiffness,
        temperature=20.0 + day.warming * warmth / warmth[-1],
        supply=supply,
        ambient=day.ambient + hidden.ambient_pressure * swing,
    )


def _columns(sweep: Sweep, since: Array) -> Array:
    constant = (sweep.object_size, sweep.object_stiffness)
    return np.stack(
        [
            sweep.pressure_at(since),
            sweep.contraction_at(since),
            *(np.full(since.size, value) for value in constant),
        ]
    )


def _compressor(clock: Array) -> Array:
    """Cut in and out: a sawtooth between 600 and 640 kPa. [Pa]."""
    phase = clock / 37.0 % 1.0
    tooth: Array = np.where(phase < 0.2, phase / 0.2, (1 - phase) / 0.8)
    return 20e3 * (2 * tooth - 1)
