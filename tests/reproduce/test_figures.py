"""What is drawn, against the published tables."""

from typing import TYPE_CHECKING

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from gripperd.model import Chain
from gripperd.reproduce import drawing
from gripperd.reproduce.figures import figure_6, figure_7, figure_8
from gripperd.reproduce.grip_picture import force_vs_size
from gripperd.reproduce.paper import Paper
from gripperd.reproduce.picture import Picture

if TYPE_CHECKING:
    from numpy.typing import NDArray

PICTURES = [figure_6, figure_7, figure_8]


@pytest.fixture(scope="module")
def pictures(chain: Chain) -> dict[str, Picture]:
    with drawing.styled():
        drawn = [draw(Paper(chain.muscle)) for draw in PICTURES]
        drawn.append(force_vs_size(chain))
    return {picture.name: picture for picture in drawn}


def points(line: Line2D) -> "NDArray[np.float64]":
    """Abscissae and ordinates of a line, as two rows."""
    return np.asarray(line.get_xydata(), dtype=np.float64).T


def heights(axes: Axes, place: float) -> list[float]:
    """Where each line that runs over half the drawing stands at one abscissa."""
    left, right = axes.get_xlim()
    across = [points(line) for line in axes.lines]
    return [
        float(np.interp(place, x, y))
        for x, y in across
        if x.size and np.ptp(x) > 0.5 * (right - left) and x.max() < right * 1.001
    ]


def test_figure_6_draws_four_lines_within_the_published_friction(
    pictures: dict[str, Picture],
) -> None:
    upper, lower = pictures["figure_6"].drawing.axes
    assert heights(upper, 0.4) == pytest.approx(
        [1030.2, 1030.2, 1030.2 - 12.57, 1030.2 - 14.80], abs=0.06
    )
    assert heights(lower, 0.05) == pytest.approx([1.22, 2.95], abs=0.01)


def test_figure_7_draws_pairs_a_rubber_force_apart(
    pictures: dict[str, Picture],
) -> None:
    (axes,) = pictures["figure_7"].drawing.axes
    for pressure in (0.1, 0.7):
        lines = heights(axes, pressure)
        gaps = [
            ideal - rubber
            for ideal, rubber in zip(lines[::2], lines[1::2], strict=True)
        ]
        assert gaps == pytest.approx([0, 124.5, 186.3, 239.0], abs=0.06)


def test_figure_8_draws_the_published_forces_at_0_4_mpa(
    pictures: dict[str, Picture],
) -> None:
    (axes,) = pictures["figure_8"].drawing.axes
    ideal, force, absolute, rubber = heights(axes, 0.20)
    assert [ideal, force, rubber] == pytest.approx([406.0, 167.0, 239.0], abs=0.06)
    assert absolute == pytest.approx(65.5, abs=0.06)


def test_the_picture_of_grip_marks_the_four_samples(
    pictures: dict[str, Picture],
) -> None:
    (axes,) = pictures["force_vs_size"].drawing.axes
    lines = [points(line) for line in axes.lines]
    marks = {float(x[0]): float(y[0]) for x, y in lines if x.size == 1}
    expected = {65.0: 47.6, 58.0: 39.8, 41.0: 22.5, 22.0: 5.6}
    assert marks == pytest.approx(expected, abs=0.05)
    assert heights(axes, 41.0)[0] == pytest.approx(22.5, abs=0.05)


@pytest.mark.parametrize("name", ["figure_6", "figure_7", "figure_8", "force_vs_size"])
def test_every_axis_is_named_with_its_unit(
    pictures: dict[str, Picture], name: str
) -> None:
    panels = pictures[name].drawing.axes
    assert panels[-1].get_xlabel().endswith("]")
    assert all("[" in axes.get_ylabel() for axes in panels)


@pytest.mark.parametrize("name", ["figure_6", "figure_7", "force_vs_size"])
def test_the_legend_covers_no_line(pictures: dict[str, Picture], name: str) -> None:
    with drawing.styled():
        figure = pictures[name].drawing
        figure.draw_without_rendering()
        axes = figure.axes[0]
        legend = axes.get_legend()
        assert legend is not None
        box = legend.get_window_extent()
        for line in axes.lines:
            path = line.get_transform().transform_path(line.get_path())
            if points(line).shape[1] > 1:
                assert not path.intersects_bbox(box, filled=False)
