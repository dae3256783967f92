from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import Member, design
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.finalists import finalists, heard, leaders
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.tapered_ends import TaperedEnds
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_dead_band import Spool, ValveDeadBand
from gripperd.effects.valve_gain import ValveGain
from gripperd.effects.valve_lag import ValveLag
from gripperd.effects.valve_nonlinearity import ValveNonlinearity
from gripperd.effects.valve_offset import ValveOffset
from gripperd.model.effect import Signal

EARLY = Candidate("threshold_pressure", ThresholdPressure(pressure=10e3))
LATE = Candidate("threshold_pressure", ThresholdPressure(pressure=20e3))
TAPERED = Candidate("tapered_ends", TaperedEnds(excess=0.1))
RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
SHIFTED = Candidate("valve_offset", ValveOffset(offset=2e3))


@pytest.fixture
def ranked(blank: Problem) -> list[Member]:
    """Candidates in the order of their rank, those of the force first."""
    listed = (LATE, TAPERED, RUB, SHIFTED)
    members = design(blank, Point(np.zeros(len(blank.constants))), listed).members
    assert [member.candidate for member in members] == list(listed)
    return list(members)


def test_near_the_noise_the_first_few_are_heard(
    blank: Problem, ranked: list[Member]
) -> None:
    sets = [(member,) for member in ranked]
    assert heard(blank, dict.fromkeys(ranked, 1.0), sets, 2) == sets[:2]


def test_where_misfit_counts_the_first_of_each_stage_is_heard_as_well(
    blank: Problem, ranked: list[Member]
) -> None:
    inflated = replace(blank, inflations={Signal.FORCE: 40.0})
    late, tapered, rub, shifted = ranked
    sets = [(member,) for member in ranked]
    singles = dict.fromkeys(ranked, 1.0)
    assert heard(inflated, singles, sets, 2) == [(late,), (tapered,), (shifted,)]
    pairs = [(late, tapered), (late, rub), (tapered, shifted), (rub, shifted)]
    assert heard(inflated, singles, pairs, 1) == [(late, tapered), (tapered, shifted)]


def test_where_misfit_counts_none_is_heard_for_its_stage_alone(
    blank: Problem, ranked: list[Member]
) -> None:
    inflated = replace(blank, inflations={Signal.FORCE: 40.0})
    late, tapered, rub, shifted = ranked
    singles = {late: 3.0, tapered: 2.0, rub: 1.0, shifted: -0.5}
    sets = [(member,) for member in ranked]
    assert heard(inflated, singles, sets, 2) == [(late,), (tapered,)]
    pairs = [(late, tapered), (tapered, shifted)]
    assert heard(inflated, singles, pairs, 1) == [(late, tapered)]


def test_the_best_form_leads_for_its_kind(blank: Problem) -> None:
    point = Point(np.zeros(len(blank.constants)))
    early, late, rub = design(blank, point, (EARLY, LATE, RUB)).members
    assert leaders({early: 5.0, rub: 7.0, late: 6.0}) == [rub, late]


def test_what_the_leader_may_be_in_other_words_is_heard_however_it_ranks(
    blank: Problem,
) -> None:
    """What sticks beyond a threshold has a low rank before it is fitted."""
    trails, sticks, wakes = (
        Candidate("valve_dead_band", ValveDeadBand(width=5e3, spool=spool))
        for spool in Spool
    )
    others = [
        Candidate(one.name, one)
        for one in (
            ValveOffset(offset=2e3), ValveGain(error=0.02), ValveLag(share=1.0),
            SupplySaturation(share=1.0), ValveNonlinearity(bow=2e3),
        )
    ]  # fmt: skip
    point = Point(np.zeros(len(blank.constants)))
    around = design(blank, point, (trails, *others, sticks, wakes))
    ranked = {one: -float(place) for place, one in enumerate(around.members)}
    alone = {
        members[0].candidate
        for members in finalists(blank, around, ranked, thrifty=True)
        if len(members) == 1
    }
    assert {trails, sticks, wakes} <= alone
    assert others[-1] not in alone


@pytest.mark.parametrize("processes", [1, 2])
def test_the_likeliest_pairs_come_first_however_many_share_the_work(
    blank: Problem, ranked: list[Member], processes: int
) -> None:
    around = design(
        blank, Point(np.zeros(len(blank.constants))), [one.candidate for one in ranked]
    )
    alone = {one: -float(place) for place, one in enumerate(around.members)}
    shared = replace(blank, processes=processes)
    told = finalists(shared, around, alone, thrifty=True)
    evidence = [around.fit(*one).evidence for one in told if len(one) == 2]
    assert len(evidence) == 4
    assert evidence == sorted(evidence, reverse=True)
    least = min(around.fit(*pair).evidence for pair in combinations(alone, 2))
    assert least not in evidence


def test_two_forms_of_one_name_are_no_pair(blank: Problem) -> None:
    forms = [
        Candidate("valve_dead_band", ValveDeadBand(width=5e3, spool=spool))
        for spool in Spool
    ]
    offset = Candidate("valve_offset", ValveOffset(offset=2e3))
    around = design(blank, Point(np.zeros(len(blank.constants))), (*forms, offset))
    ranked = {one: -float(place) for place, one in enumerate(around.members)}
    told = finalists(blank, around, ranked, thrifty=True)
    pairs = [{one.candidate.name for one in members} for members in told[4:]]
    assert pairs
    assert all(names == {"valve_dead_band", "valve_offset"} for names in pairs)


def test_nothing_is_fitted_when_nothing_leaves_a_trace(blank: Problem) -> None:
    around = design(blank, Point(np.zeros(len(blank.constants))), ())
    assert finalists(blank, around, {}, thrifty=True) == []
