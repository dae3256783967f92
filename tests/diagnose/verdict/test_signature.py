from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.verdict.artefact import Jump
from gripperd.diagnose.verdict.conclude import Conclusion, Verdict
from gripperd.diagnose.verdict.signature import signature
from gripperd.diagnose.verdict.structure import Structure
from gripperd.model.effect import Signal


def _view(
    along: str, p_value: float, signal: Signal = Signal.FORCE, share: float = 0.1
) -> Structure:
    return Structure(signal, along, 10.0, p_value, 0.01, share)


@pytest.fixture(scope="module")
def unnamed(told: Diagnosis) -> Contest:
    return Contest(told.found.null)


def _words(problem: Problem, best: Contest, *left: Structure) -> tuple[str, ...]:
    return signature(problem, best, Conclusion(Verdict.UNEXPLAINED, left, 0.42))


def test_what_it_depends_on_and_what_not_is_told(
    blank: Problem, unnamed: Contest
) -> None:
    words = _words(
        blank, unnamed, _view("contraction", 1e-30), _view("temperature", 0.4)
    )
    assert "force: depends on contraction" in words
    assert "force: not on temperature" in words


def test_a_wave_is_told_only_when_there_is_one(
    blank: Problem, unnamed: Contest
) -> None:
    wave = "time, at 1.7 Hz"
    assert f"force: depends on {wave}" in _words(blank, unnamed, _view(wave, 1e-30))
    assert not any("Hz" in word for word in _words(blank, unnamed, _view(wave, 0.4)))


def test_what_swings_in_time_is_not_said_to_be_independent_of_it(
    blank: Problem, unnamed: Contest
) -> None:
    words = _words(blank, unnamed, _view("time, at 0.8 Hz", 1e-30), _view("time", 0.4))
    assert "force: not on time" not in words


def test_what_is_neither_clear_nor_absent_is_not_told(
    blank: Problem, unnamed: Contest
) -> None:
    words = _words(blank, unnamed, _view("contraction", 1e-30), _view("time", 1e-3))
    assert not any("time" in word for word in words)


def test_a_signal_without_structure_is_not_mentioned(
    blank: Problem, unnamed: Contest
) -> None:
    words = _words(
        blank,
        unnamed,
        _view("contraction", 1e-30),
        _view("current", 0.5, Signal.PRESSURE),
    )
    assert not any(word.startswith("pressure") for word in words)


def test_a_single_wave_is_called_so(blank: Problem, unnamed: Contest) -> None:
    words = _words(blank, unnamed, _view("time", 1e-30, share=0.9))
    assert "force: depends on time, as one wave" in words


def test_the_share_that_is_explained_comes_first(
    blank: Problem, unnamed: Contest
) -> None:
    words = _words(blank, unnamed, _view("time", 1e-30))
    assert "42%" in words[0]
    assert not any("nearest" in word for word in words)


def test_the_nearest_known_effects_are_named(told: Diagnosis, blank: Problem) -> None:
    best = replace(told.contest, places=(Place(told.found.null),))
    words = _words(blank, best, _view("time", 1e-30))
    assert "nearest known effects: threshold pressure" in words


def test_a_wrong_constant_comes_without_its_path(
    told: Diagnosis, blank: Problem
) -> None:
    wrong = replace(
        told.contest.best, candidates=(Candidate("parameter:muscle.diameter", None, 0),)
    )
    words = _words(blank, Contest(wrong), _view("time", 1e-30))
    assert "nearest known effects: a wrong diameter" in words


def test_a_jump_is_told_with_its_size_and_time(
    blank: Problem, unnamed: Contest
) -> None:
    left = Conclusion(Verdict.UNEXPLAINED, (), 0.42)
    words = signature(blank, unnamed, left, Jump(size=-39.6, at=309.4))
    assert words[-1] == "force: jumps by -39.6 N at 309 s, and stays"
    assert not any("jump" in word for word in signature(blank, unnamed, left))


@pytest.mark.parametrize(
    ("along", "signal", "said"),
    [
        ("cells", Signal.FORCE, "pressure and contraction together"),
        ("cells", Signal.PRESSURE, "current and contraction together"),
        (
            "pressure x direction",
            Signal.FORCE,
            "pressure times the direction of travel",
        ),
    ],
)
def test_ways_of_looking_have_plain_words(
    blank: Problem, unnamed: Contest, along: str, signal: Signal, said: str
) -> None:
    words = _words(blank, unnamed, _view(along, 1e-30, signal))
    assert f"{signal.value}: depends on {said}" in words
