from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes

from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from gripperd.report.curves import held_out
from gripperd.report.trace import State, Trace, elided, stretches, traces
from gripperd.report.where import over_time, spaced
from gripperd.reproduce.drawing import png, svg
from tests.demonstration import STEP, example
from tests.diagnose.small import MODEL, Moment, recording


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


@pytest.fixture(scope="module")
def found(creep: Diagnosis) -> tuple[Trace, ...]:
    return traces(creep, Signal.FORCE)


def test_the_clock_of_a_picture_is_that_of_the_recording(
    creep: Diagnosis, found: tuple[Trace, ...]
) -> None:
    picture = over_time(found, BY_QUANTITY["force"], 3.0)
    (axes,) = picture.drawing.axes
    firsts = [float(run.columns["time"][0]) for run in creep.recording.runs]
    begins = {f"{first:.0f}" for first in firsts}
    told = [label.get_text() for label in axes.get_xticklabels()]
    assert len(told) > 5
    assert set(told) <= begins


def test_a_file_may_begin_at_any_time(
    creep: Diagnosis, found: tuple[Trace, ...]
) -> None:
    train = creep.split.train
    late = tuple(
        replace(one, time=one.time + 1e6, start=one.start + 1e6)
        for one in train.courses
    )
    split = replace(creep.split, train=replace(train, courses=late))
    told = traces(replace(creep, split=split), Signal.FORCE)
    assert [one.start for one in told] == pytest.approx([one.start for one in found])


def test_names_of_runs_are_no_formulas(found: tuple[Trace, ...]) -> None:
    named = tuple(replace(one, run="step$p_$") for one in found)
    for picture in (
        over_time(named, BY_QUANTITY["force"], 3.0),
        held_out(named, BY_QUANTITY["force"]),
    ):
        assert picture is not None
        picture.drawing.draw_without_rendering()


def test_letters_that_no_font_has_raise_no_warning(found: tuple[Trace, ...]) -> None:
    named = tuple(replace(one, run="日本語") for one in found)
    picture = held_out(named, BY_QUANTITY["force"])
    assert picture is not None
    assert svg(picture.drawing).endswith("</svg>\n")
    assert png(picture.drawing).startswith(b"\x89PNG")


def test_pictures_show_the_residuals_of_which_the_gap_is_told(
    creep: Diagnosis, found: tuple[Trace, ...]
) -> None:
    gap = creep.gaps[Signal.FORCE]
    for state, told in (
        (State.RECALIBRATED, gap.recalibrated),
        (State.EXPLAINED, gap.after),
    ):
        left = np.concatenate([one.residual(state)[one.held_out] for one in found])
        assert np.sqrt(np.mean(left**2)) == pytest.approx(told, rel=1e-6)


def greyed(found: tuple[Trace, ...]) -> list[tuple[float, float]]:
    (axes,) = over_time(found, BY_QUANTITY["force"], 3.0).drawing.axes
    boxes = [one.get_window_extent() for one in axes.patches]
    back = axes.transData.inverted()
    ends = [back.transform([(one.x0, 0), (one.x1, 0)])[:, 0] for one in boxes]
    return [(float(first), float(last)) for first, last in ends]


def test_only_what_took_no_part_is_grey(found: tuple[Trace, ...]) -> None:
    first, *rest = (
        replace(one, held_out=np.zeros(one.time.size, bool)) for one in found
    )
    assert greyed((first, *rest)) == []
    end = float(first.time[-1])
    late = replace(first, held_out=first.time > 0.7 * end)
    ((begin, last),) = greyed((late, *rest))
    assert begin == pytest.approx(0.7 * end, rel=0.05)
    assert last == pytest.approx(end)
    whole = replace(first, held_out=np.ones(first.time.size, bool))
    assert greyed((whole, *rest)) == [pytest.approx((0.0, end))]


def drawn(axes: Axes) -> list[tuple[Array, Array]]:
    """Lines that follow samples, not those across the picture."""
    lines = [np.asarray(line.get_xydata(), float) for line in axes.get_lines()]
    return [(line[:, 0], line[:, 1]) for line in lines if len(line) > 2]


def test_no_line_is_drawn_across_missing_samples(found: tuple[Trace, ...]) -> None:
    (axes,) = over_time(found, BY_QUANTITY["force"], 3.0).drawing.axes
    assert max(float(np.max(np.diff(one.time))) for one in found) > 3.5 * STEP
    lines = drawn(axes)
    assert len(lines) == 2 * len(found)
    for (x, y), one in zip(lines[::2], found, strict=True):
        # One sample is left out where the pressure turns, and no more are bridged.
        assert np.nanmax(np.diff(x)) < 2.5 * STEP
        left = one.residual(State.RECALIBRATED)
        np.testing.assert_allclose(y[np.isfinite(y)], left)


def test_before_and_after_are_broken_alike(found: tuple[Trace, ...]) -> None:
    step = next(one for one in found if one.run == "step_0")
    whole = replace(step, held_out=np.ones(step.time.shape, bool))
    picture = held_out((whole,), BY_QUANTITY["force"])
    assert picture is not None
    upper, lower = picture.drawing.axes
    measured, *predicted = drawn(upper)
    assert len(predicted) == len(drawn(lower)) == 3
    for x, y in [*predicted, *drawn(lower)]:
        assert np.nanmax(np.diff(x)) < 1.5 * STEP
        np.testing.assert_allclose(x[np.isfinite(y)], measured[0])


def test_a_line_of_few_of_many_samples_is_broken_at_the_same_places() -> None:
    time = np.array([0.0, 1, 2, 3, 4, 9, 10, 11, 12, 16.5])
    parts = [part.tolist() for part in stretches(time, 3)]
    assert parts == [[0, 3], [5, 8], [9]]
    assert [part.tolist() for part in stretches(time[:1])] == [[0]]


def test_no_two_marks_are_nearer_than_they_may_be() -> None:
    places = np.array([0.0, 1.0, 2.5, 4.9, 5.0, 9.0])
    assert spaced(places, 2.5) == [0, 2, 4, 5]


@pytest.mark.parametrize(
    ("name", "said"), [("step_0", "step_0"), ("2022-12-07_1816_step", "…07_1816_step")]
)
def test_a_long_name_keeps_the_end_by_which_it_differs(name: str, said: str) -> None:
    assert elided(name, 13) == said


def test_a_picture_shows_the_gap_that_the_page_tells() -> None:
    def rubbing(moment: Moment) -> Array:
        # What is held rests on a side of its own, as it happened to be set up.
        side = np.sin(moment.time[0]) if not np.ptp(moment.contraction) else 1.0
        return -60.0 * side * moment.direction * (moment.pressure > 1e3)

    library = {CoulombFriction.name: CoulombFriction}
    told = diagnose(recording(rubbing), MODEL, {}, library)
    (force,) = (gap for signal, gap in told.gaps.items() if signal is Signal.FORCE)
    shown = traces(told, Signal.FORCE)
    assert force.after < 0.3 * force.before
    for state, gap in (
        (State.NOMINAL, force.before),
        (State.RECALIBRATED, force.recalibrated),
        (State.EXPLAINED, force.after),
    ):
        left = np.concatenate([one.residual(state)[one.held_out] for one in shown])
        assert float(np.sqrt(np.mean(left**2))) == pytest.approx(gap)
