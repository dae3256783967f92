"""The whole rig as its wires see it: a valve current in, three sensor currents out."""

from collections import deque
from random import Random
from typing import NamedTuple

from gripperd.bench.active import ActiveEffects
from gripperd.bench.plant import Plant
from gripperd.bench.sensors import Channel, Sensors, SensorSettings
from gripperd.bench.settings import PlantSettings
from gripperd.model import Chain
from gripperd.model.effect import acts_in_sensor

STEP = 1e-3
"""Step of the plant. [s]"""

TRACE_STEPS = 10
"""Steps of motion between two samples of the trace."""

TRACE_LENGTH = 1000
"""Samples kept, 10 s of motion; a time at rest takes only one."""


class Sample(NamedTuple):
    """The plant at one time: true values, without noise. SI."""

    time: float
    current: float
    pressure: float
    opening: float
    grip: float


class Rig:
    """A plant with sensors, brought up to date whenever somebody looks.

    Time is that of the caller, counted from power-up. The rig does not run by itself:
    :meth:`advance` before each look or touch, those at the `plant` included.

    Parameters
    ----------
    chain
        The physics; of the effects in sensors, those count that there is a channel for.
    rng
        Where the sensor noise comes from.
    settings
        The dynamics, as shipped unless given.
    sensors
        Ranges and noise of the sensors, as shipped unless given.
    """

    def __init__(
        self,
        chain: Chain,
        rng: Random,
        *,
        settings: PlantSettings | None = None,
        sensors: SensorSettings | None = None,
    ) -> None:
        self.plant = Plant(chain, settings or PlantSettings())
        self.trace: deque[Sample] = deque(maxlen=TRACE_LENGTH)
        self._regulator = chain.regulator
        self._sensors = Sensors(sensors or SensorSettings(), rng)
        wrong = tuple(filter(acts_in_sensor, chain.effects))
        self._wrong = {
            channel: ActiveEffects(e for e in wrong if e.signal.value == channel.value)
            for channel in Channel
            if any(each.signal.value == channel.value for each in wrong)
        }
        self._shown = self._misread(0.0) if self._wrong else {}

    def advance(self, to: float) -> None:
        """Catch up with a time, in whole steps; a time already passed is no step. [s].

        What is left of a step is made up by the next call.
        """
        plant = self.plant
        # A part of a step is allowed for rounding, or every other step came late.
        due = int((to - plant.time) / STEP + 1e-3)
        while due > 0:
            steps = due if plant.at_rest else 1
            plant.step(steps * STEP)
            if self._wrong:
                self._shown = self._misread(steps * STEP)
            due -= steps
            if due % TRACE_STEPS == 0:
                self._record()

    def write_current(self, current: float) -> None:
        """Drive the valve. [A].

        Raises
        ------
        InputError
            When it is negative or not finite.
        """
        self.plant.current = current

    def read_inputs(self) -> tuple[float, float, float]:
        """Sample the sensors: pressure, opening, grip. [A, A, A]."""
        faults = self.plant.faults
        values = self._true() | self._shown
        return self._sensors.read(
            values,
            broken=faults.broken,
            shorted=faults.shorted,
            frozen=faults.frozen,
            spiking=faults.spiking,
        )

    def outlet_current(self) -> float:
        """Current that stands for the pressure at the regulator outlet. [A]."""
        return float(self._regulator.current(self.plant.outlet_pressure))

    def _true(self) -> dict[Channel, float]:
        plant = self.plant
        return {
            Channel.PRESSURE: plant.pressure,
            Channel.OPENING: plant.opening,
            Channel.GRIP: plant.grip,
        }

    def _misread(self, step: float) -> dict[Channel, float]:
        """What the sensors with effects show after a time step. [SI]."""
        now, true = self.plant.track(step), self._true()
        return {
            channel: effects.along(true[channel], now)
            for channel, effects in self._wrong.items()
        }

    def _record(self) -> None:
        plant = self.plant
        self.trace.append(
            Sample(plant.time, plant.current, plant.pressure, plant.opening, plant.grip)
        )
