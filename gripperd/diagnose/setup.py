"""From a recording and a model to the problem: constants, noise, drift."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.grasp import with_held_way
from gripperd.diagnose.readings.jaws import through_jaws, told_by_jaws
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.coherent import check_coherent
from gripperd.diagnose.residuals.constants import constants
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.heard import with_heard_lengths
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.loudness import audible, noises_of
from gripperd.diagnose.residuals.plausible import check_judged, check_plausible
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.slack import zero_of_slack
from gripperd.diagnose.residuals.stages import INPUTS
from gripperd.model.effect import Signal

SLACK = 4.5
"""Standard deviations below which a force is not told from none."""
ROUNDS = 2
"""After so many a noise changes by less than a millionth. [-]"""
MOST_SLACK = 0.125
"""Share of the largest force from which a muscle is taut, whatever the noise. [-]"""


def problem_of(
    recording: Recording,
    model: Explanation,
    tolerances: Mapping[str, float],
    processes: int = 1,
) -> Problem:
    """Set up the diagnosis of one recording.

    Parameters
    ----------
    recording
        Screened.
    model
        At its nominal constants.
    tolerances
        One sigma by path, as the model file states them. [SI]
    processes
        How many share the work, of this and of what is done with the problem.

    Raises
    ------
    InputError
        When the recording cannot be about such a model.
    """
    length = model.muscle.rest_length
    if not recording.has("contraction") and recording.has("length"):
        model = replace(model, told_length=length)
    elif told_by_jaws(recording, model.linkage):
        assert model.linkage is not None
        recording = through_jaws(recording, model.linkage, length)
        model = replace(model, told_length=length, told_by=model.linkage)
    sweeps, noises = courses(recording, length, processes)
    if model.told_by is not None and "grip" in noises:
        sweeps = tuple(with_held_way(sweep, noises["grip"]) for sweep in sweeps)
    if any(sweep.yields for sweep in sweeps):
        # What is held there moves after all, and its friction turns round.
        model = replace(model, at_rest=AtRest.INFLATING)
    loud = {
        signal: audible(noises[signal.value], signal, sweeps)
        for signal in INPUTS
        if signal.value in noises
    }
    rough = _with_slack(Problem(sweeps, model, (), loud, processes=processes))
    check_plausible(rough, recording.name)
    check_coherent(rough, recording.name)
    # What is left out later must not even tell, by its misfit, how loud noise is.
    parts = split(rough)
    check_judged(parts, recording.name)
    scales = dict(parts.train.full_scale)
    if any("contraction" in sweep.measured for sweep in sweeps):
        scales[Signal.CONTRACTION] = 1.0
    resting = [i for i, sweep in enumerate(sweeps) if (sweep.direction == 0).sum() > 3]
    listed = constants(model, tolerances, scales, resting)
    start = Point(np.zeros(len(listed)))
    problem = replace(rough, constants=listed)
    problem = with_heard_lengths(problem, split(problem).train, start)
    for _ in range(2):
        train = split(problem).train
        null = polished(train, start).point
        problem = replace(problem, noises=_settled(train, null, loud, recording.noise))
    return problem


def _settled(
    train: Problem,
    null: Point,
    loud: Mapping[Signal, Noise],
    stated: Mapping[str, float],
) -> Mapping[Signal, Noise]:
    """Noise by signal: what a length makes of a force is held against the noise."""
    for _ in range(ROUNDS):
        train = replace(train, noises={**loud, **noises_of(train, null, stated)})
    return train.noises


def _with_slack(rough: Problem) -> Problem:
    """Tell below which force a muscle that cannot push may be slack.

    A rig that measures negative forces holds the muscle: then nothing is slack, unless
    it is the zero of its cell that is negative.
    """
    force = np.concatenate([sweep.column("force") for sweep in rough.courses])
    force = force[np.isfinite(force)]
    if not force.size:
        return rough
    top = float(np.max(force))
    # Neighbours in a coarse table differ by far more than noise.
    std = min(rough.noises[Signal.FORCE].std, MOST_SLACK / SLACK * top)
    pushes = bool(np.mean(force < -max(SLACK * std, 0.03 * top)) > 0.004)
    taut = max(SLACK * std, 0.015 * top)
    zero = zero_of_slack(rough, taut, pushes=pushes)
    if pushes and zero is None:
        return rough
    return replace(rough, slack=taut + (zero or 0.0), zero=zero or 0.0)
