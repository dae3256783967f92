"""The command of a valve, also where a log has a reading of it in its place.

A command has no noise, and a regulator follows every wiggle of it. That of a reading it
never sees.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gripperd.diagnose.noise.model import (
    CONSISTENT,
    LONG,
    Noise,
    coarse_step,
    quick_noise,
)
from gripperd.diagnose.noise.smoothing import OF_LENGTH, smooth
from gripperd.diagnose.readings.level import MOVES, bending, leaping
from gripperd.diagnose.readings.recording import Run
from gripperd.model.compiled import compiled
from gripperd.model.track import Array

READ = 5e-6
"""Noise from which a current was read, not written: a step of 12 bits is less. [A]"""
FOLLOWED = 0.3
"""Share of its wiggles that the pressure follows if they are the command's. [-]"""
LATEST = 4
"""Samples by which it may follow late."""
RESTS = 30
"""Readings from which a command that does not move has come to rest."""
FAR = 3.0
"""Standard errors within which the halves of a rest are alike. [-]"""


def as_commanded(sweeps: Sequence[Run]) -> list[Run]:
    """Take the noise off currents that were read back.

    Parameters
    ----------
    sweeps
        Of one recording, without a pause.
    """
    columns = [sweep.columns["current"] for sweep in sweeps if sweep.has("current")]
    if not _wiggles(columns) or _is_followed(sweeps):
        return list(sweeps)
    noise = quick_noise(columns, coarse_step(columns), LONG)
    return [_quiet(one, noise) if one.has("current") else one for one in sweeps]


def stillness(sweep: Run) -> Array:
    """Time since the command last moved, NaN where there is none. [s].

    Before the first command that was read nobody knows that it moved.
    """
    time = sweep.columns["time"]
    if not sweep.has("current"):
        return np.full_like(time, np.nan)
    return compiled(_since)(sweep.columns["current"], time, MOVES)


def _wiggles(columns: Sequence[Array]) -> bool:
    """Whether currents bend at most samples; stairs and ramps bend at few."""
    bends = np.concatenate([np.empty(0), *(np.diff(column, 2) for column in columns)])
    known = bends[np.isfinite(bends)]
    # Second differences of white noise have six times its variance.
    std = CONSISTENT * np.median(np.abs(known)) / 6**0.5 if known.size else 0.0
    return bool(std > READ)


def _is_followed(sweeps: Sequence[Run]) -> bool:
    """Whether the pressure goes with what the current does from sample to sample."""
    pairs = []
    for sweep in sweeps:
        if sweep.has("current") and sweep.has("pressure"):
            current, pressure = sweep.columns["current"], sweep.columns["pressure"]
            known = np.isfinite(current) & np.isfinite(pressure)
            if known.sum() > LONG:
                time = sweep.columns["time"][known]
                pairs.append((time, current[known], pressure[known]))
    if not pairs:
        return True
    _, currents, pressures = (np.concatenate(one) for one in zip(*pairs, strict=True))
    gain = float(np.polyfit(currents, pressures, 1)[0])
    wiggles = [
        (_wiggle(gain * told, time), _wiggle(got, time)) for time, told, got in pairs
    ]
    power = sum(float(asked @ asked) for asked, _ in wiggles)
    followed = max(
        sum(float(asked[: asked.size - lag] @ got[lag:]) for asked, got in wiggles)
        for lag in range(LATEST + 1)
    )
    return followed > FOLLOWED * power


def _wiggle(column: Array, time: Array) -> Array:
    """Readings off the line between their neighbours; 0 at a corner or a step.

    There they are far more off. In a ramp nothing is, however uneven the clock.
    """
    share = np.diff(time)[:-1] / np.maximum(time[2:] - time[:-2], 1e-9)
    bend = column[1:-1] - column[:-2] - share * (column[2:] - column[:-2])
    most = 4 * float(np.median(np.abs(bend)))
    bounded: Array = np.where(np.abs(bend) <= most, bend, 0.0)
    return bounded


def _quiet(sweep: Run, noise: Noise) -> Run:
    time, current = sweep.columns["time"], sweep.columns["current"]
    plain = smooth(time, current, noise.slow_variance, tried=OF_LENGTH)
    best = max(
        plain,
        leaping(sweep, "current", plain),
        bending(sweep, "current", plain),
        key=lambda one: one.likelihood,
    )
    rested = _at_rest(current, best.value, noise)
    commanded = np.where(np.isfinite(current), rested, np.nan)
    return replace(sweep, columns={**sweep.columns, "current": commanded})


def _at_rest(read: Array, value: Array, noise: Noise) -> Array:
    """Let what stays where it is, but for what is left of its noise, rest indeed."""
    out = value.copy()
    moved = compiled(_moved)(value, read, noise.std)
    for start, end in pairwise([*np.flatnonzero(moved).tolist(), value.size]):
        known = read[start:end][np.isfinite(read[start:end])]
        if known.size < RESTS:
            continue
        middle = known.size // 2
        gone = known[middle:].mean() - known[:middle].mean()
        error = 2 * (noise.slow_variance / known.size) ** 0.5
        if abs(gone) < FAR * error:
            out[start:end] = known.mean()
    return out


def _moved(value: Array, read: Array, std: float) -> Array:
    """Samples from which a column is no more where it was on average: 1, else 0."""
    out = np.zeros(value.size)
    total, count = 0.0, 0
    for i in range(value.size):
        least = std * (1 + 2 / max(count, 1) ** 0.5)
        if count == 0 or abs(value[i] - total / count) > least:
            out[i] = 1.0
            total, count = 0.0, 0
        total += value[i] if np.isnan(read[i]) else read[i]
        count += 1
    return out


def _since(value: Array, time: Array, least: float) -> Array:
    out = np.empty_like(value)
    held, since = value[0], time[0]
    for i in range(value.size):
        if np.isnan(held):
            held = value[i]
        if abs(value[i] - held) > least:
            held, since = value[i], time[i]
        out[i] = time[i] - since
    return out
