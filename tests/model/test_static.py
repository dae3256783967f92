"""Pull of the muscle and its inverse."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.errors import DomainError
from gripperd.model import (
    Direction,
    Muscle,
    MuscleState,
    StaticMuscle,
)
from gripperd.model.effect import StaticEffect
from gripperd.model.real import Real

PRESSURES = st.floats(-50e3, 800e3)
CONTRACTIONS = st.floats(-0.09, 0.34)
DIRECTIONS = st.sampled_from(Direction)


@dataclass(frozen=True, slots=True)
class Plateau:
    """A share of the ideal pull that is lost between two pressures: two kinks."""

    name: ClassVar[str] = "plateau"
    affine: ClassVar[bool] = True
    low: float
    high: float
    share: float = 0.6

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus its share of the pull gained between `low` and `high`. [N]."""
        inside = np.clip(at.pressure, self.low, self.high) - self.low
        force: Real = -self.share * inside * muscle.pull_area(at.contraction)
        return force

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Both ends of the plateau. [Pa]."""
        return (self.low + 0.0 * contraction, self.high + 0.0 * contraction)


@dataclass(frozen=True, slots=True)
class Bow:
    """A tenth of the ideal pull is lost at 1 MPa, and with the square of pressure."""

    name: ClassVar[str] = "bow"
    affine: ClassVar[bool] = False

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Minus a parabola. [N]."""
        return -0.1e-6 * at.pressure * at.pressure * muscle.pull_area(at.contraction)

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """None, though it bends everywhere."""
        return ()


EFFECTS: list[tuple[StaticEffect, ...]] = [
    (),
    (RubberElasticity(),),
    (BraidFriction(),),
    (RubberElasticity(), BraidFriction()),
    (RubberElasticity(), BraidFriction(Form.AS_PRINTED)),
    (RubberElasticity(), BraidFriction(), Plateau(40e3, 300e3)),
    (Plateau(-10e3, 100e3), BraidFriction(), Plateau(100e3, 500e3)),
    (RubberElasticity(), BraidFriction(), Bow()),
    (Bow(), Plateau(40e3, 300e3)),
]


@given(
    effects=st.sampled_from(EFFECTS),
    pressure=PRESSURES,
    contraction=CONTRACTIONS,
    direction=DIRECTIONS,
)
def test_the_pressure_for_a_pull_gives_that_pull(
    muscle: Muscle,
    effects: tuple[StaticEffect, ...],
    pressure: float,
    contraction: float,
    direction: Direction,
) -> None:
    static = StaticMuscle(muscle, effects)
    force = static.force(pressure, contraction, direction)
    again = static.pressure(force, contraction, direction)
    assert again == pytest.approx(pressure, abs=1e-4)


@pytest.mark.parametrize("effects", EFFECTS)
@pytest.mark.parametrize("direction", Direction)
def test_an_array_and_its_points_agree_both_ways(
    muscle: Muscle, effects: tuple[StaticEffect, ...], direction: Direction
) -> None:
    static = StaticMuscle(muscle, effects)
    pressure, contraction = (
        grid.ravel()
        for grid in np.meshgrid(np.linspace(-5e4, 8e5, 18), np.linspace(-0.09, 0.34, 9))
    )
    forces = np.asarray(static.force(pressure, contraction, direction))
    pressures = np.asarray(static.pressure(forces, contraction, direction))
    for index, (p, h) in enumerate(
        zip(pressure.tolist(), contraction.tolist(), strict=True)
    ):
        force = static.force(p, h, direction)
        assert forces[index] == pytest.approx(force, rel=1e-12, abs=1e-9)
        assert pressures[index] == pytest.approx(
            static.pressure(force, h, direction), abs=1e-4
        )


@given(
    pressure=st.floats(0, 800e3),
    contraction=st.floats(-0.03, 0.36),
    form=st.sampled_from(Form),
)
def test_friction_stands_evenly_on_both_sides_of_the_pull_without_it(
    muscle: Muscle, pressure: float, contraction: float, form: Form
) -> None:
    rubbing = StaticMuscle(muscle, (RubberElasticity(), BraidFriction(form)))
    smooth = StaticMuscle(muscle, (RubberElasticity(),))
    up = rubbing.force(pressure, contraction, Direction.CONTRACTING)
    down = rubbing.force(pressure, contraction, Direction.EXTENDING)
    assert (up + down) / 2 == pytest.approx(
        smooth.force(pressure, contraction), abs=1e-9
    )


@given(contraction=st.floats(0.0, 0.25))
def test_a_loop_through_both_directions_loses_work(
    static: StaticMuscle, contraction: float
) -> None:
    for pressure in (0.0, 50e3, 400e3):
        lost = static.force(pressure, contraction, Direction.EXTENDING) - static.force(
            pressure, contraction, Direction.CONTRACTING
        )
        assert lost >= 0


@pytest.mark.parametrize("contraction", [-0.03, 0.0, 0.05, 0.2])
def test_more_pressure_pulls_harder(static: StaticMuscle, contraction: float) -> None:
    forces = np.asarray(static.force(np.linspace(0, 8e5, 50), contraction))
    assert all(before < after for before, after in pairwise(forces.tolist()))


def test_without_pressure_at_rest_there_is_no_pull(static: StaticMuscle) -> None:
    assert static.force(0.0, 0.0) == 0.0
    assert static.force(0.0, 0.0, Direction.EXTENDING) == 0.0


def test_a_slack_muscle_does_not_push(static: StaticMuscle) -> None:
    assert static.force(0.0, 0.1) == pytest.approx(-186.345782, abs=5e-7)
    assert static.tension(0.0, 0.1) == 0.0
    tensions = static.tension(np.array([0.0, 0.3e6]), 0.1)
    assert tensions == pytest.approx([0.0, 525.573 - 186.346 - 8.903], abs=0.06)


def test_a_pull_the_muscle_gives_by_itself_asks_for_vacuum(
    static: StaticMuscle,
) -> None:
    assert static.pressure(-300.0, 0.1) < 0


@pytest.mark.parametrize("contraction", [-0.104, -0.2, -0.5])
def test_a_braid_cannot_be_stretched_past_straight(
    static: StaticMuscle, contraction: float
) -> None:
    with pytest.raises(DomainError, match=rf"{contraction:.4g} is below -0\.1034"):
        static.force(1e5, contraction)
    with pytest.raises(DomainError, match=rf"{contraction:.4g} is below -0\.1034"):
        static.pressure(100.0, contraction)
    with pytest.raises(DomainError, match=rf"{contraction:.4g} is below -0\.1034"):
        static.force(np.full(9000, 1e5), np.append(np.zeros(8999), contraction))


@pytest.mark.parametrize("contraction", [0.37, 0.5])
def test_a_spent_muscle_has_no_pressure_for_a_pull(
    static: StaticMuscle, contraction: float
) -> None:
    message = rf"{contraction:.4g} pressure no longer .* ends at 0\.3630"
    with pytest.raises(DomainError, match=message):
        static.pressure(100.0, contraction)
    with pytest.raises(DomainError, match=message):
        static.pressure(100.0, np.array([0.1, contraction]))


def test_the_error_names_the_value_that_was_wrong(static: StaticMuscle) -> None:
    with pytest.raises(DomainError) as refusal:
        static.force(1e5, -0.2)
    assert refusal.value.key == "contraction"


@pytest.mark.parametrize(
    ("contraction", "extrapolated"),
    [
        (-0.0301, True),
        (-0.03, False),
        (0.0, False),
        (0.25, False),
        (0.2501, True),
    ],
)
def test_answers_outside_the_catalogue_range_are_marked(
    static: StaticMuscle, contraction: float, extrapolated: bool
) -> None:
    assert static.extrapolates(contraction) is extrapolated


def test_what_is_not_a_number_stays_so(static: StaticMuscle) -> None:
    assert math.isnan(float(static.tension(math.nan, 0.1)))


def test_friction_ends_the_pull_before_the_geometry_does(static: StaticMuscle) -> None:
    force = static.force(3e5, 0.36)
    with pytest.raises(DomainError, match="no longer makes the muscle pull"):
        static.pressure(force, 0.36)


def test_an_array_outside_the_geometry_is_refused_without_a_warning(
    static: StaticMuscle,
) -> None:
    with pytest.raises(DomainError, match="straight"):
        static.pressure(100.0, np.array([-0.2, 0.1]))


def test_a_muscle_without_length_is_refused(static: StaticMuscle) -> None:
    with pytest.raises(DomainError, match="no length left"):
        static.force(3e5, 1.0)


@pytest.mark.parametrize(
    ("pull", "pressure"),
    [(-10e3, -10e3), (30e3, 230e3), (70e3, 270e3), (100e3, 300e3), (3e5, 5e5)],
)
def test_of_several_pressures_for_a_pull_it_is_the_highest(
    muscle: Muscle, pull: float, pressure: float
) -> None:
    """The pull rises to 100 kPa, is gone at 200 kPa, and rises again."""
    dip, nothing = Plateau(100e3, 200e3, share=2.0), Plateau(50e3, 400e3, share=0.0)
    static = StaticMuscle(muscle, (dip, nothing))
    area = muscle.pull_area(0.1)
    assert static.pressure(pull * area, 0.1) == pytest.approx(pressure)
    assert static.pressure(np.array([pull]) * area, 0.1) == pytest.approx(pressure)


@pytest.mark.parametrize("inner", [(), (BraidFriction(),), (Plateau(20e3, 40e3, 0.0),)])
def test_where_pressure_does_nothing_there_is_nothing_to_walk(
    muscle: Muscle, inner: tuple[StaticEffect, ...]
) -> None:
    static = StaticMuscle(
        muscle, (RubberElasticity(), Plateau(0.0, 100e3, share=1.0), *inner)
    )
    for pressure in (-20e3, 130e3):
        force = static.force(pressure, 0.1)
        assert static.pressure(force, 0.1) == pytest.approx(pressure, abs=1e-3)


@pytest.mark.parametrize("force", [-1000.0, 5000.0])
def test_a_pull_that_no_muscle_gives_is_refused(muscle: Muscle, force: float) -> None:
    static = StaticMuscle(muscle, (Bow(),))
    message = (
        f"at contraction 0.1 no pressure from -100 to 1000 kPa makes the muscle pull"
        f" {force:.4g} N"
    )
    with pytest.raises(DomainError, match=message):
        static.pressure(force, 0.1)
    with pytest.raises(DomainError, match=message):
        static.pressure(np.array([100.0, force]), np.array([[0.0], [0.1]])[1])


def test_many_pulls_at_many_lengths_are_solved_at_once(muscle: Muscle) -> None:
    static = StaticMuscle(muscle, (Bow(),))
    pressure = np.linspace(0, 8e5, 100)[:, np.newaxis]
    contraction = np.linspace(-0.03, 0.25, 90)
    force = static.force(pressure, contraction)
    found = np.asarray(static.pressure(force, contraction))
    assert found.shape == (100, 90)
    assert np.abs(found - pressure).max() < 1e-4


def test_a_pull_that_is_not_a_number_has_no_pressure(muscle: Muscle) -> None:
    for effects in ((), (Bow(),)):
        static = StaticMuscle(muscle, effects)
        assert math.isnan(float(static.pressure(math.nan, 0.1)))
        pressures = np.asarray(static.pressure(np.array([math.nan, 0.0]), 0.1))
        assert np.isnan(pressures).tolist() == [True, False]
