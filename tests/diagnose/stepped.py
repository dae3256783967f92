"""Steps of pressure at held lengths, with dwells of 8 s between them.

The model misses a wave along the pressure that no library holds; what else is hidden is
a function of what happens.
"""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.model.track import Array
from tests.diagnose.small import (
    CONTRACTION_NOISE,
    FORCE_NOISE,
    MODEL,
    REGULATOR,
    Hidden,
    Moment,
    pinned,
    textbook,
)

STEP, DWELL = 0.1, 8.0
"""Between samples, and between commands. [s]"""
PRESSURES = (
    (150e3, 350e3, 250e3, 450e3),
    (250e3, 100e3, 300e3, 200e3),
    (100e3, 400e3, 200e3, 350e3),
)
LENGTHS = (0.0, 0.06, 0.12)
OPEN = ("muscle.diameter", "zero.force")
LEVEL = 25.0
"""Of the wave along the pressure. [N]"""


def missed(moment: Moment) -> Array:
    """A wave that no library holds: it stays the same while the pressure does. [N]."""
    return LEVEL * np.sin(moment.pressure / 40e3)


def creeping(share: float) -> Hidden:
    """Each step of the pull goes on by a share of it per decade of time."""

    def late(moment: Moment) -> Array:
        pull = moment.pressure * moment.pull_area
        steps = np.diff(pull, prepend=pull[0])
        found = np.zeros_like(pull)
        for index in np.flatnonzero(steps):
            since = np.maximum(moment.time - moment.time[index], 0.0)
            found += share * steps[index] * np.log10(1 + since)
        return found

    return late


def stepped(*hidden: Hidden, lengths: Sequence[float] = LENGTHS) -> Recording:
    """What the sensors say of three runs of steps at each length."""
    runs = []
    for place, (length, levels) in enumerate(
        (length, levels) for length in lengths for levels in PRESSURES
    ):
        random = np.random.default_rng([5, place])
        pressure = np.repeat(levels, round(DWELL / STEP))
        level = np.ones(pressure.size)
        time = 100.0 * place + STEP * np.arange(float(pressure.size))
        moment = Moment(time, pressure, length * level, level)
        force = textbook(moment) + sum(one(moment) for one in hidden)
        runs.append(
            Run(
                f"{length}/{place}",
                {
                    "time": time,
                    "current": np.asarray(REGULATOR.current(pressure)),
                    "pressure": pressure + random.normal(0.0, 300.0, time.size),
                    "contraction": moment.contraction
                    + random.normal(0.0, CONTRACTION_NOISE, time.size),
                    "force": force + random.normal(0.0, FORCE_NOISE, time.size),
                },
            )
        )
    return Recording("stepped", "0" * 64, tuple(runs))


def problem(*hidden: Hidden) -> Problem:
    """The problem of such a recording with but two constants open."""
    return pinned(problem_of(stepped(*hidden), MODEL, {}), *OPEN)
