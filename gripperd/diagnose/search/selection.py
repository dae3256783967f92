"""The whole selection of a model: search, rivals, and what only then can be asked."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.alike import with_rests_alike
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.overstepped import with_overstepped
from gripperd.diagnose.search.quick import with_quick_regulator
from gripperd.diagnose.search.reading import as_read
from gripperd.diagnose.search.rest_length import length_is_open, with_other_length
from gripperd.diagnose.search.resting import with_sign_beside
from gripperd.diagnose.search.rivalry import Contest, contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.search.stiction import with_stiction
from gripperd.diagnose.search.tolerances import with_usual_tolerances
from gripperd.diagnose.search.transient import with_transients
from gripperd.diagnose.search.vented import with_vented_zero

Progress: TypeAlias = Callable[[str, float], None]
"""Told what is being done, and the share that is done. [0..1]"""


@dataclass(frozen=True, slots=True)
class Selection:
    """The explanation that was selected, among which, and on which sweeps."""

    parts: Split
    """What was searched, and what was not, both read as the data support it."""
    found: Found
    contest: Contest


def selected(
    parts: Split,
    listed: Sequence[Candidate],
    tolerances: Mapping[str, float],
    rng: np.random.Generator,
    progress: Progress,
) -> Selection:
    """Select the explanation that the searched sweeps support best.

    Parameters
    ----------
    parts
        What is searched, and what is not.
    listed
        What could be missing.
    tolerances
        One sigma by path, as the model file states them. [SI]
    rng
        For the recordings without a discrepancy.
    progress
        Told how far it is.
    """
    progress("friction at rest, and valves", 0.2)
    train = as_read(parts.train, listed)
    progress("candidates, singles and pairs", 0.3)

    def searched(problem: Problem) -> Found:
        asked = replace(train, model=problem.model, constants=problem.constants)
        return search(asked, listed, rng)

    found = with_sign_beside(searched(train), listed, searched)
    if (other := with_vented_zero(found)) is not found.problem:
        found = searched(other)
    found = with_quick_regulator(found, searched)
    if (alike := with_rests_alike(found, searched)) is not found:
        # What signs of their own stood in for is found now, and stands beside another.
        found = with_sign_beside(alike, listed, searched)
    train = replace(train, model=found.problem.model, constants=found.problem.constants)
    test = replace(
        parts.test,
        model=train.model,
        constants=train.constants,
        courses=train.courses,
        band=train.band,
    )
    progress("rivals", 0.7)
    best = contest(found, listed)
    if length_is_open(train, best, tolerances):
        progress("rest length", 0.8)
        best = with_other_length(train, best, listed, rng)
    best = with_overstepped(found, best, listed)
    best = with_usual_tolerances(found, best)
    found, best = with_transients(found, best, listed, train.noises)
    best = with_stiction(found, best)
    return Selection(replace(parts, train=train, test=test), found, best)
