"""What nobody could name, in words: what it depends on and what it does not."""

from collections.abc import Iterator

from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.price import SEEN, size_of
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.artefact import Artefact
from gripperd.diagnose.verdict.conclude import Conclusion
from gripperd.diagnose.verdict.key import plain
from gripperd.diagnose.verdict.structure import Structure
from gripperd.model.effect import Signal

CLEAR = 1e-6
"""Chance below which a dependence is told."""
LINE = 0.5
"""Share of one wave from which a dependence is called periodic. [-]"""


def signature(
    problem: Problem,
    best: Contest,
    conclusion: Conclusion,
    artefact: Artefact | None = None,
) -> tuple[str, ...]:
    """Describe what is left, most telling first.

    Parameters
    ----------
    problem
        The recording and the model.
    best
        What came nearest.
    conclusion
        What is left beside it.
    artefact
        What explains more than any effect, if anything does.
    """
    words = [f"share of the gap that known effects explain: {conclusion.share:.0%}"]
    if best.best.names:
        nearest = ", ".join(map(plain, best.best.names))
        words.append(f"nearest known effects: {nearest}")
        if size_of(problem, best.best, best.best.names, problem.signals) < SEEN:
            words.append(
                f"they change no reading by {SEEN:.1%} of full scale, and a sound"
                " sensor drifts nearly as much"
            )
    if artefact:
        # By the clock of the file, as everything else that is told of it.
        told = artefact.told(problem.courses[0].start)
        words.append(f"{artefact.signal.value}: {told}")
    for signal in problem.signals:
        views = [one for one in conclusion.left if one.signal is signal]
        words += _told(signal.value, views)
        words += _odd(signal, conclusion)
    return tuple(words)


def _odd(signal: Signal, conclusion: Conclusion) -> Iterator[str]:
    """What of a signal is no noise, in whatever order it is, or took no part."""
    if signal in conclusion.louder:
        times = conclusion.louder[signal]
        yield f"{signal.value}: {times:.1f} times as loud as its noise"
    if signal in conclusion.bursts:
        count = conclusion.bursts[signal]
        yield f"{signal.value}: {count} bursts, far off for a while each"
    if signal in conclusion.alone:
        newtons = conclusion.alone[signal]
        yield (
            f"{signal.value}: {newtons:.1f} N off, over sweeps in which the force that"
            " it follows is not"
        )
    if signal in conclusion.left_out:
        times = conclusion.left_out[signal]
        yield f"{signal.value}: {times:.1f} times its noise in what took no part"


def _told(signal: str, views: list[Structure]) -> list[str]:
    clear = [one for one in views if one.p_value < CLEAR]
    if not clear:
        return []
    words = [
        f"{signal}: depends on {_spelt(one)}"
        + (", as one wave" if one.share > LINE else "")
        for one in clear
    ]
    # A wave in time is a dependence on it, whatever its slow part is.
    plain = {one.along.partition(",")[0] for one in clear}
    words += [
        f"{signal}: not on {_spelt(one)}"
        for one in views
        if one.p_value > 0.01 and one.along not in plain and "Hz" not in one.along
    ]
    return words


def _spelt(view: Structure) -> str:
    """What a person calls a way of looking at it."""
    if view.along == "cells":
        first = "current" if view.signal is Signal.PRESSURE else "pressure"
        return f"{first} and contraction together"
    return view.along.replace(" x direction", " times the direction of travel")
