"""How pictures look, and how they become files and parts of a page."""

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from typing import Any

from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure

INK = "#1d2329"
MUTED = "#6b747d"
FAINT = "#dfe3e7"
PAPER = "#ffffff"
BLUE = "#0072b2"
VERMILION = "#d55e00"
GREEN = "#009e73"
ORANGE = "#c98a00"
PURPLE = "#b0568c"
"""Hues after Okabe and Ito, told apart with every kind of colour vision."""

PAGE_COLOURS = {
    INK: "var(--ink)",
    MUTED: "var(--muted)",
    FAINT: "var(--faint)",
    PAPER: "var(--paper)",
    BLUE: "var(--blue)",
    VERMILION: "var(--vermilion)",
    GREEN: "var(--green)",
    ORANGE: "var(--orange)",
    PURPLE: "var(--purple)",
}
"""On the page each colour is a variable, so that it follows light and dark."""

STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 11,
    "mathtext.fontset": "dejavusans",
    "text.color": INK,
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlelocation": "left",
    "axes.titlesize": 12,
    "axes.titleweight": "bold",
    "axes.facecolor": PAPER,
    "figure.facecolor": PAPER,
    "grid.color": FAINT,
    "grid.linewidth": 0.8,
    "legend.facecolor": PAPER,
    "legend.edgecolor": "none",
    "legend.framealpha": 1.0,
    "legend.fancybox": False,
    "lines.linewidth": 2.0,
    "lines.solid_capstyle": "round",
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "figure.dpi": 100,
    "savefig.dpi": 200,
    # Without a fixed salt the names inside an SVG differ from run to run.
    "svg.hashsalt": "gripperd",
    "svg.fonttype": "path",
}


@contextmanager
def styled() -> Iterator[None]:
    """Draw the same on every machine, whatever the user's own settings are."""
    with style.context(["default", STYLE]):
        yield


def canvas(width: float = 8.0, height: float = 5.0) -> Figure:
    """An empty picture, sizes in inches."""
    return Figure(figsize=(width, height), layout="constrained")


def note(
    axes: Axes,
    text: str,
    point: tuple[float, float],
    place: tuple[float, float],
    colour: str = INK,
) -> None:
    """Say what matters about a point of the drawing, with a thin line to it."""
    axes.annotate(
        text,
        point,
        place,
        color=colour,
        fontsize=10,
        ha="left",
        va="center",
        arrowprops={"arrowstyle": "-", "color": MUTED, "lw": 0.9, "shrinkB": 3},
        bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 2},
    )


def png(figure: Figure) -> bytes:
    """The picture in pixels."""
    out = BytesIO()
    with _boxes():
        figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def svg(figure: Figure, *, tight: bool = False) -> str:
    """The picture as a drawing that scales."""
    out = BytesIO()
    with _boxes():
        figure.savefig(
            out,
            format="svg",
            metadata={"Date": None, "Creator": None},
            bbox_inches="tight" if tight else None,
            pad_inches=0.02,
        )
    return out.getvalue().decode()


@contextmanager
def _boxes() -> Iterator[None]:
    """Draw a box for a letter that the font lacks, and say nothing: a table has it."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"Glyph \d+ .*missing", UserWarning)
        yield


def inline(drawing: str, name: str, alt: str, attributes: str = "") -> str:
    """Make an SVG part of a page, in the colours of the page.

    Names inside are prefixed by `name`, so that several can share a page.
    """
    size = re.search(r'viewBox="([^"]+)"', drawing)
    start = drawing.index("<defs>", drawing.index("<svg"))
    body = drawing[start:].replace("xlink:href", "href")
    body = re.sub(r'\bid="', f'id="{name}-', body)
    body = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", body)
    for colour, variable in PAGE_COLOURS.items():
        body = body.replace(colour, variable)
    box = size.group(1) if size else ""
    return f'<svg viewBox="{box}" role="img" aria-label="{alt}"{attributes}>\n{body}'


def equation(mathtext: str, name: str, spoken: str) -> str:
    """Set a formula as part of a page, in the size of its text."""
    figure = Figure(figsize=(0.1, 0.1))
    figure.patch.set_visible(False)
    figure.text(0, 0, mathtext, fontsize=12, math_fontfamily="stix")
    drawing = svg(figure, tight=True)
    size = re.search(r'<svg[^>]*? width="([\d.]+)pt"', drawing)
    # The page sets its text at 12 pt, so a point is a twelfth of an em.
    width = float(size.group(1)) / 12 if size else 20.0
    return inline(drawing, name, spoken, f' class="math" style="width:{width:.2f}em"')
