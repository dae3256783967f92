"""A small campaign on a rig written from the paper, apart from the package's formulas.

Eight sweeps, about 700 rows. What is hidden is a function of what happens.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi, radians, sin, tan

import numpy as np

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.problem import Problem
from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Linkage, Muscle, Regulator
from gripperd.model.track import Array

STEP = 0.25
FORCE_NOISE, PRESSURE_NOISE, CONTRACTION_NOISE = 3.0, 1e3, 2e-4
GRIP_NOISE = 0.5
SEED = 3

MUSCLE = Muscle(
    rest_length=0.25,
    diameter=0.02,
    braid_angle=radians(25),
    wall_thickness=0.002,
    elastic_modulus=1.3e6,
    friction_coefficient=0.002,
)
REGULATOR = Regulator(
    current_low=0.004, current_high=0.020, pressure_low=0.0, pressure_high=500e3
)
LINKAGE = Linkage(open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0)
MODEL = Explanation(
    muscle=MUSCLE,
    regulator=REGULATOR,
    linkage=None,
    effects=(RubberElasticity(), BraidFriction()),
)
"""The textbook, at the constants the rig was built with."""


@dataclass(frozen=True)
class Moment:
    """What happens in one sweep; arrays of one shape in SI."""

    time: Array
    pressure: Array
    contraction: Array
    direction: Array

    @property
    def pull_area(self) -> Array:
        """Eq. (4) divided by the pressure. [m²]"""
        return _area(self.contraction)


Hidden = Callable[[Moment], Array]
"""Force that the textbook leaves out. [N]"""


def nothing(moment: Moment) -> Array:
    return 0.0 * moment.time


def threshold(kilopascals: float) -> Hidden:
    """The first kilopascals stretch the bladder and do not pull."""

    def lost(moment: Moment) -> Array:
        return -np.minimum(moment.pressure, 1e3 * kilopascals) * moment.pull_area

    return lost


def rubbing(newtons: float) -> Hidden:
    """A constant force against the travel."""
    return lambda moment: -newtons * moment.direction


def rubbing_more(growth: float) -> Hidden:
    """Dry friction of 120 N whose law is not ours: so much more at full pressure."""

    def lost(moment: Moment) -> Array:
        slides = np.ptp(moment.contraction) > 0
        grown = 1 + growth * moment.pressure / 500e3
        return rubbing(120.0)(moment) * slides * grown

    return lost


def restless(hidden: Hidden) -> Hidden:
    """The same, and waves of 25 N that no library holds."""
    return lambda moment: hidden(moment) + 25.0 * np.sin(moment.time)


def switched(signal: Array, middles: Array, half: float) -> Array:
    """Share of relays that are up, each so far around its own middle."""
    up = signal[0] > middles
    shares = []
    for value in signal:
        up = np.where(up, value > middles - half, value > middles + half)
        shares.append(up.mean())
    return np.array(shares)


def moments() -> dict[str, Moment]:
    """The campaign: holds, isometric and isobaric sweeps, and one repeat."""
    plans: dict[str, tuple[float, Array, Array]] = {}
    up_down, there_back = np.array([0.0, 500e3, 0.0]), np.array([0.0, 0.2, 0.0])
    level = np.ones(3)
    for name, held in (("a", 0.0), ("b", 0.08), ("c", 0.16), ("b2", 0.08)):
        plans[name] = (25.0, up_down, held * level)
    plans["vented"] = (15.0, 0 * level, 0 * level)
    for name, isobar in (("d", 200e3), ("e", 400e3), ("f", 300e3)):
        plans[name] = (25.0, isobar * level, there_back)
    order = ("vented", "a", "b", "d", "c", "e", "b2", "f")
    found: dict[str, Moment] = {}
    start = 0.0
    for name in order:
        duration, pressure, contraction = plans[name]
        since = np.arange(0.0, duration, STEP)
        ends = np.linspace(0.0, duration, 3)
        found[name] = Moment(
            start + since,
            np.interp(since, ends, pressure),
            np.interp(since, ends, contraction),
            np.where((since > duration / 2) & (np.ptp(contraction) > 0), -1.0, 1.0),
        )
        start += duration + 60.0
    return found


def recording(
    hidden: Hidden = nothing,
    *,
    seed: int = SEED,
    order: Sequence[str] = (),
    noise: float = 1.0,
) -> Recording:
    """What the sensors of the rig say.

    Parameters
    ----------
    hidden
        What the rig does beyond the textbook.
    seed
        Of the noise; each sweep has its own, whatever the order.
    order
        Of the sweeps, another than that of the campaign; the clock goes on.
    noise
        Loudness, 1 for the usual.
    """
    runs = {
        name: _run(name, moment, hidden, noise, np.random.default_rng([seed, place]))
        for place, (name, moment) in enumerate(moments().items())
    }
    return Recording("small", "0" * 64, tuple(_clocked(runs[n] for n in order or runs)))


def tabled(hidden: Hidden, size: int = 40) -> Recording:
    """Settled points at six lengths, numbered for want of a clock."""
    points = np.arange(float(size))
    runs = []
    for place, held in enumerate((0.0, 0.05, 0.1, 0.15, 0.2, 0.24)):
        level = np.ones_like(points)
        moment = Moment(
            size * place + points, 500e3 * points / points[-1], held * level, level
        )
        random = np.random.default_rng([SEED, place])
        columns = {
            "time": moment.time,
            "pressure": moment.pressure,
            "contraction": moment.contraction,
            "force": textbook(moment)
            + hidden(moment)
            + random.normal(0.0, FORCE_NOISE, points.size),
        }
        runs.append(Run(str(held), columns))
    return Recording("table", "0" * 64, tuple(runs))


def with_jaws(plain: Recording, seed: int = SEED) -> Recording:
    """The same with the opening of the jaws, which press on nothing."""
    random = np.random.default_rng([seed, 99])
    return _changed(
        plain,
        lambda run: {
            **run.columns,
            "opening": LINKAGE.open_width
            - LINKAGE.ratio * MUSCLE.rest_length * run.columns["contraction"]
            + random.normal(0.0, 2e-4, len(run)),
        },
    )


def with_grip(plain: Recording, preload: float = 240.0) -> Recording:
    """The same with jaws on something as wide as they are open."""
    random = np.random.default_rng([SEED, 70])
    moment = moments()
    runs = []
    for run in plain.runs:
        happened = moment[run.name]
        spring = preload + 1000.0 * 0.25 * happened.contraction
        grip = np.maximum((textbook(happened) - spring) / 4, 0.0)
        read = grip + random.normal(0.0, GRIP_NOISE, len(run))
        runs.append(Run(run.name, {**run.columns, "grip": read}, run.kind))
    return Recording(plain.name, plain.digest, tuple(runs))


def without(plain: Recording, *columns: str) -> Recording:
    """The same as if something had not been recorded."""
    return _changed(
        plain,
        lambda run: {k: v for k, v in run.columns.items() if k not in columns},
    )


def altered(
    plain: Recording,
    names: Iterable[str],
    column: str,
    change: Callable[[Array], Array],
) -> Recording:
    """The same with one column of some runs changed."""
    chosen = frozenset(names)
    return _changed(
        plain,
        lambda run: (
            {**run.columns, column: change(run.columns[column])}
            if run.name in chosen
            else run.columns
        ),
    )


def pinned(problem: Problem, *open_paths: str) -> Problem:
    """The same with all constants known exactly but these, which makes it quick."""
    listed = tuple(one for one in problem.constants if one.path in open_paths)
    return replace(problem, constants=listed)


def undoubted(problem: Problem) -> Problem:
    """The same, pressures and lengths taken for known: but for the noise of the force.

    Then the covariance of a residual is that of the noise alone.
    """
    known = [
        replace(
            course,
            smooth={
                **course.smooth,
                **{
                    name: course.smooth[name]._replace(doubt=0.0)
                    for name in ("pressure", "length")
                },
            },
        )
        for course in problem.courses
    ]
    return replace(problem, courses=tuple(known))


def _changed(
    plain: Recording, columns: Callable[[Run], Mapping[str, Array]]
) -> Recording:
    runs = tuple(Run(run.name, columns(run), run.kind) for run in plain.runs)
    return Recording(plain.name, plain.digest, runs)


def _clocked(runs: Iterable[Run]) -> list[Run]:
    """One after the other, a minute of rest between."""
    found: list[Run] = []
    start = 0.0
    for run in runs:
        time = run.columns["time"] - run.columns["time"][0] + start
        found.append(Run(run.name, {**run.columns, "time": time}, run.kind))
        start = float(time[-1]) + 60.0
    return found


def _run(
    name: str,
    moment: Moment,
    hidden: Hidden,
    noise: float,
    random: np.random.Generator,
) -> Run:
    size = moment.time.size
    force = textbook(moment) + hidden(moment)
    return Run(
        name,
        {
            "time": moment.time,
            "current": 0.004 + 0.016 * moment.pressure / 500e3,
            "pressure": moment.pressure
            + random.normal(0.0, noise * PRESSURE_NOISE, size),
            "contraction": moment.contraction
            + random.normal(0.0, noise * CONTRACTION_NOISE, size),
            "force": force + random.normal(0.0, noise * FORCE_NOISE, size),
        },
    )


def covariance(time: Array, law: Noise) -> Array:
    """Of white and autoregressive noise and a drift, sampled every :data:`STEP`."""
    apart = np.abs(np.subtract.outer(time, time))
    persistence = law.correlation / (1 - law.white)
    fast = (1 - law.white) * persistence ** np.round(apart / STEP)
    fast = law.std**2 * (fast + law.white * np.eye(time.size))
    slow = law.drift**2 * np.exp(-apart / law.memory)
    return np.asarray(fast + slow)


def textbook(moment: Moment) -> Array:
    """Eqs. (4) to (7) of the paper, as they are printed but for the brace of (6)."""
    p, h = moment.pressure, moment.contraction
    s = _ratio(h)
    rubber = 1.3e6 * 0.002 * pi * 0.02
    hoop = (1 - h) ** 2 / tan(radians(25)) ** 2 * (1 - 1 / s)
    contact = (p * 0.02 - 2 * 1.3e6 * 0.002) * s + 2 * 1.3e6 * 0.002
    friction = 0.002 * pi * 0.25 * (1 - h) * np.maximum(contact, 0.0)
    return p * _area(h) - rubber * (hoop + h * s) - moment.direction * friction


def _area(h: Array) -> Array:
    angle = radians(25)
    return np.asarray(
        pi * 0.02**2 / 4 * (3 * (1 - h) ** 2 / tan(angle) ** 2 - 1 / sin(angle) ** 2)
    )


def _ratio(h: Array) -> Array:
    cosine = (1 - h) * np.cos(radians(25))
    return np.asarray(np.sqrt(1 - cosine**2) / sin(radians(25)))
