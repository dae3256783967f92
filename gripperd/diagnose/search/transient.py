"""Transients: what goes on after a step, far below what a model misses, and its causes.

A transient is held against the noise about a level of its own, for the level is what a
model misses.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from gripperd.diagnose.fit.candidates import Candidate, surprise
from gripperd.diagnose.fit.cross_validation import bears_out
from gripperd.diagnose.fit.design import Member, design
from gripperd.diagnose.fit.inflation import deflated
from gripperd.diagnose.fit.polish import Polished, polished
from gripperd.diagnose.fit.rival import Rival, added, fitted, larger, removed
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.dwell import dwelling, misfit, stilled
from gripperd.diagnose.search.finalists import leaders
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.needed import needed, without_each
from gripperd.diagnose.search.preference import strained
from gripperd.diagnose.search.price import LEAST_MORE, MUCH, is_fault
from gripperd.diagnose.search.rivalry import SURE, Contest, Place
from gripperd.diagnose.search.step_response import closes_responses, with_responses
from gripperd.model.effect import Signal

NEXT = 2
"""Effects of another kind that are fitted in full."""
FORMS = 4
"""Forms of one cause that are: between a dead time and a lag lies a ridge."""


class Transient(NamedTuple):
    """What a signal does after a step, and what may explain it."""

    signal: Signal
    causes: frozenset[str]
    within: Callable[[Problem, Point, Noise], Problem]
    """Gives the problem with the stretches in which it shows."""
    explained: Callable[[Problem, Polished, Polished], bool]
    """Whether enough of it is gone from one fit to the next."""


TRANSIENTS = (
    Transient(
        Signal.FORCE, frozenset({"creep", "force_sensor_drift"}), dwelling, stilled
    ),
    Transient(
        Signal.PRESSURE,
        frozenset({"valve_lag", "channel_delay"}),
        with_responses,
        closes_responses,
    ),
)


def with_transients(
    found: Found,
    best: Contest,
    listed: Sequence[Candidate],
    noises: Mapping[Signal, Noise],
) -> tuple[Found, Contest]:
    """Add the effects by which pressure and force go on changing after a step.

    Far above the noise the search does not hear them: they are small beside the level
    that the model misses. But that level stays while the command rests. An effect
    that takes much of what the levels are off goes before it, and is told only with it.
    What was told before and is idle beside them is told no more.

    Parameters
    ----------
    found, best
        The search and its outcome.
    listed
        What could be missing.
    noises
        Of each signal, as identified. [SI]

    Returns
    -------
    The search, with the noise and the stretches that transients are judged by, and its
    outcome; both as they came where no transient tells anything.
    """
    # Of a level of its own nothing follows for what the rest of the model means.
    usual = [one for one in listed if not (one.effect and surprise(one.effect))]
    for kind in TRANSIENTS:
        found, best = _with(kind, found, best, usual, noises)
    return found, best


def _with(
    kind: Transient,
    found: Found,
    best: Contest,
    listed: Sequence[Candidate],
    noises: Mapping[Signal, Noise],
) -> tuple[Found, Contest]:
    problem = _judging(kind, found.problem, best.best, noises)
    if problem is None:
        return found, best
    here = Rival(best.best.candidates, polished(problem, best.best.fit.point))
    tried = [here]
    lasting, others = _grown(kind, problem, here, listed)
    # Once: two names in all are as many as a measured muscle has needed.
    if others and _takes_its_share(kind, problem, here, others[0]):
        here = others[0]
        tried.append(here)
        lasting, others = _grown(kind, problem, here, listed)
    going = [rival for rival in lasting if _accounts(kind, problem, here, rival)]
    if not going:
        return found, best
    # A form that other sweeps foretell goes before one that fits these better.
    before = here.fit
    going.sort(key=lambda one: not bears_out(problem, before, one.fit, [kind.signal]))
    without = without_each(problem, going[0])
    told, without = needed(problem, going[0], without, found.threshold)
    own, *alike = (rival.candidates[-1] for rival in _first_forms(going))
    if own not in told.candidates:
        return found, best
    stand_ins = _stand_ins(best) | {own: alike}
    causes = _first_forms((*going, *lasting))
    rivals = sorted((*tried, *causes, *others), key=lambda rival: -rival.evidence)
    places = (
        Place(bare, tuple(_weighed(problem, told, index, stand_ins.get(one, []))))
        for index, (one, bare) in enumerate(zip(told.candidates, without, strict=True))
    )
    return (
        replace(found, problem=problem, best=told, rivals=tuple(rivals)),
        Contest(told, tuple(places)),
    )


def _judging(
    kind: Transient, problem: Problem, told: Rival, noises: Mapping[Signal, Noise]
) -> Problem | None:
    """Give the problem with the stretches that judge a transient, if one is asked for.

    None is near the noise, where the search hears it, beside a cause that is told
    already, and where nothing rests long enough.
    """
    near = problem.inflation([kind.signal]) <= 1
    known = any(_is_cause(kind, one) for one in told.candidates)
    # Tolerances that are too tight are one finding, of which nothing can be dropped.
    if near or known or not told.candidates or told.fit.point.looser:
        return None
    lower = deflated(problem, told.fit)
    judging = kind.within(lower, told.fit.point, noises[kind.signal])
    return None if judging is lower else judging


def _grown(
    kind: Transient, problem: Problem, here: Rival, listed: Sequence[Candidate]
) -> tuple[list[Rival], list[Rival]]:
    """Give it with each cause that it lacks, and with the leading others."""
    around = design(problem, here.fit.point, listed)
    evidence = {one: around.fit(one).evidence for one in around.members}
    ranked = sorted(evidence, key=lambda one: -evidence[one])
    causes: dict[str, list[Member]] = {}
    for one in ranked:
        if _is_cause(kind, one.candidate):
            causes.setdefault(one.candidate.name, []).append(one)
    forms = [one for own in causes.values() for one in own[:FORMS]]
    others = [one for one in leaders(evidence) if not _is_cause(kind, one.candidate)]
    return _fitted(problem, here, forms), _fitted(problem, here, others[:NEXT])


def _first_forms(rivals: Iterable[Rival]) -> list[Rival]:
    """Give the first form of each cause: its other forms are no rivals of it."""
    found: dict[str, Rival] = {}
    for rival in rivals:
        found.setdefault(rival.candidates[-1].name, rival)
    return list(found.values())


def _is_cause(kind: Transient, candidate: Candidate) -> bool:
    """Whether a candidate may be why the signal goes on changing."""
    effect = candidate.effect
    named = candidate.name in kind.causes
    return named and effect is not None and effect.signal is kind.signal


def _fitted(problem: Problem, here: Rival, more: Sequence[Member]) -> list[Rival]:
    """Give it with one more, best first."""
    found = larger(problem, here, [one.candidate for one in more])
    return sorted(found, key=lambda rival: -rival.evidence)


def _accounts(kind: Transient, problem: Problem, here: Rival, larger: Rival) -> bool:
    """Whether the dwells tell a cause, and much of what they do is gone with it.

    One that has but the levels to explain lets the dwells drift as before, or more. One
    that a limit of physics holds back stands for something else.
    """
    points = here.fit.point, larger.fit.point
    before, after = (misfit(problem, point, kind.signal) for point in points)
    if min(0.5 * (before - after), larger.evidence - here.evidence) <= LEAST_MORE:
        return False
    explained = kind.explained(problem, here.fit, larger.fit)
    cause = larger.candidates[-1].name
    sound = is_fault(problem, larger) and not strained(problem, larger, [cause])
    return explained and sound


def _takes_its_share(
    kind: Transient, problem: Problem, here: Rival, larger: Rival
) -> bool:
    """Whether an effect takes much of what is left of the signal beside the dwells."""
    before, after = (
        one.fit.misfits[kind.signal] - misfit(problem, one.fit.point, kind.signal)
        for one in (here, larger)
    )
    takes_much = before - after > MUCH * before
    return takes_much and bears_out(problem, here.fit, larger.fit, [kind.signal])


def _stand_ins(best: Contest) -> dict[Candidate, list[Candidate]]:
    """What fitted as well in the place of each candidate."""
    return {
        one: [rival.candidates[index] for rival in place.rivals]
        for index, (one, place) in enumerate(
            zip(best.best.candidates, best.places, strict=True)
        )
    }


def _weighed(
    problem: Problem, told: Rival, index: int, stand_ins: Sequence[Candidate]
) -> Iterator[Rival]:
    """Give what fits as well in a place."""
    bare = removed(problem, told.fit.point, told.candidates[index])
    before, after = told.candidates[:index], told.candidates[index + 1 :]
    starts = [
        ((*before, one, *after), added(bare, one))
        for one in stand_ins
        if one.name not in told.names
    ]
    for rival in fitted(problem, starts):
        if told.evidence - rival.evidence < SURE:
            yield rival
