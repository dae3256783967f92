"""What eq. (6), Section 4 and Table 1 are said to give."""

from dataclasses import replace

from gripperd.effects.braid_friction import Form
from gripperd.model import Chain
from gripperd.reproduce.claims.claim import EXACT, Claim, Verdict
from gripperd.reproduce.paper import FIGURE_8_PRESSURE, Paper
from gripperd.reproduce.samples import PAPER_CURRENT, table_1
from gripperd.units import KILO, MEGA, MILLI

VALVES = (0.5e6, 0.6e6, 0.9e6)
"""Usual spans of regulators for these pressures. [Pa]"""


def friction_is_a_force(paper: Paper) -> Claim:
    """Eq. (6) in two systems of units."""
    muscle = paper.muscle
    millimetres = Paper(
        replace(
            muscle,
            rest_length=muscle.rest_length / MILLI,
            diameter=muscle.diameter / MILLI,
            wall_thickness=muscle.wall_thickness / MILLI,
            elastic_modulus=muscle.elastic_modulus / MEGA,
        )
    )
    pressure = FIGURE_8_PRESSURE
    printed, rebraced = (
        (
            float(paper.friction(pressure, 0.10, form)),
            float(millimetres.friction(pressure / MEGA, 0.10, form)),
        )
        for form in (Form.AS_PRINTED, Form.REBRACED)
    )
    sound = abs(printed[0] - printed[1]) <= EXACT * printed[0]
    return Claim(
        "friction-is-a-force",
        "Eq. (6)",
        "Eq. (6) gives the friction force.",
        Verdict.HOLDS if sound else Verdict.FAILS,
        f"As printed, the same muscle at 0.4 MPa and h = 0.10 has {printed[0]:.2f} N"
        f" reckoned in m and Pa but {printed[1]:.2f} N in mm and MPa: it adds N/m to N."
        f" With the closing brace moved behind 2Et both give {rebraced[0]:.2f} N.",
        {
            "as_printed_in_m_and_Pa_N": printed[0],
            "as_printed_in_mm_and_MPa_N": printed[1],
            "rebraced_in_m_and_Pa_N": rebraced[0],
            "rebraced_in_mm_and_MPa_N": rebraced[1],
        },
    )


def clamping(paper: Paper) -> Claim:
    """Section 4: the elastic force makes one signal clamp different sizes."""
    pressure, short, long = 0.3 * MEGA, 0.05, 0.20
    large, small = (
        float(paper.elastic.force(pressure, contraction))
        for contraction in (short, long)
    )
    geometry = float(
        paper.ideal.force(pressure, short) - paper.ideal.force(pressure, long)
    )
    rubber = float(paper.rubber(long) - paper.rubber(short))
    share = rubber / (geometry + rubber)
    return Claim(
        "elastic-force-clamps",
        "Section 4",
        "One signal clamps different sizes because of the elastic force of the rubber.",
        Verdict.WEAK if share < 0.5 else Verdict.HOLDS,
        f"At 0.3 MPa the force falls from {large:.0f} N at h = 0.05 to {small:.1f} N at"
        f" h = 0.20, but {geometry:.0f} N of that fall is geometry and {rubber:.0f} N"
        f" ({share * 100:.0f} %) rubber. No force was measured to tell.",
        {
            "force_at_h_0_05_N": large,
            "force_at_h_0_20_N": small,
            "fall_from_geometry_N": geometry,
            "fall_from_rubber_N": rubber,
            "share_of_rubber_percent": 100 * share,
        },
    )


def the_current(chain: Chain) -> Claim:
    """Table 1: 10.7 mA, found by trial, clamps all four samples."""
    live_zero, top = 4 * MILLI, 20 * MILLI
    span = (PAPER_CURRENT - live_zero) / (top - live_zero)
    grasps = table_1(chain)
    held = sum(grasp.prediction.reaches for grasp in grasps)
    forces = [grasp.prediction.grip_force for grasp in grasps]
    pressures = " / ".join(f"{span * valve / MEGA:.3f}" for valve in VALVES)
    spans = " / ".join(f"{valve / MEGA:g}" for valve in VALVES)
    return Claim(
        "one-current-holds-all",
        "Table 1",
        "10.7 mA, found by trial, clamps apple, peach, raw egg and grape.",
        Verdict.UNTESTABLE,
        f"10.7 mA is {span * 100:.1f} % of a 4-20 mA span: {pressures} MPa for valves"
        f" of {spans} MPa; the paper names neither valve nor linkage. On the gripper"
        f" assumed here it reaches {held} of {len(grasps)} samples with"
        f" {max(forces):.1f} N down to {min(forces):.1f} N per jaw.",
        {
            "share_of_span_percent": 100 * span,
            **{
                f"pressure_of_a_{valve / KILO:.0f}_kPa_valve_kPa": span * valve / KILO
                for valve in VALVES
            },
            "samples_reached": held,
            "largest_grip_N": max(forces),
            "smallest_grip_N": min(forces),
        },
    )
