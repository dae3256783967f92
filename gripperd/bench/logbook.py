"""What the plant goes through, as effects want to know it."""

from math import nan
from typing import NamedTuple

import numpy as np

from gripperd.bench.settings import PlantSettings
from gripperd.model import Chain
from gripperd.model.track import Track

FILLED, VENTED = 0.5, 0.25
"""Shares of the highest pressure: an inflation ends below one, after the other."""


class Moment(NamedTuple):
    """One sample. SI values."""

    time: float
    step: float
    """Time since the sample before. [s]"""
    command: float
    """Gauge pressure the textbook regulator gives for the current. [Pa]"""
    pressure: float
    contraction: float
    rate: float
    """Of contraction. [1/s]"""
    direction: float
    force: float
    grip: float
    supply: float


class Logbook:
    """Turns moments into tracks of one sample; keeps count of what they leave out.

    Parameters
    ----------
    chain
        Whose muscle and regulator it is.
    settings
        What the surroundings are like.
    """

    __slots__ = (
        "_ambient", "_chain", "_command", "_cycle", "_filled", "_moved", "_supply",
    )  # fmt: skip

    def __init__(self, chain: Chain, settings: PlantSettings) -> None:
        self._chain = chain
        self._ambient = {
            "temperature": np.array([settings.temperature]),
            "ambient": np.array([settings.ambient_pressure]),
            "repeat": np.array([nan]),
        }
        self._supply = settings.supply_pressure
        self._command = nan
        self._moved = 0.0
        self._cycle = 0.0
        self._filled = False

    def track(self, moment: Moment) -> Track:
        """Note a moment and give it as a track."""
        if moment.command != self._command:
            self._command, self._moved = moment.command, moment.time
        regulator = self._chain.regulator
        self._count(moment.pressure / regulator.pressure_high)
        samples = {name: np.array([x]) for name, x in moment._asdict().items()}
        supply = samples.pop("supply")
        return Track(
            muscle=self._chain.muscle,
            span=(regulator.pressure_low, regulator.pressure_high),
            still=np.array([moment.time - self._moved]),
            came=np.array([nan]),
            waiting=np.array([moment.time - self._moved]),
            cycle=np.array([self._cycle]),
            supply_drop=np.maximum(self._supply - supply, 0.0),
            **samples,
            **self._ambient,
        )

    def _count(self, filling: float) -> None:
        if filling > FILLED:
            self._filled = True
        elif self._filled and filling < VENTED:
            self._filled = False
            self._cycle += 1
