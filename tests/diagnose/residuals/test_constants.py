from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.residuals.constants import Constant, constants, moved
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.model.effect import Signal
from tests.diagnose.small import LINKAGE, MODEL, recording, with_jaws

JAWED = replace(MODEL, linkage=LINKAGE)
SCALES = {Signal.PRESSURE: 500e3, Signal.FORCE: 1200.0}


def _listed(**tolerances: float) -> dict[str, Constant]:
    stated = {path.replace("__", "."): sigma for path, sigma in tolerances.items()}
    return {one.path: one for one in constants(MODEL, stated, SCALES, [2])}


@pytest.fixture(scope="module")
def jawed() -> Problem:
    return problem_of(with_jaws(recording()), JAWED, {})


def test_a_stated_tolerance_is_taken_as_it_is() -> None:
    diameter = _listed(muscle__diameter=3e-5)["muscle.diameter"]
    assert (diameter.sigma, diameter.stated) == (3e-5, True)
    assert diameter.nominal == MODEL.muscle.diameter


def test_a_constant_without_one_is_known_to_about_a_part_tolerance() -> None:
    diameter = _listed()["muscle.diameter"]
    assert not diameter.stated
    assert 0.005 * diameter.nominal < diameter.sigma < 0.02 * diameter.nominal


def test_what_parts_are_made_to_does_not_depend_on_what_is_stated() -> None:
    stated = _listed(muscle__diameter=3e-5, valve__pressure_low=100.0)
    for path, constant in _listed().items():
        assert stated[path].usual == constant.usual
        assert constant.usual in (constant.sigma, 0.0)


def test_a_constant_stated_to_be_exact_does_not_move() -> None:
    assert "muscle.diameter" not in _listed(muscle__diameter=0.0)


@pytest.mark.parametrize("name", ["spring_preload", "spring_rate"])
def test_no_spring_pushes_back(name: str) -> None:
    spring = Constant(f"gripper.{name}", 100.0, 60.0, stated=True)
    assert spring.value(-1.0) == 40.0
    assert spring.value(-2.0) == 0.0


def test_jaws_open_and_follow_the_muscle() -> None:
    width = Constant("gripper.open_width", 0.085, 0.06, stated=True)
    ratio = Constant("gripper.ratio", 4.0, 3.0, stated=True)
    assert 0 < width.value(-2.0) < 1e-5
    assert 0 < ratio.value(-2.0) < 0.02


RUBBING = replace(MODEL, effects=(*MODEL.effects, CoulombFriction(magnitude=18.0)))


@pytest.mark.parametrize(("stated", "sigma"), [({}, 1.8), ({"magnitude": 0.3}, 0.3)])
def test_the_size_of_an_effect_of_the_model_may_be_off(
    stated: dict[str, float], sigma: float
) -> None:
    """By a tenth, or by what the model file says; what bends it stays."""
    tolerances = {f"effects.coulomb_friction.{name}": s for name, s in stated.items()}
    found = [
        one
        for one in constants(RUBBING, tolerances, SCALES, [2])
        if one.path.startswith("effects.")
    ]
    (size,) = found
    assert size.path == "effects.coulomb_friction.magnitude_N"
    assert size.stated_as == "effects.coulomb_friction.magnitude"
    assert size.nominal == 18.0
    assert size.sigma == pytest.approx(sigma)
    assert size.moves == {Signal.FORCE}
    # Dry friction never drives.
    assert size.value(-1e3) == 0.0


def test_an_explanation_has_the_effects_of_its_model_at_their_moved_sizes() -> None:
    listed = constants(RUBBING, {}, SCALES, [2])
    shifts = [float(one.path.startswith("effects.")) for one in listed]
    *textbook, friction = moved(RUBBING, listed, shifts).effects
    assert tuple(textbook) == MODEL.effects
    assert isinstance(friction, CoulombFriction)
    assert friction.magnitude == pytest.approx(19.8)


def test_the_size_of_a_textbook_term_is_that_of_its_constants() -> None:
    assert not any(path.startswith("effects.") for path in _listed())


def test_friction_is_never_known_as_well_as_a_length() -> None:
    listed = _listed(muscle__friction_coefficient=1e-9)
    friction = listed["muscle.friction_coefficient"]
    assert friction.sigma >= 0.05 * friction.nominal


def test_the_low_end_of_the_valve_may_be_off_although_it_is_zero() -> None:
    assert MODEL.regulator is not None
    assert MODEL.regulator.pressure_low == 0.0
    assert _listed()["valve.pressure_low"].sigma > 0


def test_parts_that_are_not_there_have_no_constants() -> None:
    bare = replace(MODEL, regulator=None)
    owners = {one.path.partition(".")[0] for one in constants(bare, {}, SCALES, [])}
    assert owners == {"muscle", "zero", "skew"}


def test_every_sweep_at_rest_has_a_sign_of_its_own() -> None:
    listed = constants(MODEL, {}, SCALES, [2, 5])
    courses = {one.path: one.course for one in listed if one.course is not None}
    assert courses == {"rest.2": 2, "rest.5": 5}


@pytest.mark.parametrize(
    ("own", "shared", "sign"),
    # 0.4 of the one and 0.38 of the other, added as velocities: (a + b) / (1 + a b).
    [(0.0, 0.0, 0.0), (0.5, 0.0, 0.2), (0.0, -2.0, -0.76), (1.25, 1.0, 0.88 / 1.19)],
)
def test_a_sweep_rests_as_all_do_and_as_it_does_itself(
    own: float, shared: float, sign: float
) -> None:
    listed = constants(MODEL, {}, SCALES, [2, 5])
    at = {"rest.2": own, "rest.all": shared}
    rests = moved(MODEL, listed, [at.get(one.path, 0.0) for one in listed]).rests
    assert rests == {2: pytest.approx(sign), 5: pytest.approx(0.38 * shared)}


@pytest.mark.parametrize("own", [-2.6, 2.6])
def test_a_sweep_may_rest_the_other_way_than_all_others(own: float) -> None:
    listed = constants(MODEL, {}, SCALES, [2, 5])
    at = {"rest.2": own, "rest.all": -own}
    rests = moved(MODEL, listed, [at.get(one.path, 0.0) for one in listed]).rests
    assert rests[2] == np.sign(own)
    assert rests[5] == pytest.approx(-0.38 * own)


def test_a_shift_is_in_sigma() -> None:
    listed = constants(MODEL, {"muscle.diameter": 1e-4}, SCALES, [2])
    shifts = [2.0 if one.path == "muscle.diameter" else 0.0 for one in listed]
    there = moved(MODEL, listed, shifts)
    assert there.muscle.diameter == pytest.approx(0.0202)
    assert there.muscle == replace(MODEL.muscle, diameter=there.muscle.diameter)
    assert there.regulator == MODEL.regulator


def test_no_shift_makes_a_braid_that_nobody_could_wind() -> None:
    listed = constants(MODEL, {"muscle.braid_angle": 1.0}, {}, [])
    shifts = np.array([one.path == "muscle.braid_angle" for one in listed]) * 5.0
    wide, narrow = (moved(MODEL, listed, s.tolist()) for s in (shifts, -shifts))
    assert 0 < narrow.muscle.braid_angle < wide.muscle.braid_angle < np.pi / 2


def _changed(problem: Problem, index: int) -> set[Signal]:
    """Signals that answer to one sigma of a constant."""
    shifts = np.zeros(len(problem.constants))
    base = problem.expected(problem.explanation(Point(shifts.copy())))
    shifts[index] = 1.0
    there = problem.expected(problem.explanation(Point(shifts)))
    return {
        block.signal
        for block, a, b in zip(problem.blocks, there, base, strict=True)
        if np.abs(a - b).max() > 0
    }


def test_a_constant_changes_no_signal_it_is_not_said_to_change(jawed: Problem) -> None:
    for index, constant in enumerate(jawed.constants):
        assert _changed(jawed, index) <= constant.moves, constant.path


@pytest.mark.parametrize(
    ("path", "signals"),
    [
        ("muscle.rest_length", {Signal.FORCE, Signal.OPENING}),
        ("muscle.diameter", {Signal.FORCE}),
        ("valve.pressure_high", {Signal.PRESSURE}),
        ("gripper.ratio", {Signal.OPENING}),
        ("zero.pressure", {Signal.PRESSURE, Signal.FORCE}),
        ("zero.contraction", {Signal.FORCE, Signal.OPENING}),
        ("skew.contraction", {Signal.FORCE, Signal.OPENING}),
        ("response.valve", {Signal.PRESSURE}),
    ],
)
def test_it_changes_what_the_chain_says(
    jawed: Problem, path: str, signals: set[Signal]
) -> None:
    (index,) = (i for i, one in enumerate(jawed.constants) if one.path == path)
    assert _changed(jawed, index) == signals


def test_a_part_is_off_by_two_sigma_at_most_what_has_no_tolerance_by_more() -> None:
    stated = {"muscle.diameter": 2e-4}
    (bore,) = (one for one in constants(JAWED, stated, SCALES, [2]) if one.stated)
    assert bore.reach * bore.sigma == 4e-4
    for one in constants(JAWED, stated, SCALES, [2]):
        is_part = one.path.startswith(("muscle.", "valve.", "gripper."))
        assert is_part or one.reach == 2.6, one.path


@pytest.mark.parametrize(
    ("path", "share"),
    [
        ("muscle.diameter", 0.02),
        ("valve.pressure_high", 0.02),
        ("gripper.ratio", 0.02),
        ("muscle.friction_coefficient", 0.2),
    ],
)
def test_a_part_without_a_tolerance_is_off_by_2_percent_and_friction_by_20(
    path: str, share: float
) -> None:
    (one,) = (one for one in constants(JAWED, {}, SCALES, [2]) if one.path == path)
    assert one.reach * one.sigma == pytest.approx(share * one.nominal, rel=0.005)


@pytest.mark.parametrize(
    ("path", "told"),
    [("muscle.friction_coefficient", 0.0), ("muscle.braid_angle", 0.09)],
)
def test_a_constant_is_told_as_the_model_has_it(path: str, told: float) -> None:
    listed = constants(MODEL, {}, {}, [])
    (place,) = (i for i, one in enumerate(listed) if one.path == path)
    far = [0.0] * len(listed)
    far[place] = -100.0
    assert listed[place].value(-100.0) == told
    muscle = moved(MODEL, listed, far).muscle
    assert getattr(muscle, path.partition(".")[2]) == told
