"""What goes on after a step while the command rests, and what explains it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from gripperd.diagnose.candidates import Candidate
from gripperd.diagnose.crossing import bears_out
from gripperd.diagnose.design import Member, design
from gripperd.diagnose.dwell import drifted, dwelling, misfit
from gripperd.diagnose.finalists import leaders
from gripperd.diagnose.found import Found
from gripperd.diagnose.noise import Noise
from gripperd.diagnose.polish import polished
from gripperd.diagnose.price import LEAST_MORE, MUCH, is_fault
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rival import Rival, added
from gripperd.diagnose.rivalry import SURE, Contest, removed
from gripperd.diagnose.temperature import cooled
from gripperd.model.effect import Signal

LASTING = frozenset({"creep", "force_sensor_drift"})
"""Effects by which a force goes on changing while the command rests."""
NEXT = 2
"""Effects of another kind that are fitted in full."""


def with_aftermath(
    found: Found,
    best: Contest,
    listed: Sequence[Candidate],
    noises: Mapping[Signal, Noise],
) -> tuple[Found, Contest]:
    """Add the effect by which the force goes on changing after a step.

    Far above the noise the search does not hear it: it is small beside the level that
    the model misses. But that level stays the same while the command rests. An effect
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
    """
    here = best.best
    if found.problem.temperature([Signal.FORCE]) <= 1 or not here.candidates:
        return found, best
    point = here.fit.point
    # Tolerances that are too tight are one finding, of which nothing can be dropped.
    if point.looser:
        return found, best
    problem = dwelling(cooled(found.problem, here.fit), point, noises[Signal.FORCE])
    if not problem.dwells:
        return found, best
    here = Rival(here.candidates, polished(problem, point))
    tried = [here]
    lasting, others = _grown(problem, here, listed)
    # Once: two names in all are as many as a measured muscle has needed.
    if others and _takes_its_share(problem, here, others[0]):
        here = others[0]
        tried.append(here)
        lasting, others = _grown(problem, here, listed)
    going = [rival for rival in lasting if _goes_on(problem, here, rival)]
    if not going:
        return found, best
    told, without = _needed(problem, going[0], found.threshold)
    own, *alike = (rival.candidates[-1] for rival in going)
    if own not in told.candidates:
        return found, best
    stand_ins = _stand_ins(best) | {own: alike}
    rivals = sorted((*tried, *lasting, *others), key=lambda rival: -rival.evidence)
    return (
        replace(found, problem=problem, best=told, rivals=tuple(rivals)),
        Contest(
            told,
            without,
            tuple(
                tuple(_weighed(problem, told, place, stand_ins.get(one, [])))
                for place, one in enumerate(told.candidates)
            ),
        ),
    )


def _grown(
    problem: Problem, here: Rival, listed: Sequence[Candidate]
) -> tuple[list[Rival], list[Rival]]:
    """Give it with each lasting effect that it lacks, and with the leading others."""
    around = design(problem, here.fit.point, listed)
    ranked = leaders({one: around.fit(one).evidence for one in around.members})
    lasting = [one for one in ranked if one.candidate.name in LASTING]
    others = [one for one in ranked if one.candidate.name not in LASTING]
    return _fitted(problem, here, lasting), _fitted(problem, here, others[:NEXT])


def _fitted(problem: Problem, here: Rival, more: Sequence[Member]) -> list[Rival]:
    """Give it with one more, best first."""
    found = [
        Rival(
            (*here.candidates, one.candidate),
            polished(problem, added(here.fit.point, one.candidate)),
        )
        for one in more
    ]
    return sorted(found, key=lambda rival: -rival.evidence)


def _goes_on(problem: Problem, here: Rival, larger: Rival) -> bool:
    """Whether the dwells tell an effect, and much of their drift is gone with it.

    One that has but the levels to explain lets the dwells drift as before, or more.
    """
    points = here.fit.point, larger.fit.point
    before, after = (misfit(problem, point) for point in points)
    if min(0.5 * (before - after), larger.evidence - here.evidence) <= LEAST_MORE:
        return False
    before, after = (drifted(problem, point) for point in points)
    takes_much = before - after > MUCH * before
    return (
        takes_much
        and is_fault(problem, larger)
        and bears_out(problem, here.fit, larger.fit, [Signal.FORCE])
    )


def _takes_its_share(problem: Problem, here: Rival, larger: Rival) -> bool:
    """Whether an effect takes much of what is left of the force beside the dwells."""
    before, after = (
        one.fit.misfits[Signal.FORCE] - misfit(problem, one.fit.point)
        for one in (here, larger)
    )
    takes_much = before - after > MUCH * before
    return takes_much and bears_out(problem, here.fit, larger.fit, [Signal.FORCE])


def _needed(
    problem: Problem, told: Rival, threshold: float
) -> tuple[Rival, tuple[Rival, ...]]:
    """Drop what is idle beside the rest, and give it without each that is not."""
    without = tuple(_without(problem, told))
    while len(told.candidates) > 1:
        idle = max(without, key=lambda one: one.evidence)
        if told.evidence - idle.evidence > threshold:
            break
        told, without = idle, tuple(_without(problem, idle))
    return told, without


def _without(problem: Problem, told: Rival) -> Iterator[Rival]:
    """Give it without each of its candidates."""
    for index, own in enumerate(told.candidates):
        rest = (*told.candidates[:index], *told.candidates[index + 1 :])
        point = removed(problem, told.fit.point, own)
        yield Rival(rest, polished(problem, point))


def _stand_ins(best: Contest) -> dict[Candidate, list[Candidate]]:
    """What fitted as well in the place of each candidate."""
    return {
        one: [rival.candidates[place] for rival in rivals]
        for place, (one, rivals) in enumerate(
            zip(best.best.candidates, best.rivals, strict=True)
        )
    }


def _weighed(
    problem: Problem, told: Rival, place: int, stand_ins: Sequence[Candidate]
) -> Iterator[Rival]:
    """Give what fits as well in a place."""
    bare = removed(problem, told.fit.point, told.candidates[place])
    for one in stand_ins:
        if one.name in told.names:
            continue
        candidates = (*told.candidates[:place], one, *told.candidates[place + 1 :])
        rival = Rival(candidates, polished(problem, added(bare, one)))
        if told.evidence - rival.evidence < SURE:
            yield rival
