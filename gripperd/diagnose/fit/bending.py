"""Whether an addition is an effect of its own, or mends the form of what was there.

No library has the formula of nature: where an effect is off by a part of its size, any
other that looks like that part seems to be missing. So the effects that were there are
let bend: each is multiplied by slow functions of what it may depend on. What bending
does as well was a matter of form.

References
----------
.. [1] M. C. Kennedy, A. O'Hagan, "Bayesian calibration of computer models",
       J. R. Stat. Soc. B 63(3), 425-464, 2001: a model's own inadequacy as a function.
"""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.fit.candidates import is_exact
from gripperd.diagnose.fit.gram import bounded
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.fit.tangent import Tangent
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal
from gripperd.model.track import Array

BENT = 0.3
"""How far a formula may be off, of the effect itself, one sigma. [-]"""
OF_MUSCLE = ("pressure", "contraction")
LEVELS: Mapping[Signal, tuple[str, ...]] = MappingProxyType({
    Signal.PRESSURE: ("current",), Signal.FORCE: OF_MUSCLE,
    Signal.OPENING: OF_MUSCLE, Signal.GRIP: OF_MUSCLE,
})  # fmt: skip
"""What an effect in a signal may be a function of, beside the time."""


def bendable(rival: Rival) -> tuple[str, ...]:
    """Names of the effects of an explanation that could have another form."""
    return tuple(
        one.name for one in rival.candidates if one.effect and not is_exact(one)
    )


def bent(problem: Problem, rival: Rival, names: Sequence[str]) -> float:
    """Tell what an explanation leaves when some of its effects are let bend.

    Parameters
    ----------
    problem
        The recording and the model.
    rival
        The explanation, fitted.
    names
        Effects in it that bend.

    Returns
    -------
    Misfit plus prior: chi². [-]
    """
    tangent = Tangent.at(problem, rival.fit)
    columns = tangent.columns
    if names:
        waves = _waves(problem)
        bends = [_bends(problem, rival, name, waves) for name in names]
        columns = [
            np.hstack([own, *more])
            for own, more in zip(columns, zip(*bends, strict=True), strict=True)
        ]
    free = np.full(columns[0].shape[1] - tangent.here.size, np.inf)
    low, high = np.append(tangent.low, -free), np.append(tangent.high, free)
    start = np.append(tangent.here, np.zeros_like(free))
    prior = np.append(np.where(tangent.shapes, tangent.here, 0.0), np.zeros_like(free))
    z, y = np.concatenate(columns), np.concatenate(tangent.targets)
    matrix, moments = z.T @ z + np.eye(z.shape[1]), z.T @ y + prior
    best = bounded(matrix, moments, low, high, start)
    return float(y @ y + prior @ prior - (2 * moments - matrix @ best) @ best)


def _bends(
    problem: Problem, rival: Rival, name: str, waves: Sequence[Array]
) -> list[Array]:
    """Whitened columns of an effect times every slow function, block by block."""
    point = rival.fit.point
    there, bare = (
        problem.expected(problem.explanation(one))
        for one in (point, point.without(name))
    )
    return [
        problem.white(list(BENT * (there[index] - bare[index]) * waves[index]), index)
        for index in range(len(problem.blocks))
    ]


def _waves(problem: Problem) -> list[Array]:
    """Slow functions block by block, shape ``(w, n)``: Legendre's first and second."""
    courses = problem.courses
    clock = [one.time for one in courses]
    known = {"clock": clock, "sweep": [time - time[0] for time in clock]}
    known |= {n: [c.level(n) for c in courses] for n in ("current", *OF_MUSCLE)}
    scaled = {name: _scaled(columns) for name, columns in known.items()}
    found = []
    for block in problem.blocks:
        names = (*LEVELS[block.signal], "clock", "sweep")
        first = np.array([scaled[name][block.course][block.good] for name in names])
        mixed = first[:1] * first[1:2]
        found.append(np.concatenate([first, (3 * first**2 - 1) / 2, mixed]))
    width = max(len(one) for one in found)
    return [np.pad(one, ((0, width - len(one)), (0, 0))) for one in found]


def _scaled(columns: Sequence[Array]) -> list[Array]:
    """Columns from -1 to 1 over all sweeps, 0 where they are not known."""
    every = np.concatenate(columns)
    known = every[np.isfinite(every)]
    low, high = (known.min(), known.max()) if known.size else (0.0, 0.0)
    span = max(high - low, 1e-300)
    return [np.nan_to_num((2 * one - low - high) / span) for one in columns]
