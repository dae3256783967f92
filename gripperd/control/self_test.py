"""A self-test: a small step of the pressure that does not move the jaws."""

from statistics import fmean, stdev

from gripperd.control.command import Failure
from gripperd.control.ending import Ending
from gripperd.control.release import RATE
from gripperd.control.setpoint import Ramp
from gripperd.control.states import Grip
from gripperd.control.task import Checked
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement
from gripperd.units import KILO

SHARE = 0.6
"""Of the pressure at which the open jaws begin to move. [-]"""
SETTLE, WATCH = 0.6, 1.0
"""Until the pressure is there or gone; how long it is watched between. [s]"""
VALVE_ERROR = 10e3
"""2 % of a span of 500 kPa, twice the linearity that makers of E/P regulators state
together with their hysteresis. [Pa]"""
SLOWEST_RISE = 0.25
"""More than twice the 60 to 110 ms that were measured on a 10 mm muscle. [s]"""
FALL = 1e3
"""Fall of the pressure in a second that tells of a leak. [Pa/s]"""
RISE = 0.632
"""Share of a step that a lag has made after its time constant. [-]"""


class Trial:
    """From the step to the report; afterwards the current is as it was.

    Parameters
    ----------
    chain
        The model of the gripper.
    current
        Valve current at the start, the muscle vented. [A]
    """

    def __init__(self, chain: Chain, current: float) -> None:
        self.ramp = Ramp(current)
        self._start = current
        self._wanted = SHARE * _first_motion(chain)
        self._goal = float(chain.outlet.current(self._wanted))
        self._elapsed = self._dwell = 0.0
        self._rise: float | None = None
        self._watched: list[tuple[float, float]] = []
        self._forces: list[float] = []

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Advance by one period."""
        self._elapsed += dt
        if self._elapsed <= SETTLE + WATCH:
            self.ramp.current = self._goal
            self._note(measured)
            return None
        self.ramp.tick(dt)
        if not self.ramp.towards(self._start, RATE, dt):
            return None
        self._dwell += dt
        return self._ended(measured) if self._dwell > SETTLE else None

    def rest(self, measured: Measurement) -> None:
        """Go back; the jaws never moved."""
        self.ramp.current = self._start

    def _note(self, measured: Measurement) -> None:
        pressure, force = measured.pressure.value, measured.grip.value
        if pressure is not None and self._rise is None:
            self._rise = self._elapsed if pressure > RISE * self._wanted else None
        if self._elapsed <= SETTLE:
            return
        if pressure is not None:
            self._watched.append((self._elapsed, pressure))
        if force is not None:
            self._forces.append(force)

    def _ended(self, measured: Measurement) -> Ending:
        error = droop = noise = None
        if len(self._watched) > 2:
            error = fmean(p for _, p in self._watched) - self._wanted
            half = len(self._watched) // 2
            first = fmean(p for _, p in self._watched[:half])
            last = fmean(p for _, p in self._watched[half:])
            droop = (first - last) / (WATCH / 2)
            noise = stdev(p for _, p in self._watched)
        found = Checked(
            valve_error=error,
            rise_time=self._rise,
            droop=droop,
            pressure_noise=noise,
            force_noise=stdev(self._forces) if len(self._forces) > 1 else None,
            force_quality=measured.grip.quality,
        )
        complaints = "; ".join(_complaints(found))
        failure = Failure(category="outcome", code="not_well", message=complaints)
        return Ending(
            Grip.RELEASED, failure=failure if complaints else None, finding=found
        )


def _complaints(found: Checked) -> list[str]:
    """What is not as it should be, in words."""
    said = []
    if found.valve_error is None:
        said.append("no pressure was measured")
    elif abs(found.valve_error) > VALVE_ERROR:
        said.append(
            f"the valve gives {found.valve_error / KILO:+.1f} kPa more than asked,"
            f" over {VALVE_ERROR / KILO:g} kPa"
        )
    elif found.rise_time is None or found.rise_time > SLOWEST_RISE:
        said.append(f"the pressure takes longer than {SLOWEST_RISE:g} s to come")
    if found.droop is not None and found.droop > FALL:
        said.append(f"the pressure falls by {found.droop / KILO:.1f} kPa/s: a leak")
    return said


def _first_motion(chain: Chain) -> float:
    """Gauge pressure at which the open jaws begin to close. [Pa].

    Raises
    ------
    DomainError
        The model knows none.
    """
    pressure = float(
        chain.outlet.pressure(chain.current(0.0, chain.linkage.open_width))
    )
    if pressure <= 0:
        message = "the jaws close without pressure: there is no step to try"
        raise DomainError(message, key="pressure_kPa")
    return pressure
