"""Whether a pressure goes in stairs, on regulators written from their description."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import quick_noise
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.stairs import Sweep, noise_at_rest, noise_on_stairs
from gripperd.model.track import Array
from tests.diagnose.sleeping import sleeps, stuck
from tests.diagnose.sweep import noise, run, triangle

NOISE, STEP = 2e3, 0.05
LOW, HIGH = 20e3, 500e3

Regulator = Callable[[Array], Array]


def sleeping(band: float, wakes: float = 0.0) -> Regulator:
    """Rests until the command is a band away, then goes to a share of the band."""

    def follow(command: Array) -> Array:
        held, found = command[0], []
        for goal in command:
            if abs(goal - held) > band:
                held = goal - np.sign(goal - held) * wakes * band
            found.append(held)
        return np.array(found)

    return follow


def late(command: Array) -> Array:
    """A lag of 0.2 s."""
    held, found = command[0], []
    for goal in command:
        held += (goal - held) * (1 - np.exp(-STEP / 0.2))
        found.append(held)
    return np.array(found)


def behind(command: Array) -> Array:
    """A play of 30 kPa."""
    held, found = command[0], []
    for goal in command:
        held = min(max(held, goal - 15e3), goal + 15e3)
        found.append(held)
    return np.array(found)


def capped(command: Array) -> Array:
    """A supply of 400 kPa."""
    return np.asarray(np.minimum(command, 400e3))


def hunting(command: Array) -> Array:
    """Swings of 12 kPa about the command, twice a second."""
    swing = np.sin(4 * np.pi * STEP * np.arange(command.size))
    return np.asarray(command + 12e3 * swing)


def blocked(command: Array) -> Array:
    """Nothing more from 310 to 450 kPa: it rests, and never catches up."""
    return np.asarray(np.minimum(command, 310e3) + np.maximum(command - 450e3, 0.0))


def steep(command: Array) -> Array:
    """A curve that is steep at its end: it catches up, and never rests."""
    return np.asarray(0.5 * command + 2.5 * np.maximum(command - 400e3, 0.0))


def straight(command: Array) -> Array:
    """As it is asked, through a curve that is bent."""
    return command + 20e3 * np.sin(np.pi * command / HIGH)


def _asked() -> list[Array]:
    """Ramps at two speeds, round turns, a staircase and holds."""
    time = np.linspace(0.0, 1.0, 161)
    stairs = np.interp(time, np.arange(9) / 8, [0, 0, 1, 1, 2, 2, 3, 3, 4]) / 4
    return [
        triangle(161, LOW, HIGH),
        triangle(321, LOW, HIGH),
        LOW + (HIGH - LOW) * 0.5 * (1 - np.cos(2 * np.pi * time)),
        LOW + (HIGH - LOW) * stairs,
        np.full(80, 300e3),
        np.full(80, LOW),
    ]


def _sweeps(regulator: Regulator, seed: int = 1) -> list[Sweep]:
    found = []
    for place, command in enumerate(_asked()):
        current = 0.004 + 0.016 * command / 500e3
        heard = current + noise(command.size, 3e-6, 100 + place)
        read = regulator(command) + noise(command.size, NOISE, 10 * seed + place)
        found.append(Sweep(heard, read))
    return found


@pytest.mark.parametrize("band", [25e3, 60e3])
@pytest.mark.parametrize("wakes", [0.0, 0.25])
def test_a_regulator_that_sleeps_goes_in_stairs(band: float, wakes: float) -> None:
    found = noise_on_stairs(_sweeps(sleeping(band, wakes)))
    assert found is not None
    assert found.std == pytest.approx(NOISE, rel=0.15)
    assert found.correlation < 0.25


@pytest.mark.parametrize(
    "regulator",
    [late, behind, capped, hunting, blocked, steep, straight],
    ids=lambda one: one.__name__,
)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_nothing_else_does(regulator: Regulator, seed: int) -> None:
    assert noise_on_stairs(_sweeps(regulator, seed)) is None


def test_a_band_within_the_noise_is_not_seen() -> None:
    assert noise_on_stairs(_sweeps(sleeping(5e3))) is None


def test_without_rests_or_moves_nothing_is_told() -> None:
    sweeps = _sweeps(sleeping(25e3))
    assert noise_on_stairs(sweeps[:3]) is None
    assert noise_on_stairs(sweeps[4:]) is None
    assert noise_on_stairs([]) is None


def test_readings_that_are_missing_are_passed_over() -> None:
    whole = _sweeps(sleeping(25e3))
    holed = [Sweep(one.current.copy(), one.pressure.copy()) for one in whole]
    for one in holed:
        one.pressure[::7] = np.nan
    unknown = Sweep(np.full(9, np.nan), np.full(9, 1e5))
    assert noise_on_stairs([unknown]) is None
    assert noise_on_stairs([*holed, unknown]) == noise_on_stairs(holed) is not None


def test_a_noise_that_somebody_knows_counts_on_stairs_as_well() -> None:
    told = replace(stuck(sleeps, 25e3), noise={"pressure": 5e3})
    sweeps, noises = courses(told, 0.25)
    assert sweeps[0].on_stairs
    assert noises["pressure"].std == 5e3


def _brisk(seed: int) -> Run:
    """Ramps and rests in turn, half a second each, in a noise that remembers."""
    turns = np.arange(49)
    goals = np.repeat(100e3 + 350e3 * (turns[:25] % 4) / 3, 2)[:49]
    moving = np.interp(np.arange(480) / 10, turns, goals)
    command = np.concatenate([moving, np.full(800, 200e3)])
    read = command + noise(command.size, NOISE, seed, memory=0.3)
    current = 0.004 + 0.016 * command / 500e3
    time = np.asarray(STEP * np.arange(float(command.size)))
    return run(time=time, current=current, pressure=read)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_ramps_that_turn_every_second_are_no_noise_of_a_pressure(seed: int) -> None:
    brisk = _brisk(seed)
    throughout = quick_noise([brisk.columns["pressure"]])
    assert throughout.std > 1.7 * NOISE
    found = courses(Recording("brisk", "0", (brisk,)), 0.25)[1]["pressure"]
    assert found.std == pytest.approx(NOISE, rel=0.15)
    assert found.correlation == pytest.approx(0.3, abs=0.15)


def test_where_the_command_seldom_rests_its_rests_tell_nothing() -> None:
    sweeps = _sweeps(straight)
    assert noise_at_rest(sweeps[:4]) is None
    rested = noise_at_rest([*sweeps, *_sweeps(straight, 2)])
    assert rested is not None
    assert rested.std == pytest.approx(NOISE, rel=0.1)
