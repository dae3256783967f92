from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.fit.polish import Polished, polished
from gripperd.diagnose.fit.rival import Rival, added
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.block import Block
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search import transient
from gripperd.diagnose.search.dwell import misfit
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, Place, contest
from gripperd.diagnose.search.step_response import with_responses
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.search.transient import with_transients
from gripperd.diagnose.setup import problem_of
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.valve_lag import ValveLag
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose import small
from tests.diagnose.small import MODEL, REGULATOR, Moment, nothing, pinned, textbook
from tests.diagnose.stepped import LENGTHS, PRESSURES

STEP, DWELL = 0.02, 3.0
"""Between samples, and between commands. [s]"""
NOISE = 300.0
"""Of the transducer. [Pa]"""
OPEN = ("response.valve", "zero.force")
START = Point(np.zeros(len(OPEN)))
OFFSET = (Candidate("valve_offset", ValveOffset(offset=20e3)),)
LATE = (
    *(Candidate("valve_lag", form) for form in forms(ValveLag)),
    *(
        Candidate("channel_delay", ChannelDelay(channel=channel))
        for channel in (Signal.PRESSURE, Signal.FORCE)
    ),
)


def _followed(asked: Array, dead_time: float, time: float) -> Array:
    """Two equal lags in a row after a dead time: not the form of the package."""
    late = np.concatenate([np.full(round(dead_time / STEP), asked[0]), asked])
    fine = np.repeat(late[: asked.size], 20)
    kept = np.exp(-STEP / 20 / time)
    for _ in range(2):
        level, out = fine[0], np.empty_like(fine)
        for index, goal in enumerate(fine.tolist()):
            level = goal + (level - goal) * kept
            out[index] = level
        fine = out
    return fine[::20]


def _recording(dead_time: float, time: float, dwell: float = DWELL) -> Recording:
    """Steps at held lengths; the regulator errs by an offset, and a wave besides."""
    runs = []
    for place, (length, levels) in enumerate(
        (length, levels) for length in LENGTHS for levels in PRESSURES
    ):
        random = np.random.default_rng([7, place])
        asked = np.repeat(levels, round(dwell / STEP))
        level = np.ones(asked.size)
        clock = 100.0 * place + STEP * np.arange(float(asked.size))
        reached = asked + 20e3 + 5e3 * np.sin(asked / 40e3)
        pressure = _followed(reached, dead_time, time)
        moment = Moment(clock, pressure, length * level, level)
        read = {
            "pressure": pressure + random.normal(0.0, NOISE, clock.size),
            "contraction": moment.contraction + random.normal(0.0, 2e-4, clock.size),
            "force": textbook(moment) + random.normal(0.0, 3.0, clock.size),
        }
        current = np.asarray(REGULATOR.current(asked))
        runs.append(Run(f"{place}", {"time": clock, "current": current, **read}))
    return Recording("responses", "0" * 64, tuple(runs))


def _problem(recording: Recording) -> Problem:
    return pinned(problem_of(recording, MODEL, {}), *OPEN)


def _ended(recording: Recording) -> tuple[Found, Contest]:
    """The search, as far above the noise as it ends."""
    found = search(_problem(recording), OFFSET, np.random.default_rng(0))
    return found, contest(found, OFFSET)


def _told(found: Found, best: Contest) -> tuple[Found, Contest]:
    noises = _problem(_recording(0.0, 0.01)).noises
    return with_transients(found, best, (*OFFSET, *LATE), noises)


@pytest.mark.parametrize(
    ("dead_time", "time"), [(0.1, 0.02), (0.04, 0.02), (0.02, 0.03), (0.0, 0.05)]
)
def test_a_valve_slower_than_any_good_one_is_told(
    dead_time: float, time: float
) -> None:
    found, best = _ended(_recording(dead_time, time))
    assert best.best.names == ("valve_offset",)
    _, told = _told(found, best)
    assert told.best.names == ("valve_offset", "valve_lag")
    (lag,) = (e for e in told.best.fit.point.effects if isinstance(e, ValveLag))
    # One row besides, and the second lag counts as waiting in part.
    assert dead_time < lag.dead_time < dead_time + STEP + time


def test_what_other_sweeps_foretell_goes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*fits: object) -> bool:
        fit = fits[2]
        assert isinstance(fit, Polished)
        return any(isinstance(effect, ChannelDelay) for effect in fit.point.effects)

    found, best = _ended(_recording(0.04, 0.02))
    monkeypatch.setattr(transient, "bears_out", late)
    assert _told(found, best)[1].best.names == ("valve_offset", "channel_delay")


def _beside(channel: Signal) -> tuple[Found, Contest]:
    """The same, had a channel that is read late been named as well."""
    found, best = _ended(_recording(0.1, 0.02))
    late = Candidate("channel_delay", ChannelDelay(delay=0.01, channel=channel))
    point = added(best.best.fit.point, late)
    here = Rival((*best.best.candidates, late), polished(found.problem, point))
    return found, Contest(here, (*best.places, Place(best.best)))


def test_beside_one_cause_no_other_is_told() -> None:
    found, best = _beside(Signal.PRESSURE)
    assert _told(found, best) == (found, best)


def test_a_force_that_is_read_late_is_no_cause() -> None:
    _, told = _told(*_beside(Signal.FORCE))
    assert "valve_lag" in told.best.names


def test_no_form_of_what_is_told_is_its_rival() -> None:
    after, told = _told(*_ended(_recording(0.04, 0.02)))
    assert told.best.names[-1] == "valve_lag"
    assert [rival.names for rival in after.rivals].count(told.best.names) == 1


def test_a_valve_as_quick_as_any_is_not_told() -> None:
    found, best = _ended(_recording(0.0, 0.01))
    after, told = _told(found, best)
    assert (after, told) == (found, best)


def test_near_the_noise_answers_are_not_asked() -> None:
    found, best = _ended(_recording(0.1, 0.02))
    calm = replace(found, problem=replace(found.problem, inflations={}))
    assert _told(calm, best) == (calm, best)


def test_an_answer_lasts_from_the_row_before_a_command_for_a_second() -> None:
    plain = _problem(_recording(0.1, 0.02))
    problem = with_responses(plain, START, plain.noises[Signal.PRESSURE])
    assert len(problem.dwells) == len(LENGTHS) * len(PRESSURES) * 3
    for number, block in enumerate(problem.dwells):
        assert block.signal is Signal.PRESSURE
        course = problem.courses[block.course]
        since = course.time[block.good] - course.time[0] - DWELL * (1 + number % 3)
        # Before it the pressure is where it was: one row tells that.
        assert since[0] == pytest.approx(-STEP)
        assert since[-1] == pytest.approx(1.0, abs=1.5 * STEP)


def test_answers_are_as_loud_as_what_is_left_about_their_level() -> None:
    plain = _problem(_recording(0.1, 0.02))
    problem = with_responses(plain, START, plain.noises[Signal.PRESSURE])
    samples = sum(int(block.good.sum()) for block in problem.dwells)
    assert 0.3 * samples < misfit(problem, START, Signal.PRESSURE) < samples
    # Were every level off by another 10 kPa, no response would be worse for it.
    courses = tuple(
        replace(c, measured={**c.measured, "pressure": c.measured["pressure"] + 10e3})
        for c in problem.courses
    )
    loud = [
        block._replace(noise=replace(block.noise or Noise(1, 0), drift=30e3))
        for block in problem.dwells
    ]
    here = replace(problem, dwells=tuple(loud))
    before, after = (
        misfit(one, START, Signal.PRESSURE)
        for one in (here, replace(here, courses=courses))
    )
    assert after == pytest.approx(before, rel=0.02)


def test_ramps_have_no_answers() -> None:
    ramps = _problem(small.recording(nothing))
    noise = ramps.noises[Signal.PRESSURE]
    assert with_responses(ramps, START, noise) is ramps


def test_four_answers_are_too_few() -> None:
    plain = _problem(_recording(0.1, 0.02))
    once = replace(plain, kept=tuple(
        (np.arange(len(c)) < 1.6 * DWELL / STEP) & (i < 4)
        for i, c in enumerate(plain.courses)
    ))  # fmt: skip
    noise = plain.noises[Signal.PRESSURE]
    assert with_responses(once, START, noise) is once


def _answers(plain: Problem) -> tuple[Block, ...]:
    return with_responses(plain, START, plain.noises[Signal.PRESSURE]).dwells


def test_a_command_that_rests_less_than_a_second_has_no_answer() -> None:
    assert not _answers(_problem(_recording(0.1, 0.02, dwell=0.8)))


def test_an_answer_with_a_hole_is_none() -> None:
    plain = _problem(_recording(0.1, 0.02))
    all_of_them = len(_answers(plain))
    first = plain.courses[0].measured["pressure"].copy()
    first[round((DWELL + 0.5) / STEP)] = np.nan
    holed = replace(
        plain.courses[0], measured={**plain.courses[0].measured, "pressure": first}
    )
    plain = replace(plain, courses=(holed, *plain.courses[1:]))
    assert len(_answers(plain)) == all_of_them - 1


def test_dwells_of_the_force_stay_beside_answers() -> None:
    plain = _problem(_recording(0.1, 0.02))
    (dwell, *_) = (b for b in plain.blocks if b.signal is Signal.FORCE)
    dwelling = replace(plain, dwells=(dwell,))
    found = _answers(dwelling)
    assert found[0] is dwell
    assert len(found) == 1 + len(_answers(plain))
