"""What Figures 6 to 8 are said to show."""

import numpy as np

from gripperd.effects.braid_friction import Form
from gripperd.model import StaticMuscle
from gripperd.reproduce.claims.claim import EXACT, Claim, Verdict
from gripperd.reproduce.paper import (
    ATMOSPHERE,
    FIGURE_8_PRESSURE,
    HIGHEST_PRESSURE,
    Paper,
)
from gripperd.units import KILO, MEGA

ALMOST = 0.05
"""Lines within this coincide: static force is not measured better than 5 % (B. Tondu,
J. Intell. Mater. Syst. Struct. 23(3), 225-253, 2012). [-]"""


def straight_lines(paper: Paper) -> Claim:
    """Figure 6: force against pressure is a straight line."""
    variants = (paper.ideal, paper.elastic, *map(paper.full, Form))
    bends = [bend(static, 0.0) for static in variants]
    shortened = bend(paper.full(), 0.05)
    worst = max(bends)
    return Claim(
        "straight-lines",
        "Fig. 6",
        "At constant length the force rises with pressure in a straight line.",
        Verdict.HOLDS if worst <= EXACT else Verdict.FAILS,
        f"At h = 0 all four variants leave the straight line by {worst * 100:.2f} % of"
        f" the force. At h = 0.05 friction bends it by {shortened * 100:.2f} %, where"
        " the bladder reaches the braid.",
        {
            "departure_at_rest_percent": 100 * worst,
            "departure_at_h_0_05_percent": 100 * shortened,
        },
    )


def bend(static: StaticMuscle, contraction: float) -> float:
    """Largest departure of force from its chord in pressure, of the largest force."""
    pressure = np.linspace(0.0, HIGHEST_PRESSURE, 161)
    force = np.asarray(static.force(pressure, contraction))
    chord = np.linspace(force[0], force[-1], force.size)
    return float(np.max(np.abs(force - chord)) / np.max(np.abs(force)))


def coincidence(paper: Paper) -> Claim:
    """Figure 6: the lines with and without friction almost coincide."""

    def share(pressure: float, form: Form) -> float:
        friction = paper.friction(pressure, 0.0, form)
        return float(friction / paper.ideal.force(pressure, 0.0))

    low, high = 0.05 * MEGA, HIGHEST_PRESSURE
    rebraced = [share(p, Form.REBRACED) for p in (low, high)]
    printed = [share(p, Form.AS_PRINTED) for p in (low, high)]
    vented = float(paper.friction(0.0, 0.0, Form.AS_PRINTED))
    worst = max(*rebraced, *printed)
    return Claim(
        "lines-coincide",
        "Fig. 6",
        "The lines with and without rubber and friction almost coincide.",
        Verdict.HOLDS if worst <= ALMOST else Verdict.FAILS,
        f"At h = 0 the rubber force is {paper.rubber(0.0):.0f} N and friction takes"
        f" {rebraced[0] * 100:.2f} % at every pressure. As printed, eq. (6) takes"
        f" {printed[1] * 100:.1f} % at 0.8 MPa but {printed[0] * 100:.1f} % at"
        f" 0.05 MPa, and {vented:.2f} N from a vented muscle that pulls nothing.",
        {
            "rubber_at_rest_N": float(paper.rubber(0.0)),
            "rebraced_at_0_05_MPa_percent": 100 * rebraced[0],
            "rebraced_at_0_8_MPa_percent": 100 * rebraced[1],
            "as_printed_at_0_05_MPa_percent": 100 * printed[0],
            "as_printed_at_0_8_MPa_percent": 100 * printed[1],
            "as_printed_vented_N": vented,
        },
    )


def coincidence_anywhere(paper: Paper) -> Claim:
    """Figure 6, read as a statement about any fixed length."""
    shift = float(paper.rubber(0.05))
    share = shift / float(paper.ideal.force(FIGURE_8_PRESSURE, 0.05))
    return Claim(
        "coincide-at-any-length",
        "Fig. 6",
        "The same holds at any fixed length.",
        Verdict.HOLDS if share <= ALMOST else Verdict.ONLY_AT_REST,
        f"At h = 0.05 rubber shifts the line down by {shift:.0f} N at every pressure,"
        f" {share * 100:.0f} % of the ideal force at 0.4 MPa. Only at rest length does"
        " it vanish.",
        {"shift_at_h_0_05_N": shift, "shift_at_0_4_MPa_percent": 100 * share},
    )


def more_pressure(paper: Paper) -> Claim:
    """Figure 7: larger pressure, larger force."""
    pressure = np.linspace(0.0, HIGHEST_PRESSURE, 81)
    rises = np.diff(np.asarray(paper.full().force(pressure, 0.0)))
    slope = float(paper.muscle.pull_area(0.0)) * KILO
    force = float(paper.ideal.force(FIGURE_8_PRESSURE, 0.0))
    return Claim(
        "more-pressure-more-force",
        "Fig. 7",
        "At rest length, larger pressure gives larger force.",
        Verdict.HOLDS if rises.min() > 0 else Verdict.FAILS,
        f"The ideal force rises by {slope:.3f} N/kPa, to {force:.0f} N at 0.4 MPa.",
        {"slope_N_per_kPa": slope, "force_at_0_4_MPa_N": force},
    )


def rubber_and_pressure(paper: Paper) -> Claim:
    """Figure 7: the influence of rubber depends on length, not on pressure."""
    pressure = np.linspace(0.0, HIGHEST_PRESSURE, 9)
    gap = paper.ideal.force(pressure, 0.10) - paper.elastic.force(pressure, 0.10)
    ratio = float(paper.muscle.diameter_ratio(0.25))
    # An incompressible wall keeps its volume: t π D L is constant.
    thinned = 1 / (ratio * 0.75)
    return Claim(
        "rubber-ignores-pressure",
        "Fig. 7",
        "The influence of the rubber depends on contraction only, not on pressure.",
        Verdict.UNTESTABLE,
        f"Eq. (5) holds no pressure, so its {paper.rubber(0.10):.0f} N at h = 0.10"
        f" vary by {np.ptp(gap):.0f} N from 0 to 0.8 MPa by construction. Real rubber"
        f" keeps its volume: the wall would thin by {(1 - thinned) * 100:.0f} % at"
        " h = 0.25, which eq. (5) leaves out.",
        {
            "rubber_at_h_0_10_N": float(paper.rubber(0.10)),
            "variation_with_pressure_N": float(np.ptp(gap)),
            "wall_thinning_at_h_0_25_percent": 100 * (1 - thinned),
        },
    )


def rising_and_falling(paper: Paper) -> Claim:
    """Figure 8: rubber force rises with contraction, muscle force falls."""
    contraction = np.linspace(0.0, 0.30, 121)
    rubber = np.asarray(paper.rubber(contraction))
    force = np.asarray(paper.elastic.force(FIGURE_8_PRESSURE, contraction))
    monotone = np.diff(rubber).min() > 0 and np.diff(force).max() < 0
    early = float(paper.rubber(0.05) / paper.rubber(0.25))
    gauge = paper.free_contraction(paper.elastic, FIGURE_8_PRESSURE)
    absolute = paper.free_contraction(paper.elastic, FIGURE_8_PRESSURE - ATMOSPHERE)
    return Claim(
        "rubber-rises-force-falls",
        "Fig. 8",
        "At P = 0.4 MPa rubber force rises gradually with contraction and force falls.",
        Verdict.HOLDS if monotone else Verdict.FAILS,
        f"Rubber rises fast first ({early * 100:.0f} % of its value at h = 0.25 is"
        " there at h = 0.05), then levels off. The force is spent at"
        f" h = {gauge:.3f}, or {absolute:.3f} if 0.4 MPa is absolute, which the paper"
        " does not say.",
        {
            "rubber_at_h_0_05_of_h_0_25_percent": 100 * early,
            "free_contraction_gauge": gauge,
            "free_contraction_absolute": absolute,
        },
    )
