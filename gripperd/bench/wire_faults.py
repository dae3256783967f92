"""What can be made to go wrong on the wire, request by request."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from math import isfinite
from random import Random
from typing import NamedTuple

from gripperd.errors import InputError
from gripperd.protocol.modbus import Refusal
from gripperd.units import MILLI

CODES = (
    Refusal.ILLEGAL_FUNCTION,
    Refusal.ILLEGAL_ADDRESS,
    Refusal.DEVICE_FAILURE,
    Refusal.BUSY,
)
"""Exceptions that are drawn at random."""
MOST_WAITING = 10_000
"""Requests that can be spoiled ahead of time."""


class WireFaultKind(StrEnum):
    """What goes wrong with one request."""

    NONE = "none"
    """Nothing: a place in a script."""
    LATE = "late"
    """The reply comes later than anybody waits."""
    LOST = "lost"
    """The module obeys and its reply is lost."""
    GARBLED = "garbled"
    """A character of the reply is damaged."""
    WRONG_UNIT = "wrong_unit"
    WRONG_FUNCTION = "wrong_function"
    WRONG_ECHO = "wrong_echo"
    """A write is confirmed with another value than was sent."""
    SHORT = "short"
    """A sound reply to a read that holds less than was asked for."""
    CUT = "cut"
    """The end of the reply is lost."""
    EXCEPTION = "exception"
    """The module refuses and does nothing."""
    NOISE = "noise"
    """Two octets before the reply."""
    LOCAL_ECHO = "local_echo"
    """The request comes back before the reply."""
    WATCHDOG_TRIPPED = "watchdog_tripped"
    """The outputs have gone to their safe values, and stay."""
    OPEN_LOOP = "open_loop"
    """The wire to the valve is cut, and stays so until the bench is mended."""
    POWER_CYCLED = "power_cycled"
    """The module was off and on: outputs have their power-on values."""


OF_OUTPUTS = frozenset({WireFaultKind.WATCHDOG_TRIPPED, WireFaultKind.OPEN_LOOP})
"""They befall output modules alone."""
LASTING = OF_OUTPUTS | {WireFaultKind.POWER_CYCLED}
"""They change a module; the reply is honest."""
PASSING = tuple(
    kind for kind in WireFaultKind if kind not in LASTING | {WireFaultKind.NONE}
)
"""They spoil one exchange, and may be drawn at random."""


class Asked(NamedTuple):
    """One request, as far as faults tell requests apart."""

    units: frozenset[int]
    """Who is asked; several in a broadcast."""
    writes: bool
    drives: bool
    """Whether an output module is asked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WireFault:
    """A fault of one request.

    Raises
    ------
    InputError
        A value is out of its range; the key carries the unit.
    """

    kind: WireFaultKind
    code: int = Refusal.DEVICE_FAILURE
    """Exception code of `EXCEPTION`."""
    delay: float = 1.0
    """How much later a `LATE` reply comes. [s]"""
    unit: int | None = None
    """Befalls requests to this unit alone; None befalls any."""
    times: int = 1
    """Requests in a row."""

    def __post_init__(self) -> None:
        ms = self.delay / MILLI
        for key, value, low, high in (
            ("code", self.code, 1, 255),
            ("delay_ms", ms, 0, 600_000),
            ("unit", self.unit or 0, 0, 255),
            ("times", self.times, 1, MOST_WAITING),
        ):
            if not (isfinite(value) and low <= value <= high):
                message = f"{key} = {value:g}: must be {low} to {high}"
                raise InputError(message, key=key)

    def befalls(self, asked: Asked) -> bool:
        """Whether a request can meet it."""
        if self.unit is not None and self.unit not in asked.units:
            return False
        if self.kind is WireFaultKind.WRONG_ECHO:
            return asked.writes
        if self.kind is WireFaultKind.SHORT:
            return not asked.writes
        return asked.drives or self.kind not in OF_OUTPUTS


class WireFaults:
    """Faults in the order in which requests meet them, then perhaps some at random.

    A fault waits for the first request that it can befall; those behind it wait too.

    Parameters
    ----------
    rng
        Where chance comes from.
    """

    def __init__(self, rng: Random) -> None:
        self.chance = 0.0
        """Probability that a request meets a passing fault once none waits. [-]"""
        self._rng = rng
        self._waiting: deque[WireFault] = deque()

    @property
    def waiting(self) -> Sequence[WireFault]:
        """Faults that no request has met yet."""
        return tuple(self._waiting)

    @property
    def idle(self) -> bool:
        """Whether no request can meet anything."""
        return not self._waiting and not self.chance

    def set(self, faults: Sequence[WireFault], chance: float = 0.0) -> None:
        """Put these in place of all that wait.

        Raises
        ------
        InputError
            Too many, or a chance that is no probability.
        """
        if not 0.0 <= chance <= 1.0:
            message = f"chance = {chance:g}: must be 0 to 1"
            raise InputError(message, key="chance")
        if len(faults) > MOST_WAITING:
            message = f"{len(faults)} faults are too many: at most {MOST_WAITING} wait"
            raise InputError(message, key="faults")
        self.chance = chance
        self._waiting = deque(faults)

    def meet(self, asked: Asked) -> WireFault | None:
        """What befalls a request, None if nothing does."""
        if not self._waiting:
            return self._drawn(asked)
        head = self._waiting[0]
        if not head.befalls(asked):
            return None
        self._waiting.popleft()
        if head.times > 1:
            self._waiting.appendleft(replace(head, times=head.times - 1))
        return None if head.kind is WireFaultKind.NONE else head

    def _drawn(self, asked: Asked) -> WireFault | None:
        if not self.chance or self._rng.random() >= self.chance:
            return None
        kind, code = self._rng.choice(PASSING), self._rng.choice(CODES)
        drawn = WireFault(kind=kind, code=code)
        return drawn if drawn.befalls(asked) else None
