"""A rig whose regulator sticks: pressure alone, from the description of its spool."""

from collections.abc import Callable, Mapping

import numpy as np

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, triangle

STEP, NOISE = 0.05, 2e3

Spool = Callable[[Array, float], Array]


def sleeps(command: Array, band: float) -> Array:
    """Rest until the command is a band away, slew to it in some 60 ms, and rest."""
    held, slews, found = command[0], False, []
    for goal in command:
        slews = slews or abs(goal - held) > band
        if slews:
            held += (goal - held) * (1 - np.exp(-STEP / 0.03))
            slews = abs(goal - held) > 0.15 * band
        found.append(held)
    return np.array(found)


def rounds(command: Array, band: float) -> Array:
    """Go to the nearest multiple of the band."""
    return np.asarray(band * np.round(command / band))


def trails(command: Array, band: float) -> Array:
    """Follow half a band behind."""
    held, found = command[0], []
    for goal in command:
        held = min(max(held, goal - band / 2), goal + band / 2)
        found.append(held)
    return np.array(found)


def sticks(command: Array, band: float) -> Array:
    """Rest where the command turns until it is a band away, then run after it."""
    held, way, waits, found = command[0], 1.0, False, []
    for goal, gone in zip(command, np.diff(command, prepend=command[0]), strict=True):
        if gone * way < 0:
            way, waits = -way, True
        waits = waits and abs(goal - held) <= band
        if not waits:
            most = 3 * abs(gone)
            held += np.clip(goal - held, -most, most) if gone else goal - held
        found.append(held)
    return np.array(found)


def doubled(command: Array, band: float) -> Array:
    """Two spools of unlike bands feed the outlet alike."""
    return (trails(command, 0.6 * band) + trails(command, 1.4 * band)) / 2


def ladders() -> dict[str, Array]:
    """Stairs of treads of 4 to 40 kPa: some bands follow them, others not. [Pa]"""
    rng = np.random.default_rng(5)
    found = {}
    for name in "abcdef":
        ways = rng.uniform(4e3, 40e3, 16) * rng.choice([-1.0, 1.0], 16)
        found[name] = np.repeat(250e3 + np.cumsum(ways), 30)
    found["vent"], found["hold"] = np.zeros(160), np.full(160, 300e3)
    return found


def commands() -> dict[str, Array]:
    """Ramps of several heights, round turns, small reversals, stairs and holds. [Pa]"""
    phase = np.linspace(0.0, 2 * np.pi, 240)
    found = {f"ramp_{top:.0f}": triangle(280, 40e3, 1e3 * top) for top in (350, 480)}
    found["round"] = 270e3 - 200e3 * np.cos(phase)
    found["small"] = np.interp(
        np.arange(320),
        np.arange(9) * 40,
        1e3 * np.array([60, 460, 300, 400, 200, 320, 140, 240, 80]),
    )
    steps = np.repeat([60e3, 160e3, 260e3, 360e3, 460e3, 310e3, 210e3, 110e3], 2)
    found["stairs"] = np.interp(
        np.arange(400), (np.arange(8)[:, None] * 50 + [0, 38]).ravel(), steps
    )
    found["vent"], found["hold"] = np.zeros(160), np.full(160, 300e3)
    return found | {"again": found["ramp_480"], "round_again": found["round"]}


def stuck(
    spool: Spool,
    band: float,
    seed: int = 1,
    asked: Mapping[str, Array] | None = None,
) -> Recording:
    """What the sensors say of such a spool, asked for these pressures or the usual."""
    runs, start = [], 0.0
    for place, (name, command) in enumerate((asked or commands()).items()):
        time = start + STEP * np.arange(command.size)
        current = 0.004 + 0.016 * command / 500e3
        columns: dict[str, Array] = {
            "time": np.asarray(time),
            "current": current + noise(command.size, 2e-6, 1000 + place),
            "pressure": spool(command, band)
            + noise(command.size, NOISE, 100 * seed + place),
        }
        runs.append(Run(name, columns))
        start = time[-1] + 30.0
    return Recording("stuck", "0" * 64, tuple(runs))
