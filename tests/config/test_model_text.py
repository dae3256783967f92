from dataclasses import fields, replace
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gripperd.config import ModelFile, load_model, model_text, shipped
from gripperd.config.lineage import (
    Added,
    Covariance,
    Gap,
    Lineage,
    Provenance,
    Recorded,
)
from gripperd.config.number import factor_of, written
from gripperd.config.section import NAME
from gripperd.effects import EFFECTS
from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.creep import Creep
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.effects.valve_lag import ValveLag
from gripperd.errors import ConfigError
from gripperd.model import Linkage, Muscle, Regulator, StaticMuscle
from gripperd.model.effect import Effect
from gripperd.model.parameter import parameters
from gripperd.units import SI_PER_UNIT

KINDS: tuple[type[Effect], ...] = (
    RubberElasticity, BraidFriction, Creep, ValveLag, PressureSensorBias,
)  # fmt: skip
LIBRARY = {kind.name: kind for kind in KINDS}
WORDS = st.text(min_size=1, max_size=20).filter(lambda text: "\r" not in text)


def number(
    low: float, high: float, unit: str | None = None
) -> st.SearchStrategy[float]:
    """A value in SI that a file can say, from the ends in the unit of the file."""
    return st.floats(low, high).map(lambda value: value * factor_of(unit))


MUSCLES = st.builds(
    Muscle,
    rest_length=number(10, 10_000, "mm"),
    diameter=number(110, 200, "mm"),
    braid_angle=number(5, 54, "deg"),
    wall_thickness=number(0.1, 50, "mm"),
    elastic_modulus=number(0.01, 1000, "MPa"),
    friction_coefficient=number(0, 2),
)
REGULATORS = st.builds(
    Regulator,
    current_low=number(0, 10, "mA"),
    current_high=number(11, 24, "mA"),
    pressure_low=number(-100, 0, "kPa"),
    pressure_high=number(1, 2000, "kPa"),
)
LINKAGES = st.builds(
    Linkage,
    open_width=number(1, 1000, "mm"),
    ratio=number(0.01, 100),
    spring_preload=number(0, 100_000, "N"),
    spring_rate=number(0, 10_000, "N_per_mm"),
)


@st.composite
def effects(draw: st.DrawFn, kind: type[Effect]) -> Effect:
    chosen: dict[str, Any] = {
        name: draw(
            st.sampled_from(known.choices)
            if known.choices
            else number(
                known.low / factor_of(known.unit),
                known.high / factor_of(known.unit),
                known.unit,
            )
        )
        for name, known in parameters(kind).items()
    }
    if kind is BraidFriction:
        return BraidFriction(draw(st.sampled_from(Form)), **chosen)
    built: Any = kind
    return built(**chosen)  # type: ignore[no-any-return]


PROVENANCES = st.builds(
    Provenance,
    program=WORDS,
    recording=st.builds(
        Recorded,
        name=WORDS,
        sha256=st.text("0123456789abcdef", min_size=64, max_size=64),
    ),
    seed=st.integers(0, 2**32),
    effects=st.lists(
        st.builds(
            Added,
            name=WORDS,
            parameters=st.just({"slow": 0.1, "time_s": 2.5}),
            std=st.dictionaries(st.just("slow"), st.floats(0, 1)),
        ),
        max_size=2,
    ).map(tuple),
    covariance=st.none()
    | st.builds(
        Covariance,
        parameters=st.just(("creep.slow", "creep.time_s")),
        matrix=st.floats(-1, 1).map(lambda both: ((1.0, both), (both, 1.0))),
    ),
    gap=st.none()
    | st.builds(
        Gap,
        signal=WORDS,
        unit=WORDS,
        rmse_before=st.floats(0, 1e3),
        rmse_recalibrated=st.floats(0, 1e3),
        rmse_after=st.floats(0, 1e3),
        noise_floor=st.floats(0, 1e3),
    ),
    heldout_runs=st.lists(WORDS, max_size=3).map(tuple),
)
LINEAGES = st.builds(
    Lineage,
    version=st.integers(10, 99),
    parent=st.integers(0, 9),
    created_at=st.datetimes(timezones=st.just(UTC)),
    provenance=PROVENANCES,
)


@st.composite
def models(draw: st.DrawFn) -> ModelFile:
    kinds = draw(st.lists(st.sampled_from(KINDS), unique=True))
    chosen = [draw(effects(kind)) for kind in kinds]
    in_muscle: Any = tuple(each for each in chosen if each.stage == "muscle")
    muscle, regulator = draw(MUSCLES), draw(st.none() | REGULATORS)
    known = {
        f"muscle.{each.name}": getattr(muscle, each.name) for each in fields(muscle)
    }
    toleranced = draw(
        st.sets(st.sampled_from(["muscle.rest_length", "muscle.diameter"]))
    )
    tolerances = {
        path: draw(number(0.001, 0.002, "mm"))
        for path in known
        if path in toleranced and 0.011 < known[path] < 0.199
    }
    return ModelFile(
        name=draw(st.from_regex(NAME, fullmatch=True)),
        static=StaticMuscle(muscle, in_muscle),
        regulator=regulator,
        linkage=draw(st.none() | LINKAGES),
        effects=tuple(each for each in chosen if each.stage != "muscle"),
        tolerances=tolerances,
        lineage=draw(st.none() | LINEAGES),
        source="",
    )


@given(models())
@settings(
    max_examples=60,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
def test_what_was_written_is_read_again_to_the_last_bit(
    tmp_path: Path, model: ModelFile
) -> None:
    path = tmp_path / "m.yaml"
    path.write_text(model_text(model), encoding="utf-8")
    assert load_model(path, LIBRARY) == model


@given(st.floats(1e-6, 1e6), st.sampled_from([None, *SI_PER_UNIT]))
@settings(max_examples=500)
def test_a_number_of_a_file_survives_the_way_to_si_and_back(
    given_number: float, unit: str | None
) -> None:
    value = given_number * factor_of(unit)
    assert written(value, unit) * factor_of(unit) == value


@given(st.floats(1e-6, 1e6), st.sampled_from([None, *SI_PER_UNIT]))
def test_any_value_in_si_is_off_by_no_more_than_its_last_bit(
    value: float, unit: str | None
) -> None:
    read = written(value, unit) * factor_of(unit)
    assert abs(read - value) <= 2**-52 * value


def test_a_short_number_stays_short() -> None:
    numbers = [tenths / 10 for tenths in range(1, 1000)]
    for unit in ("mm", "kPa", "deg", "MPa"):
        back = [written(each * factor_of(unit), unit) for each in numbers]
        assert back == numbers


def test_the_shipped_model_is_written_as_it_reads(tmp_path: Path) -> None:
    model = load_model(shipped("models/reference.yaml"))
    path = tmp_path / "m.yaml"
    path.write_text(model_text(model))
    assert load_model(path) == model
    assert "diameter_mm: {value: 20.0, tolerance: 0.1}" in path.read_text()


LINEAGE = """
version: 3
parent: 1
created_at: 2026-01-31T13:00:00+01:00
provenance: {program: 0.1.0, recording: {name: a.csv, sha256: HASH}, seed: 1}
"""


def versioned(tmp_path: Path, lineage: str) -> Path:
    path = tmp_path / "m.yaml"
    text = shipped("models/reference.yaml").read_text()
    path.write_text(text + lineage.replace("HASH", "a" * 64))
    return path


def test_a_version_is_a_model_file_that_says_where_it_comes_from(
    tmp_path: Path,
) -> None:
    model = load_model(versioned(tmp_path, LINEAGE))
    plain = load_model(shipped("models/reference.yaml"))
    assert model.lineage == Lineage(
        version=3,
        parent=1,
        created_at=datetime(2026, 1, 31, 13, tzinfo=timezone(timedelta(hours=1))),
        provenance=Provenance(
            program="0.1.0", recording=Recorded(name="a.csv", sha256="a" * 64), seed=1
        ),
    )
    assert replace(model, lineage=None) == plain


@given(
    sizes=st.lists(st.floats(1e-6, 1e6), min_size=3, max_size=3),
    shares=st.lists(st.integers(-1000, 1000), min_size=6, max_size=6),
)
def test_any_covariance_can_be_kept_with_six_digits(
    sizes: list[float], shares: list[int]
) -> None:
    """Of numbers that hang together as closely as can be: two sources for three."""
    mixed = np.reshape(shares, (3, 2)) * np.array(sizes)[:, None]
    matrix = [[float(f"{x:.6g}") for x in row] for row in (mixed @ mixed.T).tolist()]
    rows = tuple(map(tuple, matrix))
    kept = Covariance(parameters=("a", "b", "c"), matrix=rows)
    assert kept.matrix == rows


def test_numbers_that_were_fitted_together_stay_so_in_a_chain(tmp_path: Path) -> None:
    names = (
        "parameter:muscle.diameter_mm, parameter:response.valve_ms,"
        " parameter:gripper.width_per_contraction, parameter:valve.pressure_low_kPa,"
        " rubber_elasticity.share, parameter:muscle.friction_coefficient"
    )
    matrix = (
        "[0.04, 1, -0.01, 0.2, 0, 0], [1, 99, 0, 0, 0, 0],"
        "[-0.01, 0, 0.01, 0, 0, 0], [0.2, 0, 0, 4.0, -0.5, 0],"
        "[0, 0, 0, -0.5, 0.25, 0], [0, 0, 0, 0, 0, 0]"
    )
    covariance = f"seed: 1, covariance: {{parameters: [{names}], matrix: [{matrix}]}}"
    chain = load_model(
        versioned(tmp_path, LINEAGE.replace("seed: 1", covariance))
    ).chain()
    there = {pair: r for pair, r in chain.correlations.items() if r}
    assert there == {
        ("muscle.diameter", "gripper.ratio"): pytest.approx(-0.5),
        ("muscle.diameter", "valve.pressure_low"): pytest.approx(0.5),
        ("valve.pressure_low", "effects.rubber_elasticity.share"): pytest.approx(-0.5),
    }


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("parent: 1\n", "", "parent: is missing"),
        ("parent: 1", "parent: 3", "parent 3 is not older than version 3"),
        ("T13:00:00+01:00", "", '"2026-01-31" is not a time with its zone'),
        ("2026-01", "then", 'created_at: "then-31T13:00:00+01:00" is not a time with'),
        ("version: 3", "verson: 3", "verson: is not a key here"),
        ("HASH", "HASHES", "provenance.recording.sha256: "),
        ("seed: 1", "seed: -1", "provenance.seed: -1 is below 0"),
        (
            "seed: 1",
            "seed: 1, covariance: {parameters: [a, b], matrix: [[1, 0], [0]]}",
            "the matrix is not 2 by 2, one row a parameter",
        ),
        (
            "seed: 1",
            "seed: 1, covariance: {parameters: [a, b], matrix: [[1, 3], [3, 4]]}",
            "the covariances of a and b, 3 and 3, must be one number, of at most 2",
        ),
        (
            "seed: 1",
            "seed: 1, covariance: {parameters: [a, b], matrix: [[1, 1], [0, 4]]}",
            "the covariances of a and b, 1 and 0, must be one number",
        ),
        (
            "seed: 1",
            "seed: 1, effects: [{name: creep, std: {slow: 1}}]",
            "std.slow has no value among the parameters",
        ),
    ],
)
def test_a_version_that_cannot_be_understood_is_refused(
    tmp_path: Path, good: str, bad: str, complaint: str
) -> None:
    assert LINEAGE.count(good) == 1
    with pytest.raises(ConfigError) as refused:
        load_model(versioned(tmp_path, LINEAGE.replace(good, bad)))
    assert complaint in str(refused.value)


@pytest.mark.parametrize("kind", EFFECTS.values(), ids=EFFECTS.keys())
def test_every_effect_of_the_library_can_be_written_and_read(
    tmp_path: Path, kind: type[Effect]
) -> None:
    shapes = {
        name: known.starts[-1] if known.starts else known.scale
        for name, known in parameters(kind).items()
        if known.starts or known.is_amplitude
    }
    built: Any = kind
    effect: Any = built(**shapes)
    base = load_model(shipped("models/reference.yaml"))
    static = replace(base.static, effects=())
    model = replace(base, static=static, effects=(effect,))
    if effect.stage == "muscle":
        model = replace(base, static=replace(static, effects=(effect,)))
    path = tmp_path / "m.yaml"
    path.write_text(model_text(model))
    assert load_model(path) == model
