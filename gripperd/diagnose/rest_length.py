"""The rest length that a recorded contraction refers to, when it may be another."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rival import Rival
from gripperd.diagnose.rivalry import Contest, contest
from gripperd.diagnose.search import search

LOOSE = 0.0125
"""Stated tolerance of the rest length from which its zero is open. [-]"""


def length_is_open(
    train: Problem, best: Contest, tolerances: Mapping[str, float]
) -> bool:
    """Whether the zero of the recorded contraction is as uncertain as the rest length.

    A recorder that counts from a rest length it does not know shifts every contraction.

    Parameters
    ----------
    train
        The recording and the model.
    best
        Who explains it.
    tolerances
        One sigma by path, as the model file states them. [SI]
    """
    sigma = tolerances.get("muscle.rest_length", 0.0)
    loose = sigma > LOOSE * train.model.muscle.rest_length
    return bool(best.best.candidates) and loose and train.model.told_length is None


def with_other_length(
    train: Problem,
    best: Contest,
    listed: Sequence[Candidate],
    rng: np.random.Generator,
) -> Contest:
    """Search again with the zero of contraction open; who leads then is a rival.

    Parameters
    ----------
    train
        The recording and the model.
    best
        The contest with the zero as it was told.
    listed
        What could be missing.
    rng
        For the recordings without a discrepancy.
    """
    told = replace(train.model, told_length=train.model.muscle.rest_length)
    other = contest(search(replace(train, model=told), listed, rng), listed)
    leaders = other.best.candidates[:1]
    if not leaders or leaders[0].name in {best.best.names[0], *best.equivalents[0]}:
        return best
    rival = Rival((*leaders, *best.best.candidates[1:]), other.best.fit)
    return replace(best, rivals=((*best.rivals[0], rival), *best.rivals[1:]))
