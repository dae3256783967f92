from dataclasses import replace

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.gap import Gap
from gripperd.diagnose.verdict.judged import bearing_signals
from gripperd.effects.creep import Creep
from gripperd.effects.tapered_ends import TaperedEnds
from gripperd.effects.valve_lag import ValveLag
from gripperd.model.effect import Effect, Signal

OPEN, CLOSED = 3.0, 1.0
"""Residual of better constants, over the noise."""


def _judged(pressure: float, force: float) -> dict[Signal, Gap]:
    return {
        signal: Gap(signal, left, left, 1.0, 1.0, (0.9, 1.1))
        for signal, left in ((Signal.PRESSURE, pressure), (Signal.FORCE, force))
    }


def _bearing(
    told: Diagnosis, judged: dict[Signal, Gap], main: Signal, *effects: Effect
) -> set[Signal]:
    named = tuple(Candidate(one.name, one) for one in effects)
    best = Contest(replace(told.contest.best, candidates=named))
    count = len(effects)
    return {*bearing_signals(told.split.train, best, count, main, judged)}


def test_of_few_effects_the_main_signal_bears_out(told: Diagnosis) -> None:
    few = (Creep(slow=0.02), ValveLag(share=0.5))
    judged = _judged(OPEN, OPEN)
    assert _bearing(told, judged, Signal.FORCE, *few) == {Signal.FORCE}


def test_what_no_effect_touches_bears_nothing_out(told: Diagnosis) -> None:
    judged = _judged(OPEN, CLOSED)
    assert _bearing(told, judged, Signal.PRESSURE, Creep(slow=0.02)) == {Signal.FORCE}


def test_of_a_crowd_every_signal_bears_out_that_it_touches(told: Diagnosis) -> None:
    """A wrong sensor is imitated by a bent valve, and by what bends the muscle."""
    judged = _judged(OPEN, OPEN)
    crowd = (ValveLag(share=0.5), Creep(slow=0.02), TaperedEnds(excess=0.1))
    told_of = _bearing(told, judged, Signal.PRESSURE, *crowd)
    assert told_of == {Signal.PRESSURE, Signal.FORCE}
    muscle = (Creep(slow=0.02), TaperedEnds(excess=0.1), Creep(slow=0.02))
    assert _bearing(told, judged, Signal.FORCE, *muscle) == {Signal.FORCE}
