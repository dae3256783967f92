"""The two truths agree with the paper's model where nothing is hidden."""

import numpy as np
import pytest

from tests.hidden_rig.campaign import Weather, campaign
from tests.hidden_rig.course import Course, Response
from tests.hidden_rig.hidden import Hidden
from tests.hidden_rig.plant import LAWS, World, march
from tests.hidden_rig.protocol import Sweep
from tests.hidden_rig.rig import Rig

BOTH = pytest.mark.parametrize("family", ["A", "B"])
STILL_DAY = Weather(warming=0.0, warm_up=500.0, ambient=1e5, sessions=(0, 0, 0))


def run(
    family: str, sweep: Sweep, hidden: Hidden | None = None
) -> tuple[Course, Response]:
    hidden = hidden or Hidden()
    course = campaign([sweep], np.zeros(1), STILL_DAY, hidden)
    return course, march(World(LAWS[family], Rig(), hidden, course))


def held_at(pressure: float, contraction: float) -> Sweep:
    """Inflate first, then come from 0.01 longer, then rest."""
    return Sweep(
        "held",
        "hold",
        time=(0, 2, 3, 5),
        pressure=(0, pressure, pressure, pressure),
        contraction=(contraction - 0.01, contraction - 0.01, contraction, contraction),
    )


@BOTH
@pytest.mark.parametrize(
    ("pressure", "contraction", "statics", "friction"),
    [
        (300, 0.0, 772.6, 9.42),
        (300, 0.05, 521.4, 9.20),
        (300, 0.20, 65.5, 8.17),
        (400, 0.10, 514.4, 12.77),
        (400, 0.15, 329.1, 12.58),
    ],
)
def test_a_plain_muscle_pulls_as_the_paper_says(
    family: str, pressure: float, contraction: float, statics: float, friction: float
) -> None:
    _, response = run(family, held_at(pressure, contraction))
    assert response.force[-1] == pytest.approx(statics - friction, abs=0.12)


@BOTH
@pytest.mark.parametrize(
    ("size", "grip"), [(0.065, 47.6), (0.058, 39.8), (0.041, 22.5), (0.022, 5.6)]
)
def test_one_current_holds_the_four_objects_of_the_paper(
    family: str, size: float, grip: float
) -> None:
    sweep = Sweep(
        "grasp",
        "grasp",
        time=(0, 6, 12),
        pressure=(0, 209.375, 209.375),
        object_size=size,
        object_stiffness=1e6,
    )
    course, response = run(family, sweep)
    assert course.current[-1] == pytest.approx(10.7)
    assert response.grip[-1] == pytest.approx(grip, abs=0.1)
    assert response.opening[-1] == pytest.approx(size, abs=1e-4)


@BOTH
def test_jaws_without_pressure_stay_at_their_stop(family: str) -> None:
    sweep = Sweep("idle", "grasp", time=(0, 2), pressure=(0, 0))
    _, response = run(family, sweep)
    assert np.all(response.contraction == 0.0)
    assert np.all(response.opening == 0.085)


@BOTH
def test_hysteresis_does_not_depend_on_speed_and_damping_does(family: str) -> None:
    def width(name: str, pace: float) -> float:
        sweep = Sweep(
            "loop",
            "isobaric",
            time=tuple(pace * np.array([0, 2, 12, 22, 32, 42])),
            pressure=(0, 300, 300, 300, 300, 300),
            contraction=(0, 0, 0.1, 0, 0.1, 0),
        )
        hidden = Hidden()._replace(**{name: 50.0 if "hyst" in name else 1000.0})
        course, response = run(family, sweep, hidden)
        _, plain = run(family, sweep)
        lost = response.force - plain.force
        up = np.interp(27 * pace, course.clock, lost)
        down = np.interp(37 * pace, course.clock, lost)
        return float(down - up)

    slow, fast = (width("presliding_hysteresis", pace) for pace in (1.0, 0.5))
    assert slow > 20
    assert fast == pytest.approx(slow, rel=0.02)
    slow, fast = (width("viscous_friction", pace) for pace in (1.0, 0.5))
    assert fast == pytest.approx(2 * slow, rel=0.05)


@BOTH
def test_creep_goes_on_for_a_minute_after_a_step_and_slows_down(family: str) -> None:
    sweep = Sweep(
        "step",
        "step",
        time=(0, 1, 80),
        pressure=(0, 400, 400),
        contraction=(0.05, 0.05, 0.05),
    )
    course, response = run(family, sweep, Hidden(creep=100.0))
    at = np.interp([2, 4, 20, 40, 60], course.clock, response.force)
    gained = np.diff(at)
    assert gained[0] > 5
    assert gained[-1] > 0.5
    assert gained[0] / 2 > gained[1] / 16 > gained[2] / 20 > gained[3] / 20
