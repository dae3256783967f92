"""Figures 6, 7 and 8 of the paper, drawn from the model."""

import numpy as np
from matplotlib.axes import Axes

from gripperd.effects.braid_friction import Form
from gripperd.model import Direction
from gripperd.reproduce.drawing import (
    BLUE,
    GREEN,
    INK,
    MUTED,
    ORANGE,
    PURPLE,
    VERMILION,
    canvas,
    note,
)
from gripperd.reproduce.paper import (
    ATMOSPHERE,
    FIGURE_8_PRESSURE,
    HIGHEST_PRESSURE,
    Paper,
)
from gripperd.reproduce.picture import Picture
from gripperd.units import MEGA

PRESSURE_AXIS = "gauge pressure p [MPa]"
FORCE_AXIS = "force F [N]"
CONTRACTION_AXIS = "contraction h [-]"


def figure_6(paper: Paper) -> Picture:
    """Isometric force against pressure at rest length."""
    drawing = canvas(8.0, 6.4)
    upper, lower = drawing.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    pressure = np.linspace(0.0, HIGHEST_PRESSURE, 401)
    pulls = (
        ("ideal, eq. (4)", paper.ideal, INK, "-", 6.0, 0.25),
        ("with rubber, (4) and (5)", paper.elastic, INK, "-", 1.6, 1.0),
        ("with friction, (6) rebraced", paper.full(), BLUE, "--", 2.0, 1.0),
        (
            "with friction, (6) as printed",
            paper.full(Form.AS_PRINTED),
            VERMILION,
            ":",
            2.4,
            1.0,
        ),
    )
    for label, static, colour, dashes, width, alpha in pulls:
        force = static.force(pressure, 0.0)
        upper.plot(
            pressure / MEGA,
            force,
            color=colour,
            ls=dashes,
            lw=width,
            alpha=alpha,
            label=label,
        )
    at_4 = float(paper.ideal.force(FIGURE_8_PRESSURE, 0.0))
    note(upper, f"{at_4:.0f} N at 0.4 MPa", (0.4, at_4), (0.46, 0.62 * at_4))
    upper.set(ylabel=FORCE_AXIS, ylim=(0, None))
    upper.set_title("Four lines that almost coincide (h = 0)")
    upper.legend(loc="upper left")
    _shares(lower, paper)
    rebraced = 100 * float(
        paper.friction(MEGA, 0.0) / paper.ideal.force(MEGA, 0.0),
    )
    return Picture(
        "figure_6",
        "Figure 6: force against pressure at rest length",
        f"At h = 0 the rubber gives no force, and friction takes {rebraced:.2f} % at"
        " every pressure. Printed as it is, eq. (6) takes more the lower the pressure.",
        "Two panels over gauge pressure from 0 to 0.8 MPa. Above, four nearly"
        f" coincident straight lines of force reach {at_4:.0f} N at 0.4 MPa. Below, the"
        f" share taken by friction: constant at {rebraced:.2f} % rebraced, rising"
        " steeply towards low pressure as printed.",
        drawing,
    )


def _shares(axes: Axes, paper: Paper) -> None:
    """Friction as a share of the ideal force, in both readings."""
    pressure = np.linspace(0.02 * MEGA, HIGHEST_PRESSURE, 400)
    pull = paper.ideal.force(pressure, 0.0)
    for form, colour, dashes in (
        (Form.REBRACED, BLUE, "--"),
        (Form.AS_PRINTED, VERMILION, ":"),
    ):
        share = 100 * paper.friction(pressure, 0.0, form) / pull
        axes.plot(pressure / MEGA, share, color=colour, ls=dashes, lw=2.2)
    low = 0.05 * MEGA
    printed, rebraced = (
        100 * float(paper.friction(low, 0.0, form) / paper.ideal.force(low, 0.0))
        for form in (Form.AS_PRINTED, Form.REBRACED)
    )
    note(
        axes,
        f"as printed {printed:.1f} % at 0.05 MPa",
        (low / MEGA, printed),
        (0.12, 1.15 * printed),
        VERMILION,
    )
    note(
        axes,
        f"rebraced {rebraced:.2f} % everywhere",
        (0.45, rebraced),
        (0.40, 0.45 * rebraced),
        BLUE,
    )
    axes.set_title("What friction takes of the ideal force")
    axes.set(
        xlabel=PRESSURE_AXIS,
        ylabel="share [%]",
        xlim=(0, HIGHEST_PRESSURE / MEGA),
        ylim=(0, 1.5 * printed),
    )


def figure_7(paper: Paper) -> Picture:
    """Force against pressure, ideal and with rubber, at several lengths."""
    drawing = canvas(8.0, 5.6)
    axes = drawing.subplots()
    pressure = np.array([0.0, HIGHEST_PRESSURE])
    lengths = ((0.0, INK), (0.05, BLUE), (0.10, GREEN), (0.20, PURPLE))
    for contraction, colour in lengths:
        pull = np.asarray(paper.ideal.force(pressure, contraction))
        axes.plot(pressure / MEGA, pull, color=colour, lw=1.4)
        force = np.asarray(paper.elastic.force(pressure, contraction))
        axes.plot(pressure / MEGA, force, color=colour, ls=(0, (4, 2)), lw=2.2)
        axes.annotate(
            f"h = {contraction:.2f}\nrubber {float(paper.rubber(contraction)):.0f} N",
            (HIGHEST_PRESSURE / MEGA, float(pull[-1] + force[-1]) / 2),
            (8, 0),
            textcoords="offset points",
            color=colour,
            va="center",
            linespacing=1.3,
        )
    axes.plot([], [], color=MUTED, lw=1.4, label="ideal, eq. (4)")
    axes.plot([], [], color=MUTED, ls=(0, (4, 2)), lw=2.2, label="with rubber, (4)-(5)")
    axes.axhspan(-400, 0, color=MUTED, alpha=0.10, lw=0)
    axes.text(0.795, -150, "slack: a muscle cannot push", ha="right", color=MUTED)
    axes.set(
        xlabel=PRESSURE_AXIS,
        ylabel=FORCE_AXIS,
        xlim=(0, HIGHEST_PRESSURE / MEGA),
        ylim=(-300, None),
    )
    axes.set_title("Rubber shifts each line in parallel, except at h = 0")
    axes.legend(loc="upper left")
    shift = float(paper.rubber(0.05))
    return Picture(
        "figure_7",
        "Figure 7: what the rubber takes, at several lengths",
        "Each pair is one length. The gap between ideal and rubber is the same at all"
        f" pressures: 0 at h = 0, {shift:.0f} N at h = 0.05,"
        f" {float(paper.rubber(0.2)):.0f} N at h = 0.20.",
        "Straight lines of force over gauge pressure for contractions 0, 0.05, 0.10"
        " and 0.20. Each solid ideal line has a parallel dashed line below it, shifted"
        f" by 0, {shift:.0f}, {float(paper.rubber(0.1)):.0f} and"
        f" {float(paper.rubber(0.2)):.0f} N.",
        drawing,
    )


def figure_8(paper: Paper) -> Picture:
    """Force and rubber force against contraction at one pressure."""
    drawing = canvas(8.0, 5.6)
    axes = drawing.subplots()
    contraction = np.linspace(0.0, 0.30, 301)
    pressure = FIGURE_8_PRESSURE
    axes.plot(
        contraction, paper.ideal.force(pressure, contraction), color=MUTED, lw=1.6
    )
    full = paper.full()
    up, down = (full.force(pressure, contraction, way) for way in Direction)
    axes.fill_between(contraction, up, down, color=BLUE, alpha=0.30, lw=0)
    force = paper.elastic.force(pressure, contraction)
    axes.plot(contraction, force, color=BLUE)
    lower = paper.elastic.force(pressure - ATMOSPHERE, contraction)
    axes.plot(contraction, lower, color=BLUE, lw=1.2, ls=":")
    axes.plot(contraction, paper.rubber(contraction), color=VERMILION)
    gauge, absolute = (
        paper.free_contraction(paper.elastic, p)
        for p in (pressure, pressure - ATMOSPHERE)
    )
    _label_figure_8(axes, paper, gauge, absolute)
    early = float(paper.rubber(0.05) / paper.rubber(0.25))
    return Picture(
        "figure_8",
        "Figure 8: force and rubber force against contraction",
        f"At 0.4 MPa the force is spent at h = {gauge:.3f}; if the paper's 0.4 MPa is"
        f" absolute, at {absolute:.3f} (dotted). The rubber has {early * 100:.0f} % of"
        " its force at h = 0.25 by h = 0.05. The band around F is friction.",
        "Force at 0.4 MPa falls from"
        f" {float(paper.ideal.force(pressure, 0.0)):.0f} N at rest to 0 at contraction"
        f" {gauge:.3f}. Rubber force rises from 0 to"
        f" {float(paper.rubber(0.05)):.0f} N at 0.05 and levels off near"
        f" {float(paper.rubber(0.25)):.0f} N.",
        drawing,
    )


def _label_figure_8(axes: Axes, paper: Paper, gauge: float, absolute: float) -> None:
    pressure = FIGURE_8_PRESSURE
    ideal, force = (
        float(static.force(pressure, 0.13)) for static in (paper.ideal, paper.elastic)
    )
    axes.text(0.135, ideal + 25, r"$F_i$ ideal", color=MUTED)
    axes.text(0.135, force + 15, r"$F = F_i - F_s \mp F_k$", color=BLUE)
    axes.text(0.262, float(paper.rubber(0.262)) + 22, r"$F_s$ rubber", color=VERMILION)
    note(axes, f"F = 0 at h = {gauge:.3f}", (gauge, 0), (0.165, -185), BLUE)
    early = float(paper.rubber(0.05))
    half = f"{early:.0f} N at h = 0.05"
    note(axes, half, (0.05, early), (0.066, 0.28 * early), VERMILION)
    lower = float(paper.elastic.force(pressure - ATMOSPHERE, 0.065))
    words = f"if 0.4 MPa is absolute:\nF = 0 at h = {absolute:.3f}"
    note(axes, words, (0.065, lower), (0.010, 0.62 * lower), BLUE)
    axes.axhline(0, color=MUTED, lw=0.8)
    axes.axvspan(0.25, 0.30, color=ORANGE, alpha=0.12, lw=0)
    axes.text(
        0.275,
        float(paper.ideal.force(pressure, 0.0)) * 0.98,
        "beyond\nthe catalogue\nrange",
        color=MUTED,
        ha="center",
        va="top",
        fontsize=10,
    )
    axes.set(
        xlabel=CONTRACTION_AXIS, ylabel=FORCE_AXIS, xlim=(0, 0.30), ylim=(-250, None)
    )
    axes.set_title("Rubber rises while the force falls (p = 0.4 MPa gauge)")
