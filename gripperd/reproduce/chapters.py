"""The four modules of the paper's simulation, each with equation and values."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import asin, degrees, sin

from gripperd.effects.braid_friction import Form
from gripperd.model import Muscle
from gripperd.reproduce.paper import FIGURE_8_PRESSURE, Paper
from gripperd.units import MEGA, MILLI

CONTRACTIONS = (0.0, 0.05, 0.10, 0.15, 0.20, 0.25)
PRESSURES = (0.1e6, 0.2e6, 0.3e6, 0.4e6, 0.5e6)


@dataclass(frozen=True, slots=True)
class Equation:
    """A formula, set and spoken."""

    number: str
    mathtext: str
    spoken: str
    """For a reader who listens."""


@dataclass(frozen=True, slots=True)
class Table:
    """Values for people; every column names its unit."""

    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Chapter:
    """One module of the simulation."""

    title: str
    text: str
    equations: tuple[Equation, ...]
    tables: tuple[Table, ...]


def chapters(paper: Paper) -> tuple[Chapter, ...]:
    """Parameters, ideal force, elastic force and friction, in the paper's order."""
    return (parameters(paper.muscle), ideal(paper), elastic(paper), friction(paper))


def parameters(muscle: Muscle) -> Chapter:
    """Constants and geometry, eqs. (1) to (3)."""
    constants = (
        ("Length at rest", "L_N", f"{muscle.rest_length / MILLI:g} mm"),
        ("Diameter at rest", "D_N", f"{muscle.diameter / MILLI:g} mm"),
        ("Braid angle to the axis", "θ_0", f"{degrees(muscle.braid_angle):g}°"),
        ("Wall thickness", "t", f"{muscle.wall_thickness / MILLI:g} mm"),
        ("Elastic modulus", "E", f"{muscle.elastic_modulus / MEGA:g} MPa"),
        ("Friction coefficient", "μ", f"{muscle.friction_coefficient:g}"),
    )
    shape = []
    for contraction in CONTRACTIONS:
        ratio = float(muscle.diameter_ratio(contraction))
        angle = degrees(asin(ratio * sin(muscle.braid_angle)))
        width = muscle.diameter * ratio / MILLI
        shape.append((f"{contraction:.2f}", f"{angle:.2f}", f"{width:.2f}"))
    return Chapter(
        "Parameters",
        "A strand of constant length l winds n times around the muscle. When the"
        " muscle shortens by the contraction h, the braid opens and bulges.",
        (
            Equation(
                "(1)-(3)",
                r"$L = l\,\cos\theta \qquad n\pi D = l\,\sin\theta \qquad"
                r" \cos\theta = (1-h)\,\cos\theta_0$",
                "L equals l cosine theta; n pi D equals l sine theta;"
                " cosine theta equals one minus h, times cosine theta nought",
            ),
            Equation(
                "",
                r"$s = \dfrac{D}{D_N} = \dfrac{\sin\theta}{\sin\theta_0}$",
                "s equals D over D N equals sine theta over sine theta nought",
            ),
        ),
        (
            Table(
                "Constants of the muscle",
                ("Constant", "Symbol", "Value"),
                constants,
            ),
            Table(
                "Geometry",
                ("Contraction h", "Braid angle θ [°]", "Diameter D [mm]"),
                tuple(shape),
            ),
        ),
    )


def ideal(paper: Paper) -> Chapter:
    """Force from volume, eq. (4)."""
    rows = [
        (
            f"{contraction:.2f}",
            *_newtons(float(paper.ideal.force(p, contraction)) for p in PRESSURES),
        )
        for contraction in CONTRACTIONS
    ]
    return Chapter(
        "Ideal force",
        "The work of the pressure on the growing volume, with nothing lost. It is"
        f" spent at h = {paper.muscle.spent:.3f}, where the braid stands at 54.7°.",
        (
            Equation(
                "(4)",
                r"$F_i = -p\,\dfrac{dV}{dL} = p\,\dfrac{\pi D_N^2}{4}\left["
                r"\dfrac{3(1-h)^2}{\tan^2\theta_0} - \dfrac{1}{\sin^2\theta_0}\right]$",
                "F i equals minus p d V by d L, equals p times pi D N squared over"
                " four, times the bracket: three times one minus h squared over"
                " tangent squared theta nought, minus one over sine squared theta"
                " nought",
            ),
        ),
        (
            Table(
                "Ideal force [N] at a gauge pressure",
                ("Contraction h", *(f"{p / MEGA:.1f} MPa" for p in PRESSURES)),
                tuple(rows),
            ),
        ),
    )


def elastic(paper: Paper) -> Chapter:
    """Force of the rubber, eq. (5)."""
    rows = []
    for contraction in CONTRACTIONS:
        rubber = float(paper.rubber(contraction))
        pull = float(paper.ideal.force(FIGURE_8_PRESSURE, contraction))
        share = f"{100 * rubber / pull:.0f}"
        rows.append((f"{contraction:.2f}", *_newtons((rubber, pull - rubber)), share))
    return Chapter(
        "Elastic force of the rubber",
        "The stretched bladder pulls back towards rest: its hoop through the braid"
        " (first term) and its axis (second). It is exactly 0 at rest length.",
        (
            Equation(
                "(5)",
                r"$F_s = E\,t\,\pi D_N\left\{\dfrac{(1-h)^2}{\tan^2\theta_0}"
                r"\left(1-\dfrac{1}{s}\right) + h\,s\right\}$",
                "F s equals E t pi D N times the brace: one minus h squared over"
                " tangent squared theta nought, times one minus one over s, plus h s",
            ),
        ),
        (
            Table(
                "Rubber at 0.4 MPa gauge",
                ("Contraction h", "F_s [N]", "F_i - F_s [N]", "F_s / F_i [%]"),
                tuple(rows),
            ),
        ),
    )


def friction(paper: Paper) -> Chapter:
    """Friction of bladder on braid, eq. (6), in both readings."""
    rows = [
        (
            f"{contraction:.2f}",
            *(
                f"{float(paper.friction(p, contraction, form)):.2f}"
                for form in (Form.REBRACED, Form.AS_PRINTED)
                for p in (0.05e6, FIGURE_8_PRESSURE)
            ),
        )
        for contraction in CONTRACTIONS
    ]
    return Chapter(
        "Friction",
        "Contact pressure of the bladder on the braid, times its area, times μ. The"
        " printed equation closes the brace too early and adds N/m to N; moved behind"
        " 2Et, every term is a force, and the friction is 0 where the bladder does not"
        " reach the braid. It stands against the travel: minus while contracting, plus"
        " while extending.",
        (
            Equation(
                "(6) rebraced",
                r"$F_k = \mu\pi L_N(1-h)\left\{[p D_N - 2Et]\,s + 2Et\right\}$",
                "F k equals mu pi L N times one minus h, times the brace: p D N minus"
                " two E t, times s, plus two E t",
            ),
            Equation(
                "(6) as printed",
                r"$F_k = \mu\left\{\pi L_N(1-h)[p D_N - 2Et]\,s + 2Et\right\}$",
                "F k equals mu times the brace: pi L N times one minus h, times p D N"
                " minus two E t, times s, plus two E t",
            ),
            Equation(
                "(7)",
                r"$F = F_i - F_s \mp F_k$",
                "F equals F i minus F s, minus or plus F k",
            ),
        ),
        (
            Table(
                "Friction [N]",
                (
                    "Contraction h",
                    "rebraced, 0.05 MPa",
                    "rebraced, 0.4 MPa",
                    "as printed, 0.05 MPa",
                    "as printed, 0.4 MPa",
                ),
                tuple(rows),
            ),
        ),
    )


def _newtons(values: Iterable[float]) -> tuple[str, ...]:
    return tuple(f"{value:.1f}" for value in values)
