"""One current, four objects: grip force against object size."""

import numpy as np
from matplotlib.axes import Axes

from gripperd.model import Chain, PressedObject
from gripperd.model.real import positive_part
from gripperd.reproduce.drawing import BLUE, INK, MUTED, PAPER, canvas
from gripperd.reproduce.picture import Picture
from gripperd.reproduce.samples import PAPER_CURRENT, Grasp, table_1
from gripperd.units import MILLI

SMALLEST = 0.005
"""Size the picture starts at. [m]"""

FILLS = {
    "apple": "#c0392b",
    "peach": "#f0a35e",
    "raw egg": "#e9d8c3",
    "grape": "#6c4a8e",
}
"""The look of the four samples; each is also named beside its point."""


def force_vs_size(chain: Chain) -> Picture:
    """Grip force per jaw over the stroke, with one sigma where tolerances are known."""
    drawing = canvas(8.4, 4.6)
    axes = drawing.subplots()
    sizes = np.linspace(SMALLEST, chain.linkage.open_width, 141)
    grip = np.asarray(chain.grip_force(PAPER_CURRENT, sizes))
    std = np.array(
        [chain.std(PAPER_CURRENT, PressedObject(float(size))) for size in sizes]
    )
    if std.any():
        low, high = positive_part(grip - std), positive_part(grip + std)
        label = "± 1 standard deviation"
        axes.fill_between(
            sizes / MILLI, low, high, color=BLUE, alpha=0.22, lw=0, label=label
        )
    axes.plot(sizes / MILLI, positive_part(grip), color=BLUE, lw=2.4, label="model")
    grasps = table_1(chain)
    for grasp in grasps:
        _mark(axes, grasp)
    axes.set(
        xlabel="object size [mm]",
        ylabel="grip force per jaw [N]",
        xlim=(SMALLEST / MILLI, chain.linkage.open_width / MILLI),
        ylim=(0, None),
    )
    axes.set_title("One valve current, 10.7 mA, holds them all")
    if std.any():
        axes.legend(loc="upper left")
    said = ", ".join(
        f"{grasp.sample.name} {grasp.prediction.grip_force:.1f} N" for grasp in grasps
    )
    return Picture(
        "force_vs_size",
        "Grip force against object size at 10.7 mA",
        f"The same 10.7 mA grips the larger object harder: {said}.",
        f"Grip force per jaw rises with object size. {said}.",
        drawing,
    )


def _mark(axes: Axes, grasp: Grasp) -> None:
    size = grasp.sample.diameter / MILLI
    grip = grasp.prediction.grip_force
    # Drawn in proportion: the apple is three times as wide as the grape.
    axes.plot(
        size,
        grip,
        marker="o",
        ms=0.42 * size,
        mfc=FILLS.get(grasp.sample.name, PAPER),
        mec=INK,
        mew=0.8,
        ls="",
    )
    axes.annotate(
        f"{grasp.sample.name}, {size:.0f} mm: {grip:.1f} N",
        (size, grip),
        (-(0.21 * size + 3), 0.15 * size + 6),
        textcoords="offset points",
        ha="right",
        va="center",
        color=INK,
        fontsize=10.5,
    )
    axes.plot([size, size], [0, grip], color=MUTED, lw=0.8, ls=":", zorder=0.9)
