"""How loud each signal is: white noise, its memory, and drift."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.course import Course, is_table
from gripperd.diagnose.drift import thinned, with_drift
from gripperd.diagnose.noise import Noise, coarse_step, quick_noise
from gripperd.diagnose.point import Point
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.quiet import driven, vented
from gripperd.model.effect import Signal

POINTS = 0.002
"""Noise of settled points in a table, of full scale. [-]"""
RESOLUTION = 1e-4
"""Of any reading, of full scale. [-]"""
LINKAGE = 0.01
"""How well any linkage is known, of the largest grip: joints have play. [-]"""
WANDERS = 3.0
"""Time in which what is left of the force in the grip forgets. [s]"""


def noises_of(problem: Problem, point: Point) -> dict[Signal, Noise]:
    """Tell the noise of every signal that is explained.

    Parameters
    ----------
    problem
        Without what is held out.
    point
        The best constants, with nothing added. What repeats is no noise.

    Returns
    -------
    Noise by signal. [SI]
    """
    residuals = problem.residuals(point)
    found: dict[Signal, Noise] = {}
    for signal in problem.signals:
        indices = [i for i, b in enumerate(problem.blocks) if b.signal is signal]
        step = coarse_step(c.column(signal.value) for c in problem.courses)
        noise = quick_noise((residuals[i] for i in indices), step)
        if is_table(problem.courses):
            # Neighbours are no repeats of each other; instruments of a test stand.
            noise = Noise(POINTS * problem.full_scale[signal], 0.0)
        noise = _audible(noise, signal, problem.courses)
        quiet = thinned(
            [*vented(problem, signal), *driven(problem, residuals, indices)]
        )
        found[signal] = with_drift(noise, quiet, problem.full_scale[signal])
    return _handed_on(found, problem)


def _audible(noise: Noise, signal: Signal, sweeps: tuple[Course, ...]) -> Noise:
    """A reading without any noise is still no better than its display."""
    columns = np.concatenate([sweep.column(signal.value) for sweep in sweeps])
    top = float(np.nanmax(np.abs(columns), initial=0.0)) or 1.0
    return replace(noise, std=max(noise.std, RESOLUTION * top))


def _handed_on(noises: dict[Signal, Noise], problem: Problem) -> dict[Signal, Noise]:
    """Give the grip what is wrong with the force that it is predicted from.

    That is its drift and what its noise leaves in the smooth column, beside the play
    of the joints. What lasts longest is taken for what forgets soonest: it is no part
    of a grasp that must be told from another.
    """
    force, grip, linkage = (
        noises.get(Signal.FORCE), noises.get(Signal.GRIP), problem.model.linkage,
    )  # fmt: skip
    if force is None or grip is None or linkage is None:
        return noises
    places = [block for block in problem.blocks if block.signal is Signal.GRIP]
    sweeps = [problem.courses[place.course] for place in places]
    own = quick_noise(
        sweep.column("grip")[place.good]
        for sweep, place in zip(sweeps, places, strict=True)
    )
    kept = float(np.mean([s.smooth["force"].leverage for s in sweeps]))
    wander = kept * force.slow_variance / linkage.ratio**2
    drift = grip.drift**2 + (force.drift / linkage.ratio) ** 2
    play = (LINKAGE * problem.full_scale[Signal.GRIP]) ** 2
    slow = (wander + drift + play) ** 0.5
    std = min(grip.std, own.std)
    return noises | {Signal.GRIP: Noise(std, own.correlation, slow, WANDERS)}
