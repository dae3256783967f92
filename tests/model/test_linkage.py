import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.model import Linkage

LINKAGES = st.builds(
    Linkage,
    open_width=st.floats(0.02, 0.2),
    ratio=st.floats(0.5, 10.0),
    spring_preload=st.floats(0.0, 500.0),
    spring_rate=st.floats(0.0, 5000.0),
)
LENGTHS = st.floats(0.05, 1.0)
CONTRACTIONS = st.floats(-0.03, 0.25)


@given(
    linkage=LINKAGES,
    rest_length=LENGTHS,
    contraction=CONTRACTIONS,
    pull=st.floats(0.0, 2000.0),
)
def test_both_jaws_do_the_work_that_the_spring_leaves_of_the_muscles(
    linkage: Linkage, rest_length: float, contraction: float, pull: float
) -> None:
    step = 1e-6
    before, after = contraction - step, contraction + step
    shortening = 2 * step * rest_length
    closing = linkage.opening(before, rest_length) - linkage.opening(after, rest_length)
    spring = linkage.spring_preload + linkage.spring_rate * rest_length * contraction
    grip = linkage.grip_force(pull, contraction, rest_length)
    each_jaw = grip * closing / 2
    assert 2 * each_jaw == pytest.approx((pull - spring) * shortening, abs=1e-9)


@given(linkage=LINKAGES, rest_length=LENGTHS, contraction=CONTRACTIONS)
def test_the_spring_force_is_the_slope_of_its_stored_energy(
    linkage: Linkage, rest_length: float, contraction: float
) -> None:
    def energy(shortening: float) -> float:
        return (
            linkage.spring_preload * shortening
            + linkage.spring_rate * shortening**2 / 2
        )

    shortening, step = contraction * rest_length, 1e-4
    slope = (energy(shortening + step) - energy(shortening - step)) / (2 * step)
    force = linkage.spring_force(contraction, rest_length)
    assert force == pytest.approx(slope, abs=1e-8)


@given(linkage=LINKAGES, rest_length=LENGTHS, contraction=CONTRACTIONS)
def test_the_opening_tells_the_contraction(
    linkage: Linkage, rest_length: float, contraction: float
) -> None:
    opening = linkage.opening(contraction, rest_length)
    again = linkage.contraction(opening, rest_length)
    assert again == pytest.approx(contraction, abs=1e-12)


@given(
    linkage=LINKAGES,
    rest_length=LENGTHS,
    contraction=CONTRACTIONS,
    grip=st.floats(-100.0, 500.0),
)
def test_the_pull_for_a_grip_gives_that_grip(
    linkage: Linkage, rest_length: float, contraction: float, grip: float
) -> None:
    pull = linkage.muscle_force(grip, contraction, rest_length)
    again = linkage.grip_force(pull, contraction, rest_length)
    assert again == pytest.approx(grip, abs=1e-9)


def test_the_reference_rig_opens_65_mm_at_two_percent() -> None:
    reference = Linkage(
        open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0
    )
    assert reference.opening(0.02, 0.25) == pytest.approx(0.065)
    assert reference.spring_force(0.02, 0.25) == pytest.approx(245.0)
