"""The examiner is examined: what counts as right, and how sure a share is."""

from collections import Counter
from dataclasses import replace

import pytest

from tests.exam.answer import Answer, Entry, Hidden, Residue
from tests.exam.marks import (
    Mark,
    alarmed,
    both,
    closed,
    confident,
    exact,
    harmed,
    misled,
    spoilt,
    staged,
    within,
    worsened,
)
from tests.exam.peers.classes import FAMILIES, family
from tests.exam.question import MIXTURE, Question, questions
from tests.hidden_rig import NAMES


def answer(
    verdict: str, *classes: str, truth: str = "creep", kind: str = "single"
) -> Answer:
    """An answer; ``a~b`` names a with the equivalent b."""
    split = [one.split("~") for one in classes]
    return Answer(
        Question("A", kind, tuple(truth.split()), 1),
        tuple(Hidden(name, "muscle", "force", 0.03) for name in truth.split()),
        verdict,
        tuple(Entry(name, "muscle", tuple(others)) for name, *others in split),
        "force",
    )


def test_an_exact_answer_has_one_name_and_leaves_nothing_open() -> None:
    assert exact(answer("named", "creep"))
    assert exact(answer("named", "creep", "parameter:muscle.diameter"))
    assert not exact(answer("named", "creep", "fatigue"))
    assert not exact(answer("named", "fatigue"))
    assert not exact(answer("ambiguous", "creep~fatigue"))
    assert not exact(answer("unexplained", "creep"))


def test_a_class_of_four_is_too_large() -> None:
    assert within(answer("ambiguous", "fatigue~creep~leak"))
    assert not within(answer("ambiguous", "fatigue~creep~leak~valve_lag"))
    assert not within(answer("unexplained", "creep"))


def test_two_effects_need_two_entries() -> None:
    assert both(answer("named", "leak", "creep", truth="creep leak"))
    assert both(answer("named", "leak", "x", "creep", truth="creep leak"))
    assert not both(answer("ambiguous", "creep~leak", truth="creep leak"))
    assert not both(answer("ambiguous", "creep~leak", "x", truth="creep leak"))


def test_the_stage_counts_when_the_name_is_wrong() -> None:
    assert staged(answer("named", "fatigue"))
    assert not staged(answer("none"))


def test_a_better_constant_is_no_false_alarm() -> None:
    assert not alarmed(answer("none"))
    assert not alarmed(answer("named", "parameter:muscle.diameter"))
    assert alarmed(answer("ambiguous", "creep~fatigue"))
    assert alarmed(answer("unexplained"))


def test_confidence_needs_the_verdict_named() -> None:
    assert confident(answer("named", "creep"))
    assert not confident(answer("ambiguous", "creep~fatigue"))


def test_an_offset_between_channels_may_be_called_one() -> None:
    def said(name: str) -> Answer:
        return answer("named", name, truth="offset_80ms", kind="artefact")

    assert not misled(said("channel_delay"))
    assert misled(said("viscous_friction"))


@pytest.mark.parametrize(("after", "worse"), [(10.05, False), (10.2, True)])
def test_worse_is_more_than_one_percent(after: float, worse: bool) -> None:
    one = answer("named", "creep")
    gaps = {"force": Residue(20.0, 10.0, after, 5.0, 5.0)}
    assert worsened(Answer(one.question, gaps=gaps)) is worse


@pytest.mark.parametrize(("signal", "worse"), [("force", True), ("grip", False)])
def test_another_signal_that_is_worse_is_not_the_spoilt_one(
    signal: str, worse: bool
) -> None:
    one = answer("named", "creep")
    level = Residue(20.0, 10.0, 10.0, 5.0, 5.0)
    gaps = {"force": level, "grip": level} | {signal: replace(level, after=10.2)}
    again = replace(one, gaps=gaps)
    assert worsened(again)
    assert spoilt(again) is worse


@pytest.mark.parametrize(("floor", "harm"), [(8.0, True), (9.0, False)])
def test_what_is_worse_within_the_noise_does_no_harm(floor: float, harm: bool) -> None:
    one = answer("named", "creep")
    gaps = {"grip": Residue(20.0, 10.0, 10.2, floor, 5.0)}
    again = replace(one, gaps=gaps)
    assert worsened(again)
    assert harmed(again) is harm


@pytest.mark.parametrize(
    ("signal", "after", "met"),
    [("force", 5.7, True), ("force", 5.8, False), ("opening", 1.0, False)],
)
def test_a_gap_counts_in_the_signal_of_the_effect(
    signal: str, after: float, met: bool
) -> None:
    gaps = {signal: Residue(20.0, 10.0, after, 5.0, 5.0)}
    one = answer("named", "creep")
    assert closed(Answer(one.question, one.hidden, main=signal, gaps=gaps)) is met


@pytest.mark.parametrize("cases", [20, 299])
def test_no_error_in_n_cases_leaves_room_for_some(cases: int) -> None:
    # Clopper and Pearson for 0 of n in closed form: 1 - (0.025)^(1/n).
    low, high = Mark("", 0.02, at_least=False, hits=0, total=cases).interval
    assert low == 0
    assert high == pytest.approx(1 - 0.025 ** (1 / cases))


def test_a_goal_inside_the_interval_stays_open() -> None:
    assert Mark("", 0.9, at_least=True, hits=19, total=20).verdict == "met (open)"
    assert Mark("", 0.9, at_least=True, hits=10, total=20).verdict == "missed"
    assert Mark("", 0.1, at_least=False, hits=10, total=20).verdict == "missed"


def test_every_beginning_of_a_mixture_is_a_mixture() -> None:
    asked = questions("A", 198, seed=4)
    assert Counter(one.kind for one in asked) == MIXTURE
    assert questions("A", 50, seed=4) == asked[:50]
    first = [one.names[0] for one in asked if one.kind == "single"][: len(NAMES)]
    assert set(first) == set(NAMES)


def test_every_effect_has_a_family() -> None:
    assert frozenset().union(*FAMILIES.values()) == set(NAMES)


@pytest.mark.parametrize(
    ("signal", "importance", "named"),
    [
        ("force", {"pressure": 0.7, "contraction": 0.2, "time": 0.1}, "pressure"),
        ("force", {"pressure": 0.6, "contraction": 0.0, "time": 0.4}, "time"),
        ("pressure", {"current": 0.9, "direction": 0.1}, "valve curve"),
        ("pressure", {"current": 0.5, "direction": 0.5}, "valve memory"),
        ("grip", {"force": 1.0}, "gripper"),
    ],
)
def test_a_family_follows_from_what_a_correction_leans_on(
    signal: str, importance: dict[str, float], named: str
) -> None:
    assert family(signal, importance) == named
