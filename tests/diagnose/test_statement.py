from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.readings.recording import Contradiction, Rejection
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.statement import offered, reasons, statement, summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.named import Estimate, Named
from gripperd.effects.creep import Creep
from gripperd.model.effect import Signal
from tests.demonstration import example
from tests.diagnose.offered import bump


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


def diameter(*equivalents: str) -> Named:
    return Named(
        "parameter:muscle.diameter", "-", None, "muscle.diameter",
        {"muscle.diameter": Estimate(18.3142e-3, 0.0937e-3)}, 178.0, Signal.FORCE,
        equivalents, 1e-20, -300.0, 0.5,
    )  # fmt: skip


def test_a_statement_says_how_it_shows_and_what_to_do(creep: Diagnosis) -> None:
    entry = replace(creep.named[0], size=12.04)
    assert statement(creep, entry) == (
        "The model lacks creep, worth 12 N of force (rms):"
        f" {Creep.shows}; so {Creep.remedy}."
    )


def test_a_wrong_constant_is_told_no_finer_than_it_is_known(creep: Diagnosis) -> None:
    assert statement(creep, diameter()) == (
        "The diameter is 18.314 ± 0.094 mm, not 20 mm; correct the model."
    )


def test_what_has_rivals_asks_for_no_remedy(creep: Diagnosis) -> None:
    rival = replace(creep.named[0], size=12.04, equivalents=("leak", "valve_lag"))
    assert statement(creep, rival) == (
        f"Perhaps creep, worth 12 N of force (rms): {Creep.shows};"
        " this recording cannot tell it from leak or valve lag."
    )
    assert statement(creep, diameter("braid_extensibility")) == (
        "Perhaps the diameter is 18.314 ± 0.094 mm, not 20 mm; this recording cannot"
        " tell it from braid extensibility."
    )


def test_of_tolerances_too_tight_no_constant_is_sure_alone(creep: Diagnosis) -> None:
    constants = len(creep.found.problem.constants)
    best = creep.contest.best
    point = replace(creep.explained, looser=(3.0,) * constants)
    best = replace(best, fit=replace(best.fit, point=point))
    rival, sure = diameter("tapered_ends"), diameter()
    tight = replace(
        creep,
        verdict=Verdict.AMBIGUOUS,
        named=(rival, sure),
        contest=replace(creep.contest, best=best),
    )
    assert statement(tight, sure) == (
        "Perhaps the diameter is 18.314 ± 0.094 mm, not 20 mm, with the others."
    )
    assert summary(tight).startswith(
        "The model is off, and tolerances tighter than its parts keep, and this"
        " recording cannot tell a wrong diameter from tapered ends;"
    )
    assert statement(replace(tight, named=(sure,)), sure) == (
        "The diameter is 18.314 ± 0.094 mm, not 20 mm; correct the model and its"
        " tolerance."
    )


def test_what_is_not_established_is_not_claimed(creep: Diagnosis) -> None:
    unexplained = replace(creep, verdict=Verdict.UNEXPLAINED)
    entry = replace(creep.named[0], size=12.04)
    assert statement(unexplained, entry) == (
        "Nearest, and not sure to be what is seen: creep, worth 12 N of force (rms)."
    )


def test_an_open_question_does_not_hide_what_is_sure(creep: Diagnosis) -> None:
    gap = replace(
        creep.gaps[Signal.FORCE], before=29.65, recalibrated=11.66, after=2.617,
        noise_floor=3.04,
    )  # fmt: skip
    sure = creep.named[0]
    lag = replace(sure, name="valve_lag", equivalents=("channel_delay",))
    two = replace(
        creep,
        verdict=Verdict.AMBIGUOUS,
        named=(sure, diameter("tapered_ends", "leak"), lag),
        gaps={Signal.FORCE: gap},
    )
    assert summary(two) == (
        "The model lacks creep, and this recording cannot tell a wrong diameter from"
        " tapered ends or leak, nor valve lag from channel delay; on data it never saw"
        " the force is off by 2.62 N instead of 29.6 N (11.7 N with better constants"
        " alone), and repeats by 3.04 N."
    )
    assert summary(replace(two, named=(lag,))).startswith(
        "The model is off, and this recording cannot tell valve lag from channel delay;"
    )


def test_what_is_unexplained_says_how_much_is_left(creep: Diagnosis) -> None:
    gap = replace(creep.gaps[Signal.FORCE], recalibrated=22.22, noise_floor=6.99)
    told = replace(creep, verdict=Verdict.UNEXPLAINED, gaps={Signal.FORCE: gap})
    assert summary(told) == (
        "The model is off, and no effect of the library is sure to explain it; with"
        " better"
        " constants the force is still off by 22.2 N on data it never saw, and repeats"
        " by 6.99 N."
    )
    assert summary(replace(told, main=None, named=())).endswith("explains it.")
    quiet = replace(told, gaps={Signal.FORCE: replace(gap, recalibrated=6.9)})
    assert summary(quiet).endswith(
        "is sure to explain it; the force of sweeps it never saw does not show it."
    )


def test_the_verdict_has_the_gap_before_and_after(creep: Diagnosis) -> None:
    gap = replace(
        creep.gaps[Signal.FORCE], before=29.65, recalibrated=11.66, after=2.617,
        noise_floor=3.04,
    )  # fmt: skip
    said = summary(replace(creep, gaps={Signal.FORCE: gap}))
    assert said == (
        "The model lacks creep; on data it never saw the force is off by 2.62 N"
        " instead of 29.6 N (11.7 N with better constants alone), and repeats by"
        " 3.04 N."
    )


def nothing_missing(creep: Diagnosis, moved: Mapping[str, float]) -> Diagnosis:
    """Nothing named, of some constants that have moved, in tolerances."""
    null, problem = creep.found.null, creep.found.problem
    constants = tuple(one for one in problem.constants if one.path in moved)
    point = Point(np.array([moved[one.path] for one in constants]))
    found = replace(
        creep.found,
        problem=replace(problem, constants=constants),
        null=replace(null, fit=replace(null.fit, point=point)),
    )
    gap = replace(creep.gaps[Signal.FORCE], before=17.7, recalibrated=4.86)
    return replace(
        creep, verdict=Verdict.NONE, named=(), found=found, gaps={Signal.FORCE: gap}
    )


def test_a_constant_that_moves_another_signal_is_not_what_closed_the_gap(
    creep: Diagnosis,
) -> None:
    moved = {"muscle.diameter": 1.0, "valve.pressure_high": 1.5}
    assert summary(nothing_missing(creep, moved)).startswith(
        "Nothing is missing: once constants move (diameter 20.23 mm instead of 20 mm"
        " first of all), what is left is noise; on data it never saw"
    )


def test_what_was_measured_and_not_compared_is_told(creep: Diagnosis) -> None:
    """A force without a contraction, and a grip of which no reading is good."""
    nothing = nothing_missing(creep, {})
    pressed = replace(nothing.gaps[Signal.FORCE], signal=Signal.PRESSURE)
    lost = replace(
        nothing.recording,
        rejected=(Rejection("steps", "grip_N", 300, "out of range"),),
    )
    valve = replace(
        nothing,
        gaps={Signal.PRESSURE: pressed},
        main=Signal.PRESSURE,
        recording=lost,
    )
    said = summary(valve)
    assert said.startswith("Nothing is missing: ")
    assert said.endswith("; the force and the grip could not be judged.")
    assert "judged" not in summary(nothing)


def test_nothing_is_not_sure_to_be_missing_where_more_than_noise_is_left(
    creep: Diagnosis,
) -> None:
    nothing = nothing_missing(creep, {})
    gap = replace(nothing.gaps[Signal.FORCE], recalibrated=4 * 4.86, after=4 * 4.86)
    said = summary(replace(nothing, gaps={Signal.FORCE: gap}))
    assert said.startswith(
        "Nothing is seen to be missing, but too little was left out to be sure; on data"
    )
    assert "noise" not in said


def test_without_a_constant_that_could_move_only_noise_is_told(
    creep: Diagnosis,
) -> None:
    assert summary(nothing_missing(creep, {"valve.pressure_high": 1.5})).startswith(
        "Nothing is missing: what is left is noise; on data it never saw"
    )


def test_of_one_run_the_rest_was_held_out_and_no_other_data(
    creep: Diagnosis,
) -> None:
    one = replace(creep.recording, runs=creep.recording.runs[:1])
    assert "; on the rest of its only run the force is off by" in summary(
        replace(creep, recording=one)
    )


def test_a_contradiction_says_what_contradicts_what(creep: Diagnosis) -> None:
    names = tuple("abcdef")
    found = Contradiction(names, ("x",), "force_N", -310.4, "N", 3.21)
    recording = replace(creep.recording, contradictions=(found,))
    said = summary(
        replace(creep, verdict=Verdict.UNUSABLE, named=(), recording=recording)
    )
    assert said == (
        "The recording contradicts itself, no verdict can rest on it: force_N of a, b,"
        " c, d and 2 more differs from that of x by 310 N at the same place, and"
        " repeats by 3.2 N."
    )


def test_a_correction_is_called_no_physics() -> None:
    assert offered(bump()) == (
        "A smooth correction of the force by pressure leaves 5 N of 20 N on data it"
        " never saw, of which 75% lie inside its fence; it is no physics, and no part"
        " of the model"
    )


def test_effects_not_tested_are_listed_by_the_reason(creep: Diagnosis) -> None:
    told = replace(
        creep,
        untested={"leak": "too short", "parameter:valve.pressure_low": "too short"},
    )
    assert reasons(told) == {"too short": ["leak", "parameter:valve.pressure_low_kPa"]}
