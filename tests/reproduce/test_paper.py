import pytest
from scipy.optimize import brentq

from gripperd.effects.braid_friction import Form
from gripperd.model import Chain, Direction
from gripperd.reproduce.paper import Paper


@pytest.mark.parametrize("pressure", [0.05e6, 0.3e6, 0.8e6])
@pytest.mark.parametrize("direction", Direction)
def test_a_free_muscle_does_not_pull(
    chain: Chain, pressure: float, direction: Direction
) -> None:
    paper = Paper(chain.muscle)
    full = paper.full()
    expected = brentq(lambda h: float(full.force(pressure, h, direction)), 0.0, 0.362)
    found = paper.free_contraction(full, pressure, direction)
    assert found == pytest.approx(expected, abs=1e-11)


def test_the_parts_add_up_to_the_whole(chain: Chain) -> None:
    paper = Paper(chain.muscle)
    for form in Form:
        parts = (
            paper.ideal.force(2e5, 0.08)
            - paper.rubber(0.08)
            - paper.friction(2e5, 0.08, form)
        )
        assert paper.full(form).force(2e5, 0.08) == pytest.approx(parts, abs=1e-9)


def test_the_rubber_of_the_paper_opposes_contraction(chain: Chain) -> None:
    assert Paper(chain.muscle).rubber(0.10) == pytest.approx(186.345782, abs=5e-7)
