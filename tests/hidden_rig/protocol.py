"""The experiments of one recording."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sweep:
    """One run: lines between knots of time, pressure and contraction."""

    name: str
    kind: str
    time: tuple[float, ...]
    pressure: tuple[float, ...]
    """Asked of the regulator. [kPa]"""
    contraction: tuple[float, ...] = ()
    """Imposed; nothing where the jaws move freely."""
    object_size: float = float("nan")
    object_stiffness: float = float("nan")
    rounded: bool = False
    """Half a cosine from knot to knot, as a crank drives it, no straight line."""

    def pressure_at(self, since: Array) -> Array:
        """Asked of the regulator some time into the run. [kPa]."""
        return self._between(since, self.pressure)

    def contraction_at(self, since: Array) -> Array:
        """Imposed some time into the run, NaN where the jaws move freely."""
        if not self.contraction:
            return np.full(since.size, np.nan)
        return self._between(since, self.contraction)

    def _between(self, since: Array, knots: tuple[float, ...]) -> Array:
        place = np.interp(since, self.time, np.arange(len(self.time)))
        if self.rounded:
            whole = np.floor(place)
            place = whole + (1 - np.cos(np.pi * (place - whole))) / 2
        return np.asarray(np.interp(place, np.arange(len(knots)), knots))


def slack_pressure(contraction: float) -> float:
    """Give the pressure under which the reference muscle would have to push. [kPa]."""
    # Contraction at no force without friction, table 1.7 of the muscle's notes.
    table = (0.0, 0.0423, 0.0935, 0.1791, 0.2286, 0.2579)
    return float(np.interp(contraction, table, (0.0, 50.0, 100.0, 200.0, 300.0, 400.0)))


def free_contraction(pressure: float) -> float:
    """Give the contraction at which the reference muscle goes slack."""
    table = (0.0, 0.0423, 0.0935, 0.1791, 0.2286, 0.2579)
    return float(np.interp(pressure, (0.0, 50.0, 100.0, 200.0, 300.0, 400.0), table))


def protocol(random: np.random.Generator, *, taut: bool) -> list[Sweep]:
    """Give the sweeps in the order in which they are run."""
    isometric = [
        _isometric(k, h, random, taut=taut)
        for k, h in enumerate(_spread(0.0, 0.21, int(random.integers(4, 6)), random))
    ]
    isobaric = [
        _isobaric(k, p, random, taut=taut)
        for k, p in enumerate(_spread(110.0, 440.0, int(random.integers(4, 6)), random))
    ]
    steps = [_step(k, random) for k in range(int(random.integers(1, 3)))]
    grasps = [_grasp(k, random) for k in range(int(random.integers(4, 6)))]
    sweeps = [
        *isometric,
        *isobaric,
        *steps,
        *grasps,
        _vented(random),
        _inflated(random),
    ]
    shuffled = [sweeps[k] for k in random.permutation(len(sweeps))]
    # The first inflation of a recording is one in which the muscle pulls.
    first = next(s for s in shuffled if s.kind == "isometric")
    shuffled.remove(first)
    shuffled.insert(0, first)
    again = (isometric + isobaric)[int(random.integers(len(isometric + isobaric)))]
    late = max(shuffled.index(again) + 3, len(shuffled) - 2)
    shuffled.insert(late, replace(again, name=f"{again.name}_again"))
    return shuffled


def _spread(
    low: float, high: float, count: int, random: np.random.Generator
) -> list[float]:
    share = (np.arange(count) + random.uniform(0, 0.6, count)) / count
    share[0] = 0.0
    return [float(round(low + (high - low) * s, 3)) for s in share]


def _approach(pressure: float, contraction: float) -> tuple[list[float], ...]:
    """Inflate a little stretched, then shorten: taut, and the direction is known."""
    longer = -0.01
    arrival = 2.5 + (contraction - longer) / 0.05
    lengths = [longer, longer, longer, contraction]
    return [0, 0.5, 2.5, arrival], [0, 0, pressure, pressure], lengths


def _isometric(
    number: int, contraction: float, random: np.random.Generator, *, taut: bool
) -> Sweep:
    floor = slack_pressure(contraction) + 25 if taut else 0.0
    top = float(random.uniform(380, 460))
    time, pressure, length = _approach(floor, contraction)
    if random.random() < 0.5:
        levels = np.linspace(floor, top, int(random.integers(4, 7)))
        rise, rest = float(random.uniform(0.5, 1.0)), float(random.uniform(1.0, 2.0))
        visits = [*levels[1:], *levels[-2::-1]]
    else:
        rise, rest = float(random.uniform(8, 16)), 0.0
        visits = [top, floor]
    for level in visits:
        for duration in (rise, rest):
            time.append(time[-1] + duration)
            pressure.append(float(level))
            length.append(contraction)
    return _imposed(f"isometric_{number}", "isometric", time, pressure, length)


def _isobaric(
    number: int, level: float, random: np.random.Generator, *, taut: bool
) -> Sweep:
    far = min((0.75 if taut else 0.88) * free_contraction(level), 0.215)
    time, pressure, length = _approach(level, 0.0)
    turns = [far, 0.0]
    if random.random() < 0.5:
        turns = [0.7 * far, 0.35 * far, far, 0.45 * far, 0.75 * far, 0.0]
    slow = float(random.uniform(0.012, 0.03))
    for speed in (slow, slow * float(random.uniform(2, 4))):
        for turn in turns:
            time.append(time[-1] + abs(turn - length[-1]) / speed)
            pressure.append(level)
            length.append(turn)
    return _imposed(f"isobaric_{number}", "isobaric", time, pressure, length)


def _step(number: int, random: np.random.Generator) -> Sweep:
    contraction = float(random.uniform(0.03, 0.12))
    low = slack_pressure(contraction) + 40
    high, middle = (float(v) for v in random.uniform((330, 180), (440, 260)))
    time, pressure, length = _approach(low, contraction)
    for level in (low, high, middle):
        jump, hold = 0.02, 5.0 if level == low else float(random.uniform(20, 50))
        for duration in (jump, hold):
            time.append(time[-1] + duration)
            pressure.append(level)
            length.append(contraction)
    return _imposed(f"step_{number}", "step", time, pressure, length)


def _vented(random: np.random.Generator) -> Sweep:
    time, pressure, length = _approach(0.0, 0.0)
    time.append(time[-1] + float(random.uniform(60, 90)))
    return _imposed("hold_vented", "hold", time, [*pressure, 0.0], [*length, 0.0])


def _inflated(random: np.random.Generator) -> Sweep:
    contraction, level = (
        float(random.uniform(0.02, 0.1)),
        float(random.uniform(250, 400)),
    )
    time, pressure, length = _approach(level, contraction)
    time.append(time[-1] + float(random.uniform(60, 90)))
    return _imposed(
        "hold_inflated", "hold", time, [*pressure, level], [*length, contraction]
    )


def _grasp(number: int, random: np.random.Generator) -> Sweep:
    level = float(random.uniform(220, 320))
    close, hold = random.uniform((4, 6), (7, 10))
    durations = (0.5, close, hold, close, 0.5)
    time = np.concatenate([[0.0], np.cumsum(durations)])
    return Sweep(
        f"grasp_{number}",
        "grasp",
        tuple(float(t) for t in time),
        (0.0, 0.0, level, level, 0.0, 0.0),
        object_size=float(random.uniform(0.022, 0.068)),
        object_stiffness=float(np.exp(random.uniform(np.log(4e3), np.log(30e3)))),
    )


def _imposed(
    name: str, kind: str, time: list[float], pressure: list[float], length: list[float]
) -> Sweep:
    return Sweep(name, kind, tuple(time), tuple(pressure), tuple(length))
