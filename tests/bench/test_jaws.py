from itertools import pairwise
from math import exp

import pytest

from gripperd.bench.jaws import Jaws
from gripperd.bench.settings import PlantSettings
from gripperd.model import Direction, Linkage

LINKAGE = Linkage(open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0)
SETTINGS = PlantSettings()


def pulled(jaws: Jaws, force: float, seconds: float, dt: float = 1e-3) -> list[float]:
    """Grip force after each step under a constant pull without friction."""
    grips = []
    for _ in range(round(seconds / dt)):
        jaws.step(force, force, dt)
        grips.append(jaws.grip)
    return grips


def test_the_spring_holds_the_jaws_open_up_to_its_preload() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 239.9, 0.5)
    assert jaws.opening == 0.085
    assert jaws.velocity == 0.0


def test_free_jaws_rest_where_pull_and_spring_balance() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 250.0, 5.0)
    assert jaws.shortening == pytest.approx((250.0 - 240.0) / 1000.0, rel=1e-6)
    assert jaws.opening == pytest.approx(0.085 - 4 * 0.010, rel=1e-6)
    assert jaws.grip == 0.0


def test_free_jaws_follow_the_equation_of_motion() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 250.0, 0.3, dt=1e-5)
    # m x'' + b x' + k x = 10 N, overdamped: roots of m s² + b s + k.
    m, b, k = SETTINGS.moving_mass, SETTINGS.damping, 1000.0
    root = (b * b - 4 * m * k) ** 0.5
    slow, fast = (-b + root) / (2 * m), (-b - root) / (2 * m)
    expected = 0.01 * (
        1 + (fast * exp(slow * 0.3) - slow * exp(fast * 0.3)) / (slow - fast)
    )
    assert jaws.shortening == pytest.approx(expected, rel=1e-3)


def test_the_jaws_stop_at_the_closed_stop_without_pressing() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 900.0, 1.0)
    assert jaws.opening == 0.0
    assert jaws.velocity == 0.0
    assert jaws.grip == 0.0


@pytest.mark.parametrize("stiffness", [1e3, 2e4, 2e5, 2e6])
def test_contact_never_rings(stiffness: float) -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    jaws.face(0.05, stiffness)
    grips = pulled(jaws, 400.0, 3.0)
    assert all(later >= earlier for earlier, later in pairwise(grips))


@pytest.mark.parametrize("diameter", [0.078, 0.064, 0.0503, 0.0311])
def test_the_pads_do_not_brake_before_they_touch(diameter: float) -> None:
    free, facing = Jaws(LINKAGE, SETTINGS), Jaws(LINKAGE, SETTINGS)
    facing.face(diameter, 2e5)
    while free.opening > diameter:
        pulled(free, 280.0, 1e-3)
        pulled(facing, 280.0, 1e-3)
    assert facing.grip > 0
    assert facing.opening > free.opening


@pytest.mark.parametrize("stiffness", [1e3, 2e4, 2e5, 2e6])
def test_a_pressed_object_balances_pull_and_spring(stiffness: float) -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    jaws.face(0.05, stiffness)
    pulled(jaws, 400.0, 10.0)
    # 400 = 240 + 1000 x + 4 k (d - 85 mm + 4 x)
    shortening = (160 + 4 * stiffness * 0.035) / (1000 + 16 * stiffness)
    assert jaws.shortening == pytest.approx(shortening, rel=1e-6)
    assert jaws.grip == pytest.approx(stiffness * (0.05 - jaws.opening), rel=1e-9)


def test_dry_friction_holds_the_jaws_between_both_pulls() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 250.0, 5.0)
    rested = jaws.shortening
    for _ in range(100):
        jaws.step(245.0, 255.0, 1e-3)
    assert jaws.shortening == rested
    assert jaws.velocity == 0.0


def test_direction_is_that_of_the_last_travel() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    directions = [jaws.direction]
    pulled(jaws, 250.0, 1.0)
    directions.append(jaws.direction)
    pulled(jaws, 244.0, 0.1)
    directions.append(jaws.direction)
    assert directions == [
        Direction.EXTENDING,
        Direction.CONTRACTING,
        Direction.EXTENDING,
    ]


def test_jaws_that_stick_keep_their_direction() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    pulled(jaws, 250.0, 0.1)
    for _ in range(1000):
        jaws.step(200.0, 300.0, 1e-3)
    assert jaws.velocity == 0.0
    assert jaws.direction is Direction.CONTRACTING


def test_work_of_the_pull_is_spring_object_and_losses() -> None:
    jaws = Jaws(LINKAGE, SETTINGS)
    jaws.face(0.05, 2e4)
    work = damped = 0.0
    dt = 1e-5
    for step in range(100_000):
        pull = min(240.0 + 100e-5 * step * 2, 340.0)
        before = jaws.shortening
        jaws.step(pull, pull, dt)
        travel = jaws.shortening - before
        work += pull * travel
        loss = 4**2 * 2e4 * SETTINGS.pad_loss if jaws.grip else 0.0
        damped += (SETTINGS.damping + loss) * travel**2 / dt
    x = jaws.shortening
    stored = 240 * x + 1000 * x**2 / 2 + 2e4 * (0.05 - jaws.opening) ** 2 / 2
    assert jaws.grip > 10
    assert work == pytest.approx(stored + damped, rel=1e-3)
