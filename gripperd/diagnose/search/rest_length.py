"""The rest length that a recorded contraction refers to, when it may be another.

References
----------
.. [1] R. E. Kass, A. E. Raftery, "Bayes factors", J. Am. Stat. Assoc. 90(430),
       773-795, 1995, section 3.2.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.search.stepwise import search

LOOSE = 0.0125
"""Stated tolerance of the rest length from which its zero is open. [-]"""
STRONG = 3.0
"""Gain from which evidence is strong [1]_; with less it is left open. [nat]"""


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
    other = search(replace(train, model=told), listed, rng)
    alone = [rival for rival in other.rivals if len(rival.candidates) == 1]
    known = {*best.best.names, *best.equivalents[0]}
    further: dict[str, Rival] = {}
    for rival in alone:
        name = rival.names[0]
        if alone[0].evidence - rival.evidence < STRONG and name not in known:
            stead = (rival.candidates[0], *best.best.candidates[1:])
            further.setdefault(name, Rival(stead, rival.fit))
    first, *others = best.places
    first = replace(first, rivals=(*first.rivals, *further.values()))
    return replace(best, places=(first, *others))
