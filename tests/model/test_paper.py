"""The paper's equations against a table computed apart from this package.

The table prints six decimals, so a value agrees to 1e-9 of itself or half a digit.
"""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Direction, Muscle, MuscleState, StaticMuscle
from gripperd.model.real import Real

TABLE = Path(__file__).with_name("golden_paper_model.csv").read_text(encoding="ascii")
ROWS = [
    {name: float(value) for name, value in row.items()}
    for row in csv.DictReader(TABLE.splitlines())
]
COLUMNS = {name: np.array([row[name] for row in ROWS]) for name in ROWS[0]}
COMPUTED = [name for name in COLUMNS if name not in {"p_gauge_Pa", "h"}]

RUBBER = RubberElasticity()
REBRACED = BraidFriction()
AS_PRINTED = BraidFriction(Form.AS_PRINTED)


def paper_value(column: str, muscle: Muscle, pressure: Real, contraction: Real) -> Real:
    """What this package gives for one column of the table."""
    ratio = muscle.diameter_ratio(contraction)
    at = MuscleState(pressure, contraction, ratio, Direction.CONTRACTING)
    contact: Real = pressure - REBRACED.kinks(contraction, ratio, muscle)[0]
    values: dict[str, Real] = {
        "theta_deg": np.degrees(np.arcsin(ratio * math.sin(muscle.braid_angle))),
        "D_mm": 1e3 * muscle.diameter * ratio,
        "F_ideal_N": pressure * muscle.pull_area(contraction),
        "F_elastic_N": -RUBBER.force(at, muscle),
        "F_static_no_friction_N": StaticMuscle(muscle, (RUBBER,)).force(
            pressure, contraction
        ),
        "Fk_eq6_as_printed": AS_PRINTED.magnitude(at, muscle),
        "Fk_eq6_rebraced_N": muscle.friction_coefficient
        * contact
        * math.pi
        * muscle.diameter
        * ratio
        * muscle.rest_length
        * (1 - contraction),
        "Fk_eq6_rebraced_clamped_N": REBRACED.magnitude(at, muscle),
        "contact_pressure_Pa": contact,
    }
    return values[column]


def test_the_table_covers_110_points() -> None:
    assert len(ROWS) == 110
    assert len(COMPUTED) == 9


@pytest.mark.parametrize("column", COMPUTED)
def test_arrays_reproduce_the_table(muscle: Muscle, column: str) -> None:
    pressure, contraction = COLUMNS["p_gauge_Pa"], COLUMNS["h"]
    value = paper_value(column, muscle, pressure, contraction)
    assert value == pytest.approx(COLUMNS[column], rel=1e-9, abs=5.001e-7)


@pytest.mark.parametrize("column", COMPUTED)
def test_single_values_reproduce_the_table(muscle: Muscle, column: str) -> None:
    for row in ROWS:
        value = paper_value(column, muscle, row["p_gauge_Pa"], row["h"])
        assert value == pytest.approx(row[column], rel=1e-9, abs=5.001e-7), row


def test_the_bladder_leaves_the_braid_where_the_friction_is_zero() -> None:
    loose = COLUMNS["contact_pressure_Pa"] < 0
    assert loose.any()
    assert (COLUMNS["Fk_eq6_rebraced_clamped_N"][loose] == 0).all()


FREE_CONTRACTION = """
.05 .0423 .0410 .0436 .0421 .0425
.10 .0935 .0911 .0959 .0928 .0942
.20 .1791 .1747 .1836 .1767 .1815
.30 .2286 .2232 .2341 .2251 .2322
.40 .2579 .2520 .2638 .2536 .2622
.50 .2768 .2707 .2830 .2720 .2816
.60 .2900 .2837 .2964 .2849 .2952
.80 .3072 .3007 .3137 .3016 .3128
"""
"""Gauge pressure [MPa]; then the contraction at which the force is zero: without
friction, and with eq. (6) as printed and rebraced, each contracting and extending."""

VARIANTS = [
    ((RUBBER,), Direction.CONTRACTING),
    ((RUBBER, AS_PRINTED), Direction.CONTRACTING),
    ((RUBBER, AS_PRINTED), Direction.EXTENDING),
    ((RUBBER, REBRACED), Direction.CONTRACTING),
    ((RUBBER, REBRACED), Direction.EXTENDING),
]


@pytest.mark.parametrize("line", FREE_CONTRACTION.split("\n")[1:-1])
def test_a_free_muscle_stops_where_the_published_table_says(
    muscle: Muscle, line: str
) -> None:
    megapascal, *published = map(float, line.split())
    for (effects, direction), contraction in zip(VARIANTS, published, strict=True):
        static = StaticMuscle(muscle, effects)

        def pull(
            h: float, static: StaticMuscle = static, way: int = direction
        ) -> float:
            return float(static.force(megapascal * 1e6, h, way))

        assert brentq(pull, 0.0, 0.36) == pytest.approx(contraction, abs=5e-5)
