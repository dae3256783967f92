"""The linkage under load: joints that rub, parts that bend."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import fsolve

from gripperd.effects.jaw_compliance import JawCompliance
from gripperd.effects.linkage_friction import LinkageFriction
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.errors import DomainError
from gripperd.model import Direction, Linkage
from gripperd.model.loaded import LoadedLinkage
from gripperd.model.real import Real

LINKAGE = Linkage(open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0)
LENGTH = 0.25
JAW, SERIES, LOSS = 2e-5, 1e-5, 0.1
TAKEN, STRETCH = 0.015, 2e-5


def stiffening_by(share: float) -> LoadedLinkage:
    """Give one whose jaws, and a fifth of it its mount, stiffen. [1/N]."""
    mount = SeriesCompliance(
        compliance=SERIES, shortening=STRETCH, stiffening=share / 5
    )
    return LoadedLinkage(
        LINKAGE,
        (
            JawCompliance(compliance=JAW, stiffening=share),
            mount,
            LinkageFriction(loss=LOSS, pull_loss=TAKEN),
        ),
    )


LOADED = stiffening_by(0.0)


def tension(contraction: Real) -> Real:
    """A muscle whose pull falls as it shortens. [N]."""
    return np.maximum(600.0 - 4000.0 * contraction, 0.0)


def stiffer(load: float, stiffening: float) -> float:
    """Give what a spring is stretched by whose stiffness is ``1 + stiffening load``."""
    return quad(lambda felt: 1 / (1 + stiffening * felt), 0.0, max(load, 0.0))[0]


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("opening", [0.080, 0.060, 0.020])
@pytest.mark.parametrize("stiffening", [0.0, 0.03])
def test_pull_grip_and_bending_are_in_balance(
    opening: float, direction: Direction, stiffening: float
) -> None:
    loaded = stiffening_by(stiffening)

    def off(unknown: np.ndarray) -> list[float]:
        grip, shortening, pull = unknown
        spring = 240.0 + 1000.0 * shortening
        stretched = stiffer(pull, stiffening / 5)
        bent = JAW * stiffer(grip, stiffening) + SERIES * stretched
        share = 1 - LOSS * direction
        return [
            600.0 - 4000.0 * (shortening / 0.25 + STRETCH * stretched) - pull,
            (pull - spring) / 4 * share - TAKEN * direction * pull - grip,
            (0.085 - 4 * shortening + bent - opening) * 1e3,
        ]

    grip, shortening, pull = fsolve(off, [50.0, 0.01, 500.0], xtol=1e-10)
    found = loaded.grip_force(tension, opening, direction, LENGTH)
    assert found == pytest.approx(grip, rel=1e-7)
    contraction = loaded.contraction(opening, found, direction, LENGTH)
    assert contraction == pytest.approx(shortening / 0.25, rel=1e-7)
    spring = LINKAGE.spring_force(contraction, LENGTH)
    assert loaded.pull(found, spring, direction) == pytest.approx(pull, rel=1e-7)
    stretched = STRETCH * stiffer(pull, stiffening / 5)
    inside = loaded.inside(contraction, pull)
    assert inside == pytest.approx(shortening / 0.25 + stretched, rel=1e-7)


def test_a_spring_too_strong_for_the_muscle_holds_the_jaws_off() -> None:
    weak = LOADED.grip_force(lambda h: 0.3 * tension(h), 0.060, 1.0, LENGTH)
    pull = 0.3 * tension(0.025)
    expected = 0.9 * (pull - 240 - 6.25) / 4 - TAKEN * pull
    assert weak == pytest.approx(expected, rel=0.05)
    assert weak < 0


def test_a_slack_muscle_leaves_the_spring_alone() -> None:
    slack = LOADED.grip_force(lambda h: 0.0 * h, 0.085, 1.0, LENGTH)
    assert slack == pytest.approx(-0.9 * 240 / 4)


@given(opening=st.floats(0.01, 0.084))
def test_without_effects_it_is_the_linkage(opening: float) -> None:
    bare = LoadedLinkage(LINKAGE, ())
    contraction = LINKAGE.contraction(opening, LENGTH)
    expected = LINKAGE.grip_force(tension(contraction), contraction, LENGTH)
    assert bare.contraction(opening, 30.0, 1.0, LENGTH) == pytest.approx(contraction)
    assert bare.grip_force(tension, opening, 1.0, LENGTH) == pytest.approx(
        float(expected), rel=1e-12
    )


def test_many_openings_at_once_equal_one_by_one() -> None:
    openings = np.linspace(0.005, 0.085, 17)
    directions = np.where(np.arange(17) % 2, 1.0, -1.0)
    grips = LOADED.grip_force(tension, openings, directions, LENGTH)
    alone = [
        LOADED.grip_force(tension, float(w), float(d), LENGTH)
        for w, d in zip(openings, directions, strict=True)
    ]
    assert grips == pytest.approx(alone, rel=1e-10)


def test_joints_carry_more_than_the_jaws_while_closing() -> None:
    assert LOADED.joints(45.0, Direction.CONTRACTING) == pytest.approx(50.0)
    assert LOADED.joints(55.0, Direction.EXTENDING) == pytest.approx(50.0)


def test_joints_that_lock_are_an_error_and_not_a_grip() -> None:
    """Of the pull a quarter comes to each jaw, and they take more."""
    locked = LoadedLinkage(LINKAGE, (LinkageFriction(pull_loss=0.26),))
    with pytest.raises(
        DomainError, match=r"pull_loss is 0.26, and 0.25 of the pull"
    ) as refused:
        locked.grip_force(tension, 0.06, Direction.CONTRACTING, LENGTH)
    assert refused.value.key == "pull_loss"
    assert locked.grip_force(tension, 0.06, Direction.EXTENDING, LENGTH) > 0
