from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.residuals.holdout import Split, split
from gripperd.diagnose.residuals.problem import Problem


@pytest.fixture(scope="module")
def parts(blank: Problem) -> Split:
    return split(blank)


def _few(problem: Problem, count: int) -> Split:
    return split(replace(problem, courses=problem.courses[:count]))


@pytest.mark.parametrize("count", [1, 4, 5, 8])
def test_the_parts_share_no_sample_and_leave_none_out(
    blank: Problem, count: int
) -> None:
    found = _few(blank, count)
    for train, test in zip(found.train.kept, found.test.kept, strict=True):
        assert not (train & test).any()
        assert (train | test).all()


def test_whole_sweeps_are_left_out(parts: Split) -> None:
    for train, course in zip(parts.train.kept, parts.train.courses, strict=True):
        assert train.all() != (course.run in parts.runs)
        assert train.all() or not train.any()


def test_the_parts_explain_no_sweep_twice(parts: Split) -> None:
    train, test = (
        {part.courses[block.course].run for block in part.blocks}
        for part in (parts.train, parts.test)
    )
    assert not train & test
    assert test == set(parts.runs)


def test_about_a_fifth_is_left_out(parts: Split) -> None:
    assert 1 <= len(parts.runs) <= 2


def test_jaws_in_every_sweep_leave_it_a_fifth(blank: Problem, parts: Split) -> None:
    opened = tuple(
        replace(one, measured={**one.measured, "opening": 0.05 + 0 * one.time})
        for one in blank.courses
    )
    assert split(replace(blank, courses=opened)).runs == parts.runs


def test_of_three_sweeps_of_the_jaws_one_judges_them(
    blank: Problem, parts: Split
) -> None:
    chosen = [one.run for one in blank.courses if one.run not in parts.runs][3:]
    courses = tuple(
        replace(one, measured={**one.measured, "opening": 0.05 + 0 * one.time})
        if one.run in chosen
        else one
        for one in blank.courses
    )
    found = split(replace(blank, courses=courses)).runs
    assert set(found) == {*parts.runs, chosen[-1]}


def test_the_only_sweep_in_which_jaws_travel_stays(
    blank: Problem, parts: Split
) -> None:
    (travelling,) = (
        one for one in blank.courses if one.run in parts.runs and one.direction.any()
    )
    resting = [one.run for one in blank.courses if not one.direction.any()][:3]
    courses = tuple(
        replace(one, measured={**one.measured, "opening": 0.05 + 0 * one.time})
        if one.run in (travelling.run, *resting)
        else one
        for one in blank.courses
    )
    found = split(replace(blank, courses=courses)).runs
    assert travelling.run not in found
    assert set(found) & set(resting)


def test_the_first_sweep_stays_for_only_it_shows_a_first_inflation(
    blank: Problem,
) -> None:
    for shift in range(8):
        courses = (*blank.courses[shift:], *blank.courses[:shift])
        assert courses[0].run not in split(replace(blank, courses=courses)).runs


def test_the_first_inflation_stays_where_the_muscle_was_vented_before(
    blank: Problem,
) -> None:
    vented, *inflated = blank.courses
    assert vented.run == "vented"
    for chosen in permutations(inflated, 4):
        found = split(replace(blank, courses=(vented, *chosen))).runs
        assert found
        assert chosen[0].run not in found


def test_a_sweep_that_goes_further_than_all_others_stays(blank: Problem) -> None:
    index = next(
        i for i, one in enumerate(blank.courses) if one.run == split(blank).runs[0]
    )
    far = blank.courses[index]
    known = far.smooth["contraction"]
    wide = replace(
        far,
        smooth={
            **far.smooth,
            "contraction": known._replace(value=3 * known.value + 0.1),
        },
    )
    courses = (*blank.courses[:index], wide, *blank.courses[index + 1 :])
    assert far.run not in split(replace(blank, courses=courses)).runs


def _held(course: Course) -> Course:
    known = course.smooth["pressure"]
    still = known._replace(value=np.full(len(course), 300e3))
    return replace(course, run="held", smooth={**course.smooth, "pressure": still})


def test_though_none_is_as_warm_as_others_no_hold_is_spared(blank: Problem) -> None:
    named = {course.run: course for course in blank.courses}
    named["held"] = _held(named["b2"])
    warmth = {"a": 22.0, "b": 30.0, "held": 22.0, "c": 15.0, "d": 22.0}
    courses = tuple(
        replace(
            named[name],
            measured={
                **named[name].measured, "temperature": np.full(len(named[name]), warm)
            },
        )
        for name, warm in warmth.items()
    )  # fmt: skip
    # That along d goes furthest; b and c lie between lengths that others show.
    (spared,) = split(replace(blank, courses=courses)).runs
    assert spared in {"b", "c"}


def test_of_two_warm_sweeps_one_stays(blank: Problem, parts: Split) -> None:
    assert len(parts.runs) == 2
    courses = tuple(
        replace(
            one,
            measured={
                **one.measured,
                "temperature": np.full(len(one), 40.0 if one.run in parts.runs else 22),
            },
        )
        for one in blank.courses
    )
    (spared,) = split(replace(blank, courses=courses)).runs
    assert spared in parts.runs


@pytest.mark.parametrize("commanded", [True, False])
def test_no_hold_is_spared_though_its_valve_is_shut_and_leaks(
    blank: Problem, *, commanded: bool
) -> None:
    named = {course.run: course for course in blank.courses}
    held = _held(named["b2"])
    sinks = np.linspace(300e3, 200e3, len(held))
    sinking = held.smooth["pressure"]._replace(value=sinks)
    read = {n: v for n, v in held.measured.items() if n != "current"}
    read["pressure"] = sinks
    if commanded:
        read["current"] = np.full(len(held), 12e-3)
    leaking = replace(
        held,
        direction=np.zeros(len(held)),
        smooth={**held.smooth, "pressure": sinking},
        measured=read,
    )
    courses = (named["a"], *3 * (leaking,), *(named[name] for name in "bcd"))
    (spared,) = split(replace(blank, courses=courses)).runs
    assert (spared == "held") is not commanded


@pytest.mark.parametrize("arrives", [True, False])
def test_no_hold_is_spared_though_it_goes_to_its_length_first(
    blank: Problem, *, arrives: bool
) -> None:
    named = {course.run: course for course in blank.courses}
    held = _held(named["b2"])
    travel = held.smooth["contraction"]
    way = np.linspace(0.0, 1.0, len(held))
    there = np.minimum(way / 0.15, 1.0) if arrives else way
    level = float(np.median(travel.value))
    going = replace(
        held,
        # Where it stands still at last it has come back by a hair.
        direction=np.where(way < 0.14, 1.0, -1.0),
        smooth={**held.smooth, "contraction": travel._replace(value=level * there)},
    )
    courses = (named["a"], *3 * (going,), *(named[name] for name in "bcd"))
    spared = split(replace(blank, courses=courses)).runs
    assert ("held" in spared) is not arrives


def test_a_sweep_at_a_length_it_goes_to_first_does_not_travel(blank: Problem) -> None:
    """Of six that do so and three that travel throughout, both kinds are left out."""
    named = {course.run: course for course in blank.courses}

    def going(course: Course) -> Course:
        known = course.smooth["contraction"]
        way = np.linspace(0.0, 1.0, len(course))
        there = float(np.median(known.value)) * np.minimum(way / 0.1, 1.0)
        return replace(
            course,
            run=f"{course.run}, held",
            direction=np.where(way < 0.09, 1.0, -1.0),
            smooth={**course.smooth, "contraction": known._replace(value=there)},
        )

    held = [going(named[name]) for name in ("a", "b", "b2", "b", "b2", "c")]
    courses = (named["a"], *held, *(named[name] for name in "edf"), named["c"])
    spared = split(replace(blank, courses=tuple(courses))).runs
    assert {"held" in name for name in spared} == {True, False}


def _faster(
    problem: Problem, names: set[str], times: float, what: str = "contraction"
) -> Problem:
    """The same, had an input been so many times as fast in some sweeps."""

    def hurried(course: Course) -> Course:
        known = course.smooth[what]
        quick = known._replace(rate=times * known.rate)
        return replace(course, smooth={**course.smooth, what: quick})

    return replace(
        problem,
        courses=tuple(
            hurried(one) if one.run in names else one for one in problem.courses
        ),
    )


@pytest.mark.parametrize(
    ("fast", "times", "is_spared"),
    [({"e"}, 3.0, False), ({"e"}, 1.3, True), ({"d", "e"}, 3.0, True)],
)
def test_the_only_fast_sweep_stays(
    blank: Problem, fast: set[str], times: float, *, is_spared: bool
) -> None:
    assert "e" in split(blank).runs
    assert ("e" in split(_faster(blank, fast, times)).runs) is is_spared


@pytest.mark.parametrize(
    ("fast", "is_spared"), [(set(), True), ({"c"}, False), ({"a", "c"}, True)]
)
def test_the_only_sweep_in_which_the_pressure_is_fast_stays(
    blank: Problem, fast: set[str], *, is_spared: bool
) -> None:
    assert ("c" in split(_faster(blank, fast, 9.0, "pressure")).runs) is is_spared


def test_the_only_sweep_of_fast_pressure_stays_though_jaws_press_in_it(
    blank: Problem,
) -> None:
    pressing, (first, _, last) = _grasps(blank, (20, 60, 40))
    weakest = [one for one in pressing.courses if one.run == first]
    others = [one for one in pressing.courses if one.run != first]
    problem = replace(pressing, courses=(*weakest, *others))
    assert last in split(problem).runs
    assert last not in split(_faster(problem, {last}, 9.0, "pressure")).runs


@pytest.mark.parametrize("left_away", ["b", "c", "b2"])
@pytest.mark.parametrize("fast", ["d", "e", "f"])
def test_without_the_only_fast_sweep_another_is_spared(
    blank: Problem, fast: str, left_away: str
) -> None:
    kept = tuple(
        one
        for one in _faster(blank, {fast}, 3.0).courses
        if one.run not in ("vented", "a", left_away)
    )
    runs = split(replace(blank, courses=kept)).runs
    assert runs
    assert fast not in runs


def test_of_few_sweeps_the_end_of_each_is_left_out(blank: Problem) -> None:
    found = _few(blank, 3)
    for mask, course in zip(found.test.kept, found.test.courses, strict=True):
        left_out = np.flatnonzero(mask)
        assert left_out[-1] == len(course) - 1
        assert (np.diff(left_out) == 1).all()
        assert left_out.size == pytest.approx(len(course) / 4, abs=1)
    assert found.runs == tuple(f"{c.run} (last quarter)" for c in found.test.courses)


def test_the_parts_keep_model_and_noise(blank: Problem, parts: Split) -> None:
    for part in (parts.train, parts.test):
        assert (part.model, part.noises) == (blank.model, blank.noises)


def _grasps(problem: Problem, pulls: tuple[float, ...]) -> tuple[Problem, list[str]]:
    """The same with jaws in every other sweep, that press as hard as told."""
    courses = list(problem.courses)
    places = [2, 4, 6][: len(pulls)]
    for place, pull in zip(places, pulls, strict=True):
        one = courses[place]
        grip = pull * np.sin(np.linspace(0.0, np.pi, len(one)))
        jaws = {"opening": np.full(len(one), 0.05), "grip": grip}
        courses[place] = replace(one, measured={**one.measured, **jaws})
    names = [courses[place].run for place in places]
    return replace(problem, courses=tuple(courses)), names


@pytest.mark.parametrize("pulls", [(60, 40, 20), (20, 60, 40), (40, 20, 60)])
def test_of_three_grasps_one_is_spared_but_not_the_strongest(
    blank: Problem, pulls: tuple[float, ...]
) -> None:
    problem, names = _grasps(blank, pulls)
    spared = set(split(problem).runs) & set(names)
    assert len(spared) == 1
    assert names[pulls.index(60)] not in spared


def test_a_spared_grasp_is_one_of_the_fifth(blank: Problem) -> None:
    problem, _ = _grasps(blank, (40, 60, 20))
    twice = replace(problem, courses=(*problem.courses, *blank.courses))
    assert len(split(twice).runs) == round(0.2 * 16)


@pytest.mark.parametrize("pulls", [(60, 40), (40, 60)])
def test_of_two_grasps_none_is_spared(blank: Problem, pulls: tuple[float, ...]) -> None:
    problem, names = _grasps(blank, pulls)
    runs = split(problem).runs
    assert runs
    assert not {*names} & {*runs}


def _showing(problem: Problem, names: list[str]) -> Problem:
    """The same, had but these sweeps and the first shown anything."""
    courses = tuple(
        one
        if index == 0 or one.run in names
        else replace(one, measured={"contraction": one.measured["contraction"]})
        for index, one in enumerate(problem.courses)
    )
    return replace(problem, courses=courses)


def test_of_two_grasps_and_nothing_else_one_is_spared(blank: Problem) -> None:
    pressing, names = _grasps(blank, (60, 40))
    found = split(_showing(pressing, names))
    assert len(found.runs) == 1
    assert found.runs[0] in names
    assert found.test.blocks


def test_beside_the_first_the_only_fast_sweep_is_spared(blank: Problem) -> None:
    found = split(_showing(_faster(blank, {"e"}, 3.0), ["e"]))
    assert found.runs == ("e",)
    assert found.test.blocks


def test_beside_two_grasps_the_only_sweep_of_free_jaws_stays(blank: Problem) -> None:
    pressing, names = _grasps(blank, (60, 40))
    free, _ = _grasps(blank, (60, 40, 0.0))
    runs = split(free).runs
    assert pressing.courses[6].run == free.courses[6].run
    assert not {*names, free.courses[6].run} & {*runs}


def test_the_last_sweep_that_shows_a_signal_stays(blank: Problem) -> None:
    out = split(blank).runs[0]
    # Only that sweep has a load cell.
    courses = tuple(
        one
        if one.run == out
        else replace(
            one, measured={k: v for k, v in one.measured.items() if k != "force"}
        )
        for one in blank.courses
    )
    found = split(replace(blank, courses=courses))
    assert set(found.train.signals) == set(blank.signals)
    assert out not in found.runs


def test_sweeps_that_show_nothing_are_not_left_out(blank: Problem) -> None:
    shown = ("b", "e", "b2")
    courses = tuple(
        one
        if one.run in shown
        else replace(one, measured={"time": one.time, "pressure": one.time})
        for one in blank.courses
    )
    found = split(replace(blank, courses=courses))
    assert set(found.runs) < set(shown)
    for part in (found.train, found.test):
        assert set(part.signals) == set(blank.signals)
