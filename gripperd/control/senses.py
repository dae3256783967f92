"""Judges every sample once, before anything is decided on it.

A single spike is taken out, a gap of a sample or two is bridged, and a sensor that is
broken, stuck or full of spikes is not believed; the model replaces the force. What
comes out is what clients see.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from statistics import median
from types import MappingProxyType

from gripperd.control.frozen import Frozen
from gripperd.control.monitors.sight import Scatter
from gripperd.control.noise import Noise
from gripperd.control.spikes import MANY, WITHIN, Spikes
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement, Quality, Reading

WINDOW = 3
"""Samples whose median is taken: one lie among them does not count."""
BRIDGED = 2
"""Samples without a value that are bridged by the last one, 20 ms at 100 Hz."""
FROZEN_FOR = 0.2
"""A force sensor that says the same to the last digit for so long may be stuck. [s]"""
DOUBT = 10.0
"""And is, when the model differs by more: 4 sigma of the shipped reference. [N]"""
SPANS: Mapping[str, float] = MappingProxyType(
    {"pressure": 600e3, "opening": 0.1, "grip": 100.0}
)
"""Spans of the sensors of the shipped configuration. [SI]"""
LEAST_NOISE = 5e-4
"""Share of its span that a transmitter scatters by at least, one sigma. [-]"""
RESTED = 1.0
"""So long after the last change of the current nothing is meant to move. [s]"""


class Senses:
    """The sensors of one gripper, as far as they can be believed.

    Parameters
    ----------
    chain
        The model that stands in for the force sensor.
    spans
        Of each sensor, in SI, by its name in a measurement.
    """

    def __init__(self, chain: Chain, spans: Mapping[str, float] = SPANS) -> None:
        self._chain = chain
        # A stop needs the pressure of this moment: a median would be one sample late.
        self._pressure = _Channel(1, spans.get("pressure", SPANS["pressure"]))
        self._opening = _Channel(WINDOW, spans.get("opening", SPANS["opening"]))
        self._grip = _Channel(WINDOW, spans.get("grip", SPANS["grip"]))
        self._last: float | None = None
        self._frozen = 0.0
        self._current: float | None = None
        self._rested = 0.0

    def use(self, chain: Chain) -> None:
        """Go by another model; what was learned of the sensors stays."""
        self._chain = chain
        self._grip.forget()

    @property
    def scatter(self) -> Scatter:
        """How much each sensor scatters."""
        return Scatter(
            pressure=self._pressure.noise.sigma,
            opening=self._opening.noise.sigma,
            grip=self._grip.noise.sigma,
        )

    def judge(self, raw: Measurement, dt: float) -> Measurement:
        """The sample as it may be used.

        Parameters
        ----------
        raw
            What the modules said.
        dt
            Time since the last sample. [s]
        """
        resting = self._resting(raw, dt)
        believed = replace(
            raw,
            pressure=self._pressure.doubt(raw.pressure, dt, resting=resting),
            opening=self._opening.doubt(raw.opening, dt, resting=resting),
            grip=self._grip.doubt(raw.grip, dt, resting=resting),
        )
        # The model needs pressure and opening of the same moment, so before the median.
        force = grip_force(self._contradicted(believed, dt), self._chain)
        return replace(
            believed,
            pressure=self._pressure.judge(believed.pressure),
            opening=self._opening.judge(believed.opening),
            grip=replace(self._grip.judge(force), noise=self._grip.noise.sigma),
        )

    def _resting(self, raw: Measurement, dt: float) -> bool:
        """Whether nothing is meant to move."""
        changed = raw.current.value != self._current
        self._current = raw.current.value
        self._rested = 0.0 if changed else self._rested + dt
        return self._rested > RESTED

    def _contradicted(self, raw: Measurement, dt: float) -> Measurement:
        """The sample without the force sensor, if that is stuck.

        One that repeats itself may be at rest; if the model says that the jaws press
        all the same, it is stuck.
        """
        force, self._last = self._last, raw.grip.value
        same = force is not None and force == raw.grip.value
        self._frozen = self._frozen + dt if same else 0.0
        if force is None or self._frozen < FROZEN_FOR:
            return raw
        stuck = Reading.bad(f"stuck at {force:.2f} N for {self._frozen:.1f} s")
        blind = replace(raw, grip=stuck)
        modelled = grip_force(blind, self._chain).value
        doubtful = modelled is not None and abs(modelled - force) > DOUBT
        return blind if doubtful else raw


class _Channel:
    """One sensor over its last samples."""

    def __init__(self, window: int, span: float) -> None:
        self.noise = Noise(LEAST_NOISE * abs(span))
        self._values: deque[float] = deque(maxlen=window)
        self._frozen = Frozen()
        self._spikes = Spikes(span)
        self._gap = 0
        self._last = self._believed = Reading.bad("not measured yet")

    def doubt(self, reading: Reading, dt: float, *, resting: bool) -> Reading:
        """The reading, or why it is not believed although there is one.

        For a sample that leaps away the one before stands, until the next confirms it.
        """
        alone = self._spikes.update(reading.value, self.noise.sigma, dt)
        self.noise.update(None if alone else reading.value, dt)
        if self._frozen.update(reading.value, dt, resting=resting):
            return Reading.bad(f"stuck for {self._frozen.seconds:.1f} s on one value")
        if self._spikes.many:
            return Reading.bad(f"spikes: {MANY} or more within {WITHIN:g} s")
        if not alone:
            self._believed = reading
        return self._believed

    def forget(self) -> None:
        """Bridge nothing with the values so far."""
        self._values.clear()

    def judge(self, reading: Reading) -> Reading:
        if reading.value is not None:
            self._gap = 0
            self._values.append(reading.value)
            self._last = reading
        else:
            self._gap += 1
            if not self._values or self._gap > BRIDGED:
                self._values.clear()
                return reading
        return replace(self._last, value=median(self._values))


def grip_force(measured: Measurement, chain: Chain) -> Reading:
    """Grip force per jaw: measured, or computed from pressure and opening. [N]."""
    if measured.grip.value is not None:
        return measured.grip
    pressure, opening = measured.pressure.value, measured.opening.value
    if pressure is None or opening is None:
        return measured.grip
    try:
        force = float(chain.grip_at(pressure, opening))
    except DomainError as error:
        return Reading.bad(str(error))
    return Reading(max(force, 0.0), Quality.SUBSTITUTED, measured.grip.cause)
