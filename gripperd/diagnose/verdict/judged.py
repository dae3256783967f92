"""Which of the signals that were left out the story is about, and which bear it out."""

from collections.abc import Collection, Mapping

from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.price import acts_on
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.gap import CROWD, Gap
from gripperd.model.effect import Signal, Stage


def main_signal(best: Contest, judged: Mapping[Signal, Gap]) -> Signal | None:
    """Give the signal of the first effect, else the one recalibration leaves worst.

    A sensor that errs shows in every stage that it touches, in one most. Without any
    effect the story is about the force, or the grip where no cell tells it.

    Parameters
    ----------
    best
        Outcome of the search.
    judged
        Gaps on what was left out.
    """
    effects = [one.effect for one in best.best.candidates if one.effect]
    for effect in effects:
        if effect.stage is not Stage.SENSOR and effect.signal in judged:
            return effect.signal
        if effect.stage is Stage.MUSCLE and Signal.GRIP in judged:
            return Signal.GRIP
    for pulled in (Signal.FORCE, Signal.GRIP) if not effects else ():
        if pulled in judged:
            return pulled
    return max(judged, key=lambda one: judged[one].left_open, default=None)


def open_signal(
    left: Collection[Signal], main: Signal | None, judged: Mapping[Signal, Gap]
) -> Signal | None:
    """Give the signal that nothing explains: the main one, if more than noise is left.

    Parameters
    ----------
    left
        Signals in which more than noise is left.
    main, judged
        What names were judged on, and how well.
    """
    if main in left:
        return main
    heard = [signal for signal in judged if signal in left]
    return max(heard, key=lambda one: judged[one].left_open, default=main)


def bearing_signals(
    problem: Problem,
    best: Contest,
    effects: int,
    main: Signal | None,
    judged: Mapping[Signal, Gap],
) -> tuple[Signal, ...]:
    """Give the signals that bear names out: what none of them touches says nothing.

    That is one of few effects. A crowd closes one signal by what it does in others, so
    that it is held to each.

    Parameters
    ----------
    problem, best
        The recording and the model, and the outcome of the search.
    effects
        How many are named, constants not counted.
    main, judged
        The signal the story is about, and gaps on what was left out.
    """
    candidates = best.best.candidates
    if not candidates:
        return (main,) if main else ()
    touched = {signal for one in candidates for signal in acts_on(problem, one)}
    heard = tuple(signal for signal in judged if signal in touched)
    if effects > CROWD or not heard:
        return heard
    if main in heard:
        return (main,)
    return (max(heard, key=lambda one: judged[one].left_open),)
