from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from gripperd.config import load_model
from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.fit.candidates import Candidate, candidates
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search import resting
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.resting import with_resting_sign, with_sign_beside
from gripperd.diagnose.setup import problem_of
from gripperd.effects import EFFECTS
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from gripperd.recordings import read_recording
from tests.diagnose.fitted import ended, fitted
from tests.diagnose.small import (
    MODEL,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    recording,
    rubbing,
    textbook,
    without,
)
from tests.hidden_rig import make_case

COLUMNS = frozenset({"time", "current", "pressure", "contraction", "force"})
LIBRARY = {name: EFFECTS[name] for name in ("coulomb_friction", "force_sensor_bias")}


def _beside(problem: Problem, *found: Candidate) -> Problem:
    def searched(other: Problem) -> Found:
        return ended(other, fitted(other, *found))

    return with_sign_beside(searched(problem), found, searched).problem


def _decided(told: Recording) -> tuple[Problem, Problem]:
    problem = problem_of(told, MODEL, {})
    listed, _ = candidates(LIBRARY, problem, COLUMNS)
    return problem, with_resting_sign(problem, listed)


def _turning(moment: Moment) -> Array:
    """Friction that is against the pressure where nothing travels: 25 N."""
    if np.ptp(moment.contraction) > 0:
        return -25.0 * moment.direction
    rises = np.gradient(moment.pressure) >= 0
    return np.where(rises, -25.0, 25.0)


def _yielding(moment: Moment) -> Array:
    """The same, but it nears its other sign by e in each 10 kPa: Dahl's model."""
    if np.ptp(moment.contraction) > 0:
        return _turning(moment)
    sign, signs = 1.0, []
    for change in np.diff(moment.pressure, prepend=moment.pressure[0]).tolist():
        sign += (np.sign(change) - sign) * -np.expm1(-abs(change) / 10e3)
        signs.append(sign)
    return -25.0 * np.array(signs)


def _smooth(moment: Moment) -> Array:
    """Takes away the friction that the rig has."""
    return textbook(replace(moment, direction=0 * moment.direction)) - textbook(moment)


@pytest.mark.parametrize("sign", AtRest)
def test_what_is_known_of_it_stays_where_nothing_tells(sign: AtRest) -> None:
    model = replace(MODEL, effects=(RubberElasticity(),), at_rest=sign)
    problem = problem_of(recording(_smooth), model, {})
    listed, _ = candidates(LIBRARY, problem, COLUMNS)
    assert with_resting_sign(problem, listed).model.at_rest is sign


def _carried(moment: Moment) -> Array:
    return -25.0 * moment.direction


@pytest.mark.parametrize(
    ("hidden", "sign"),
    [
        pytest.param(_turning, AtRest.INFLATING, id="turns with the pressure"),
        pytest.param(_yielding, AtRest.YIELDING, id="yields before it turns"),
        pytest.param(_carried, AtRest.CARRIED, id="stays as it came"),
        pytest.param(nothing, AtRest.CARRIED, id="little friction"),
    ],
)
def test_the_convention_that_the_data_support_is_taken(
    hidden: Hidden, sign: AtRest
) -> None:
    _, decided = _decided(recording(hidden))
    assert decided.model.at_rest is sign


def _brought(*, turns: bool) -> Recording:
    """Every sweep is brought to its length first, and inflated there.

    Its strands turn round with the pressure, or stay as they came.
    """
    runs = []
    for place, length in enumerate((0.05, 0.1, 0.15, 0.2)):
        since, random = np.arange(0.0, 40.0, 0.2), np.random.default_rng([1, place])
        moment = Moment(
            time=since + 90.0 * place,
            pressure=np.interp(since, [5, 20, 35], [100e3, 450e3, 100e3]),
            contraction=np.interp(since, [1, 5], [0.0, length]),
            direction=np.where(turns & (since > 20.0), -1.0, 1.0),
        )
        readings = {
            "pressure": (moment.pressure, 1e3),
            "contraction": (moment.contraction, 2e-4),
            "force": (textbook(moment), 3.0),
        }
        noisy = {
            name: column + random.normal(0.0, std, since.size)
            for name, (column, std) in readings.items()
        }
        runs.append(Run(str(place), {"time": moment.time, **noisy}))
    return Recording("brought", "0" * 64, tuple(runs))


@pytest.mark.parametrize(
    ("turns", "sign"), [(True, AtRest.INFLATING), (False, AtRest.CARRIED)]
)
def test_what_halts_amid_its_travel_tells_as_well(sign: AtRest, *, turns: bool) -> None:
    _, decided = _decided(_brought(turns=turns))
    assert decided.model.at_rest is sign


def _framed(radius: float) -> Recording:
    """Held by a frame that gives 0.25 % at the top; strands stick over so much."""
    told = recording(nothing)
    for name, moment in moments().items():
        if name not in ("a", "b", "c", "b2"):
            continue
        ideal = textbook(replace(moment, direction=0.0 * moment.time))
        way = 0.0025 * np.maximum(ideal, 0.0) / 1.3e3
        held = moment.contraction + way
        sign = _stuck(way, radius)
        pull = textbook(replace(moment, contraction=held, direction=sign))
        told = altered(told, [name], "contraction", partial(_more, way))
        told = altered(told, [name], "force", partial(_more, pull - textbook(moment)))
    return told


def _more(more: Array, column: Array) -> Array:
    return column + more


def _stuck(way: Array, radius: float) -> Array:
    """Sign of friction of strands that bend before they slide, from rest."""
    sign, signs = 0.0, []
    for step in np.diff(way, prepend=way[0]).tolist():
        sign = min(max(sign + step / radius, -1.0), 1.0)
        signs.append(sign)
    return np.array(signs)


@pytest.mark.parametrize("radius", [3e-4, 6e-4])
def test_how_far_a_frame_must_yield_for_friction_to_turn_is_told(radius: float) -> None:
    problem, decided = _decided(_framed(radius))
    assert problem.model.at_rest is AtRest.INFLATING
    assert decided.model.winding == pytest.approx(radius, rel=0.35)


def test_what_gives_in_a_mount_turns_friction_round_by_itself(tmp_path: Path) -> None:
    """A rope that stiffens, in a rig whose constants are free: no slope tells it."""
    case = make_case(
        tmp_path, seed=41100008, family="B", kind="single", names=("series_compliance",)
    )
    told, model = read_recording(case.recording), load_model(case.model)
    problem = split(problem_of(told, model.explanation(), model.tolerances)).train
    listed, _ = candidates(EFFECTS, problem, COLUMNS)
    rubbing = [one for one in listed if one.name != "series_compliance"]
    assert with_resting_sign(problem, rubbing).model.at_rest is not AtRest.CARRIED
    assert with_resting_sign(problem, listed).model.at_rest is AtRest.CARRIED


def test_without_a_frame_that_yields_nothing_winds_up() -> None:
    _, decided = _decided(recording(_yielding))
    assert decided.model.winding == 0.0


def _late() -> Problem:
    """A cell that reads 0.3 s late opens a loop in sweeps at rest."""
    late = recording()
    times = {run.name: run.columns["time"] for run in late.runs}
    for name, time in times.items():
        late = altered(late, [name], "force", partial(_shifted, time))
    _, decided = _decided(late)
    return decided


def test_a_cell_found_to_be_late_takes_friction_back_to_what_it_was() -> None:
    problem = _late()
    assert problem.model.at_rest is AtRest.INFLATING
    assert _beside(problem) is problem
    cell = ChannelDelay(delay=0.3, channel=Signal.FORCE)
    late = Candidate("channel_delay", cell)
    assert _beside(problem, late).model.at_rest is AtRest.CARRIED


def test_friction_that_is_found_leaves_its_sign_as_it_is() -> None:
    _, problem = _decided(recording(_turning))
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    assert _beside(problem, rub) is problem


@pytest.mark.parametrize(
    ("path", "sign"),
    [
        ("muscle.friction_coefficient", AtRest.BLADDER),
        ("muscle.diameter", AtRest.CARRIED),
    ],
)
def test_a_braid_that_rubs_otherwise_must_not_hide_the_sign(
    monkeypatch: pytest.MonkeyPatch, path: str, sign: AtRest
) -> None:
    """Without it something else would be there that knows the sign."""
    problem = problem_of(recording(rubbing(25.0)), MODEL, {})
    assert problem.model.at_rest is AtRest.CARRIED
    index = [one.path for one in problem.constants].index(path)
    wrong = Candidate(f"parameter:{path}", None, index)
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))

    def more(found: Found, bare: Rival, *_: object) -> list[Rival]:
        assert bare.names == ("coulomb_friction",)
        likely = replace(bare, fit=replace(bare.fit, cost=-1e6))
        return [likely] if found.problem.model.at_rest is AtRest.BLADDER else []

    monkeypatch.setattr(resting, "additions", more)
    assert _beside(problem, rub, wrong).model.at_rest is sign


RUB = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
BIAS = Candidate("force_sensor_bias", ForceSensorBias(bias=20.0))
LATE = Candidate("channel_delay", ChannelDelay(delay=0.3, channel=Signal.FORCE))


@pytest.mark.parametrize(
    ("first", "then", "lead", "is_taken"),
    [
        pytest.param((RUB, BIAS), (RUB,), 0.1, True, id="fewer explain as much"),
        pytest.param((RUB, BIAS), (RUB,), -0.1, False, id="fewer explain less"),
        pytest.param((RUB,), (BIAS,), 0.1, False, id="no fewer"),
    ],
)
def test_another_sign_that_fits_as_well_is_taken_if_fewer_names_do(
    first: tuple[Candidate, ...],
    then: tuple[Candidate, ...],
    lead: float,
    *,
    is_taken: bool,
) -> None:
    """Where pressures only rise no sign is better than another."""
    problem = _rising()
    here = fitted(problem, *first)

    def searched(other: Problem) -> Found:
        return ended(other, _leading(fitted(other, *then), here, lead))

    found = ended(problem, here)
    told = with_sign_beside(found, first, searched)
    assert (told is not found) is is_taken
    if is_taken:
        assert told.problem.model.at_rest is not problem.model.at_rest


def test_of_signs_that_a_stand_in_makes_alike_the_one_that_needs_it_least_is_searched(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = _rising()
    here, bare = fitted(problem, RUB, BIAS), fitted(problem, RUB)
    ahead = {AtRest.INFLATING: (0.5, -1.0), AtRest.YIELDING: (1.0, -30.0)}

    def beside(found: Found, *_: object) -> list[Rival]:
        leads = ahead.get(found.problem.model.at_rest, (0.0, -40.0))
        return [
            _leading(one, here, by) for one, by in zip((here, bare), leads, strict=True)
        ]

    monkeypatch.setattr(resting, "_beside", beside)
    told = with_sign_beside(
        ended(problem, here), (RUB, BIAS),
        lambda other: ended(other, _leading(bare, here, 0.1)),
    )  # fmt: skip
    assert told.problem.model.at_rest is AtRest.INFLATING


def _leading(one: Rival, other: Rival, by: float) -> Rival:
    """The same with so much more evidence than another. [nat]"""
    cost = one.fit.cost + 2 * (one.evidence - other.evidence - by)
    return replace(one, fit=replace(one.fit, cost=cost))


def test_friction_that_fades_is_not_tried_as_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fades = replace(_rising(), model=replace(MODEL, fading=1.6))
    tried: list[Problem] = []

    def listed(_work: object, problems: list[Problem], _: int) -> list[Array]:
        tried.extend(problems)
        return [np.full(2, -np.inf)] * len(problems)

    monkeypatch.setattr(resting, "side_by_side", listed)
    here = fitted(fades, BIAS)
    with_sign_beside(ended(fades, here), (BIAS,), lambda other: ended(other, here))
    ways = [(one.model.at_rest, one.model.fading) for one in tried]
    assert (AtRest.CARRIED, 0.4) in ways
    assert (AtRest.INFLATING, 1.6) in ways
    assert (AtRest.CARRIED, 1.6) not in ways


def test_what_no_sign_has_a_part_in_is_not_searched_again() -> None:
    problem = _rising()
    found = ended(problem, fitted(problem, LATE))
    assert with_sign_beside(found, (LATE,), _never) is found


def _rising() -> Problem:
    rising = recording(rubbing(25.0))
    runs = (
        Run(run.name, {key: values[:50] for key, values in run.columns.items()})
        for run in rising.runs
    )
    return problem_of(Recording("rising", "0", tuple(runs)), MODEL, {})


def _never(_: Problem) -> Found:
    raise AssertionError


def _sliding(moment: Moment) -> Array:
    """The bladder slides in its braid as it inflates, and a rod rubs as it came."""
    rises = np.where(np.gradient(moment.pressure) >= 0, 1.0, -1.0)
    sign = moment.direction if np.ptp(moment.contraction) > 0 else rises
    braid = textbook(replace(moment, direction=sign)) - textbook(moment)
    return braid + rubbing(25.0)(moment)


def test_a_rod_that_rubs_does_not_keep_the_bladder_from_sliding_in_its_braid() -> None:
    _, problem = _decided(recording(_sliding))
    assert _beside(problem) is problem
    rub = Candidate("coulomb_friction", CoulombFriction(magnitude=20.0))
    beside = _beside(problem, rub)
    assert beside.model.at_rest is AtRest.BLADDER


def test_a_rod_that_is_known_to_rub_may_stay_where_the_bladder_slides() -> None:
    known = MODEL.with_effect(CoulombFriction(magnitude=25.0))
    problem = problem_of(recording(_sliding), known, {})
    assert with_resting_sign(problem, []).model.at_rest is AtRest.BLADDER


def _shifted(time: Array, force: Array) -> Array:
    return np.interp(time - 0.3, time, force)


def _stairs(*, fades: bool, creeps: float = 0.0, turns: bool = False) -> Recording:
    """Lengths and pressures in stairs, and friction that fades in a second, or stays.

    What creeps, in N, goes by e in 3 s after each stair of pressure. What turns goes
    with a pressure until that stands.
    """
    runs = []
    steps = np.array([0.0, 3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0, 24.0])
    stairs = np.array([0.0, 0.5, 0.5, 1.0, 1.0, 0.4, 0.4, 0.0, 0.0])
    held = (("a", 0.02), ("b", 0.08), ("c", 0.14))
    since = np.arange(0.0, 24.0, 0.1)
    stair = np.interp(since, steps, stairs)
    plans = [(n, 150e3 + 300e3 * stair, np.full(since.size, h)) for n, h in held]
    plans += [(n, np.full(since.size, p), 0.16 * stair) for n, p in
              (("d", 200e3), ("e", 300e3), ("f", 400e3))]  # fmt: skip
    for place, (name, pressure, way) in enumerate(plans):
        random = np.random.default_rng([7, place])
        led = pressure if turns and np.ptp(way) == 0 else way
        went = np.gradient(led) != 0
        sign, late, signs, lag = 1.0, pressure[0], [], []
        for goes, up, now in zip(went, np.gradient(led) > 0, pressure, strict=True):
            sign = (1.0 if up else -1.0) if goes else sign * np.exp(-0.1 * fades)
            late += (now - late) * -np.expm1(-0.1 / 3.0)
            signs.append(sign)
            lag.append(now - late)
        moment = Moment(since + 90.0 * place, pressure, way, np.array(signs))
        force = textbook(moment) + creeps * np.array(lag) / 300e3
        readings = {
            "pressure": (pressure, 1e3),
            "contraction": (way, 2e-4),
            "force": (force, 3.0),
        }
        noisy = {
            name: column + random.normal(0.0, std, since.size)
            for name, (column, std) in readings.items()
        }
        runs.append(Run(name, {"time": moment.time, **noisy}))
    return Recording("stairs", "0" * 64, tuple(runs))


@pytest.mark.parametrize(("fades", "fading"), [(True, (0.4, 1.6)), (False, (0.0,))])
def test_what_seems_to_creep_may_be_friction_that_fades_at_rest(
    fading: tuple[float, ...], *, fades: bool
) -> None:
    problem = problem_of(
        _stairs(fades=fades, creeps=0.0 if fades else -40.0), MODEL, {}
    )
    creeping = Candidate("creep", Creep())
    decided = _beside(problem, creeping)
    assert decided.model.fading in fading
    assert decided.model.at_rest is AtRest.CARRIED


def test_what_creeps_is_not_taken_for_friction_that_fades() -> None:
    told = diagnose(_stairs(fades=False, creeps=40.0), MODEL, {}, EFFECTS)
    assert [one.name for one in told.named] == ["creep"]
    assert not told.found.problem.model.fading


def test_friction_that_fades_may_have_turned_with_the_pressure() -> None:
    problem = problem_of(_stairs(fades=True, turns=True), MODEL, {})
    decided = _beside(problem, Candidate("creep", Creep()))
    assert decided.model.at_rest is AtRest.INFLATING
    assert decided.model.fading in (0.4, 1.6)


def test_nothing_else_of_the_problem_changes() -> None:
    problem, decided = _decided(recording(_turning))
    assert decided.constants == problem.constants
    assert decided.noises == problem.noises
    assert decided.courses is problem.courses


def test_without_a_sweep_at_rest_there_is_nothing_to_decide() -> None:
    moving = without(recording(_turning), "current")
    moving = Recording("m", "0", tuple(r for r in moving.runs if r.name in "def"))
    problem, decided = _decided(moving)
    assert decided is problem
