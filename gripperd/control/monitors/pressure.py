"""The pressure against the current: short of air, leaking, or deaf to the current."""

from collections import deque
from collections.abc import Iterator

from gripperd.control.monitors.part import CERTAIN, SETTLED
from gripperd.control.monitors.policy import Cause, Policy
from gripperd.control.monitors.sight import Lasting, Sight, Symptom
from gripperd.units import KILO, MILLI

LAG = 0.4
"""Regulator and muscle have followed a change of the current by then. [s]"""
ONSET = 0.02
"""Share of the pressure whose loss is the beginning of a loss. [-]"""
SUDDEN = 0.04
"""A muscle or tube that opens empties through the hole, with the lag of the muscle
alone (20 ms measured); a regulator or supply that fails lets it down behind its own lag
as well, and has lost a quarter by then. [s]"""
SUDDEN_SHARE = 0.6
"""Share of a loss that is there after that time if it was sudden. [-]"""
COARSE = 0.2
"""Share of the pressure that is too little, or too much, from the beginning of a hold
on; less may be an error of the model. [-]"""
LEAST = 0.25
"""Share of the span that limits are taken of where less is asked for. [-]"""
UNMOVED = 0.2
"""Share of the wanted change of pressure below which the valve does not follow. [-]"""

MOVED = 3e-3
"""Motion of the jaws that no constant pressure leaves room for. [m]"""


class PressureFollows:
    """Compares the pressure with the band of what was asked for during the last lag.

    What the model or the zero of the valve is off by is learned whenever the gripper
    comes to rest, and left out from then on.
    """

    def __init__(self) -> None:
        self._asked: deque[tuple[float, float]] = deque()
        self._clock = 0.0
        self._bias: float | None = None
        self._rest = Lasting()
        self._start = (0.0, 0.0)
        """Pressure asked for and pressure found where it was last at rest, or has been
        let down to since. [Pa]"""
        self._stood: float | None = None
        """Opening when a command began. [m]"""
        self._losses: deque[tuple[float, float]] = deque()
        self._named: Cause | None = None
        self._short, self._deaf, self._open = Lasting(), Lasting(), Lasting()

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in each symptom."""
        self._clock += dt
        found = sight.measured.pressure.value
        low, high = self._band(sight)
        if found is None:
            self._losses.clear()
            return
        self._learn(sight, found, (low + high) / 2, dt)
        bias = self._bias or 0.0
        short, over = low + bias - found, found - high - bias
        yield from self._deafness(sight, short, over, found, dt)
        # A valve that has not moved at all is not short of air.
        if self._named is not Cause.VALVE_NOT_FOLLOWING and not self._unmoved(found):
            yield from self._shortage(sight, short, low + bias, found, dt)

    def _band(self, sight: Sight) -> tuple[float, float]:
        """Lowest and highest pressure that was asked for during the last lag. [Pa]."""
        regulator = sight.chain.regulator
        asked = float(sight.chain.outlet.pressure(sight.current))
        lowest = min(regulator.pressure_low, regulator.pressure_high)
        self._asked.append((self._clock, max(asked, lowest)))
        while self._clock - self._asked[0][0] > LAG:
            self._asked.popleft()
        pressures = [pressure for _, pressure in self._asked]
        return min(pressures), max(pressures)

    def _learn(self, sight: Sight, found: float, asked: float, dt: float) -> None:
        rest = self._rest.update(sight.idle, dt)
        if sight.idle:
            self._stood = sight.measured.opening.value
        if rest < 0 and self._named is None:
            self._bias = self._bias or 0.0
        if self._named is not None:
            return
        if asked <= self._start[0]:
            self._start = asked, found
        if rest < SETTLED:
            return
        if rest - dt < SETTLED:
            error = found - asked
            # By so much the model cannot be to blame.
            most = max(asked, LEAST * _span(sight))
            wrong = -error > COARSE * asked or error > COARSE * most
            self._bias = 0.0 if wrong else error
        self._start = asked, found

    def _deafness(
        self, sight: Sight, short: float, over: float, found: float, dt: float
    ) -> Iterator[Symptom]:
        """The current changes, the pressure does not; or it is too high anyhow."""
        policy = sight.policies[Cause.VALVE_NOT_FOLLOWING]
        limit = max(
            (policy.limit or 0.0) * _span(sight), CERTAIN * sight.scatter.pressure
        )
        deaf = over > limit or (self._unmoved(found) and short > limit)
        # Before the first rest nothing is known of what the valve is off by.
        deaf = deaf and self._bias is not None
        lasting = self._deaf.update(deaf, dt)
        if self._named is Cause.VALVE_NOT_FOLLOWING and not deaf:
            self._named = None
        if lasting < policy.after:
            return
        told = (
            f"{found / KILO:.0f} kPa where {sight.current / MILLI:.2f} mA ask for"
            f" {self._asked[-1][1] / KILO:.0f} kPa"
        )
        if self._named is None and self._moved(sight):
            text = f"the pressure sensor says {told}, and the jaws have moved"
            yield Symptom(Cause.SENSOR_FAILED, text, "pressure")
        else:
            self._named = Cause.VALVE_NOT_FOLLOWING
            yield Symptom(Cause.VALVE_NOT_FOLLOWING, f"the pressure is {told}")

    def _unmoved(self, found: float) -> bool:
        """Whether the pressure has hardly changed although it was asked to rise."""
        asked, was = self._start
        wanted = self._asked[-1][1] - asked
        return wanted > 0 and found - was < UNMOVED * wanted

    def _moved(self, sight: Sight) -> bool:
        """Whether the jaws have gone where the pressure says it cannot be."""
        opening = sight.measured.opening.value
        if opening is None or self._stood is None:
            return False
        return abs(opening - self._stood) > MOVED

    def _shortage(
        self, sight: Sight, short: float, asked: float, found: float, dt: float
    ) -> Iterator[Symptom]:
        """The pressure is too low: by a hole, or for want of air."""
        sure = CERTAIN * sight.scatter.pressure
        wanted = max(asked, LEAST * _span(sight))
        if short <= max(ONSET * wanted, sure / 2):
            self._losses.clear()
        else:
            self._losses.append((self._clock, short))
            self._forget()
        burst = sight.policies[Cause.BURST]
        # While the pressure is on its way, a hole cannot be told from a slow valve.
        steady = sight.idle and self._sudden
        empty = self._open.update(self._over(burst, short, wanted, sure), dt)
        sag = sight.policies[Cause.SUPPLY_SAG]
        leak = sight.policies[Cause.LEAK]
        least = min((sag, leak), key=lambda policy: policy.limit or 0.0)
        lasting = self._short.update(self._over(least, short, wanted, sure), dt)
        if lasting < 0:
            self._named = None
            return
        if self._named is None and empty >= burst.after and steady:
            self._named = Cause.BURST
        if self._named is None and lasting >= max(sag.after, leak.after):
            self._named = Cause.LEAK if steady else Cause.SUPPLY_SAG
        if self._named is not None:
            yield Symptom(self._named, _shortage(self._named, sight, asked, found))

    def _over(self, policy: Policy, short: float, wanted: float, sure: float) -> bool:
        return short > max((policy.limit or 0.0) * wanted, sure)

    def _forget(self) -> None:
        """Keep the beginning of a loss, and its present."""
        if len(self._losses) > 100:
            del self._losses[50]

    @property
    def _sudden(self) -> bool:
        """Whether the loss came at once; a slow loop cannot tell."""
        if not self._losses:
            return False
        start = self._losses[0][0]
        early = [loss for at, loss in self._losses if at - start <= SUDDEN]
        return len(early) >= 3 and early[-1] >= SUDDEN_SHARE * self._losses[-1][1]


def _span(sight: Sight) -> float:
    """Of the regulator. [Pa]."""
    regulator = sight.chain.regulator
    return abs(regulator.pressure_high - regulator.pressure_low)


def _shortage(cause: Cause, sight: Sight, wanted: float, found: float) -> str:
    numbers = (
        f"{found / KILO:.0f} kPa instead of {wanted / KILO:.0f} kPa at"
        f" {sight.current / MILLI:.2f} mA"
    )
    match cause:
        case Cause.BURST:
            return f"muscle or tube burst: {numbers}, all at once"
        case Cause.LEAK:
            return f"muscle or tube leak: {numbers}, all at once"
        case _:
            return f"the supply sags, the valve is off, or air leaks slowly: {numbers}"
