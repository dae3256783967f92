"""Memory of contraction."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.model import Direction, Muscle, StaticMuscle
from gripperd.model.preisach import Hysteron
from gripperd.model.track import Array
from tests.effects.tracks import track_of

HYSTERESIS = PreslidingHysteresis(near=4.0, middle=8.0, far=6.0, contraction=0.01)
ALL = 18.0
"""What the three springs carry together. [N]"""


def path(*turns: float) -> Array:
    """Contraction from one turning point to the next, in steps of 0.0005."""
    legs = [
        np.linspace(start, end, 1 + round(abs(end - start) / 0.0005))[1:]
        for start, end in pairwise(turns)
    ]
    return np.concatenate([[turns[0]], *legs])


def force(
    muscle: Muscle, contraction: Array, effect: PreslidingHysteresis = HYSTERESIS
) -> Array:
    track = track_of(muscle, contraction=contraction)
    return effect.along(np.zeros_like(contraction), track, effect.rest())


def test_before_any_travel_there_is_no_force(muscle: Muscle) -> None:
    assert force(muscle, np.full(5, 0.1)).tolist() == [0.0] * 5


def test_a_record_may_begin_as_the_way_there_left_it(muscle: Muscle) -> None:
    whole = path(0.0, 0.1, 0.05)
    begun = replace(HYSTERESIS, begun=1.0)
    for start in (4, 30, 150):
        cut = force(muscle, whole[start:], begun)
        assert cut == pytest.approx(force(muscle, whole)[start:])
    stretched = force(muscle, np.full(2, -0.03), begun)
    assert stretched == pytest.approx([ALL, ALL])


@pytest.mark.parametrize(("inflations", "keeps"), [(0, False), (1, True), (3, True)])
def test_a_muscle_used_before_keeps_what_its_way_back_has_loaded(
    muscle: Muscle, inflations: int, *, keeps: bool
) -> None:
    kept = replace(HYSTERESIS, begun=1.0, kept=1.0)
    again = path(0.0, 0.2, 0.0, 0.2)
    second = int(np.flatnonzero(again == 0.0)[1])
    whole = force(muscle, again)
    assert whole[second] == pytest.approx(ALL)
    for later in (0, 3, 7):
        way = again[second + later :]
        track = track_of(muscle, contraction=way, cycle=float(inflations))
        found = kept.along(np.zeros(way.size), track, kept.rest())
        assert (found == pytest.approx(whole[second + later :])) is keeps


@pytest.mark.parametrize("came", [-1.0, 0.3, 1.0])
def test_a_run_without_travel_begins_as_the_rig_came_to_rest(
    muscle: Muscle, came: float
) -> None:
    begun = replace(HYSTERESIS, begun=-0.5)
    for length in (0.0, 0.005, 0.1):
        resting = np.full(4, length)
        track = track_of(muscle, contraction=resting, came=came)
        held = begun.along(np.zeros(4), track, begun.rest())
        assert held == pytest.approx([-came * ALL] * 4)


def test_after_its_first_sample_it_is_the_path_that_counts(muscle: Muscle) -> None:
    memory = HYSTERESIS.rest()
    first, later = (
        HYSTERESIS.along(np.zeros(1), track_of(muscle, contraction=h, came=c), memory)
        for h, c in ((0.1, 1.0), (0.1 - 0.06, -0.3))
    )
    assert (first[0], later[0]) == pytest.approx((-ALL, ALL))


def test_a_first_loading_bends_at_a_third_one_and_three_radii(muscle: Muscle) -> None:
    reached = force(muscle, np.array([0.0, 0.01 / 3, 0.01, 0.03, 0.1]))
    # Of the springs' 4, 8 and 6 N, the share of its way that each has gone.
    expected = [0, 4 + 8 / 3 + 6 / 9, 4 + 8 + 6 / 3, 18, 18]
    assert -reached == pytest.approx(expected)


@pytest.mark.parametrize("direction", Direction)
def test_after_a_long_way_it_is_the_friction_of_a_prediction(
    muscle: Muscle, direction: Direction
) -> None:
    end = 0.1 + 0.08 * direction
    travelled = force(muscle, path(0.1, 0.1 - 0.05 * direction, end))[-1]
    static = StaticMuscle(muscle, (HYSTERESIS,))
    settled = static.force(0.0, end, direction)
    assert settled == -direction * ALL
    assert travelled == pytest.approx(settled)


def test_the_loop_turns_smoothly(muscle: Muscle) -> None:
    down = force(muscle, path(0.0, 0.1, 0.0))[200:]
    assert down[0] == pytest.approx(-ALL)
    assert np.diff(down).max() < ALL / 15
    # From one side to the other it takes twice the way of a first loading.
    assert down[119] < ALL - 1e-6
    assert down[121] == pytest.approx(ALL)


def test_minor_loops_close_where_they_began(muscle: Muscle) -> None:
    once = force(muscle, path(0.0, 0.05))
    excursion = force(muscle, path(0.0, 0.03, 0.022, 0.03, 0.05))
    assert excursion[-1] == once[-1]
    assert excursion[92] == pytest.approx(once[60])
    assert excursion[76] > once[60] + 1


def test_speed_makes_no_difference(muscle: Muscle) -> None:
    slow = force(muscle, np.repeat(path(0.0, 0.05, 0.02, 0.04), 3))
    assert slow[::3].tolist() == force(muscle, path(0.0, 0.05, 0.02, 0.04)).tolist()


def test_every_closed_loop_loses_work(muscle: Muscle) -> None:
    loop = path(0.05, 0.08, 0.02, 0.05)
    pull = force(muscle, np.concatenate([loop, loop]))[loop.size :]
    assert np.trapezoid(-pull, loop) > 0.01


@pytest.mark.parametrize(
    ("middle", "contraction", "name"),
    [(0.0, 0.009, "coulomb_friction"), (2.0, 0.006, ""), (0.0, 0.01, "")],
)
def test_springs_that_all_slip_at_once_are_dry_friction(
    middle: float, contraction: float, name: str
) -> None:
    springs = PreslidingHysteresis(near=10.0, middle=middle, contraction=contraction)
    assert springs.becomes == name


RELAYS = PreslidingHysteresis(
    hysteron=Hysteron.RELAY, relays=14.0, radius=0.01, width=0.25, wide=0.4, centre=0.1,
    curve=1.0,
)  # fmt: skip


@pytest.mark.parametrize(
    ("relays", "radius", "width", "misnamed"),
    [
        pytest.param(14.0, 0.02, 0.5, False, id="a bank"),
        pytest.param(14.0, 0.01, 1.0, True, id="one switch"),
        pytest.param(-300.0, 0.01, 0.4, True, id="friction that grows with the way"),
        pytest.param(300.0, 0.02, 0.4, False, id="many, but wide"),
        pytest.param(250.0, 0.01, 0.4, False, id="narrow, but no more than that"),
    ],
)
def test_relays_that_would_be_narrower_yet_are_something_else(
    relays: float, radius: float, width: float, *, misnamed: bool
) -> None:
    bank = replace(RELAYS, relays=relays, radius=radius, width=width)
    assert bank.is_misnamed is misnamed
    springs = replace(bank, hysteron=Hysteron.STOP)
    assert not springs.is_misnamed


def test_relays_give_force_where_there_is_no_way_back(muscle: Muscle) -> None:
    up = force(muscle, path(-0.2, 0.4), RELAYS)
    assert np.ptp(up) == pytest.approx(14.0, abs=0.1)
    # Of each group the share is up that has its middle a radius below.
    behind = np.array([0.01, 0.03]) / 0.04
    share = np.dot([0.6, 0.4], 1 / (1 + np.exp(behind)))
    assert up[600] - up[0] == pytest.approx(14 * share, abs=0.05)


def test_relays_remember_where_the_travel_turned(muscle: Muscle) -> None:
    loop = force(muscle, path(0.0, 0.15, 0.05, 0.15), RELAYS)
    there, turned, back, again, end = loop[[200, 300, 400, 600, 700]]
    assert there + 0.2 < again < back - 1
    assert end == pytest.approx(turned)


@pytest.mark.parametrize("direction", Direction)
def test_after_a_long_way_relays_are_those_of_a_prediction(
    muscle: Muscle, direction: Direction
) -> None:
    travelled = force(muscle, path(0.1 - 0.08 * direction, 0.1), RELAYS)[-1]
    static = StaticMuscle(muscle, (RELAYS,))
    assert static.force(0.0, 0.1, direction) == pytest.approx(travelled)
