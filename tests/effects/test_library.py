"""What every effect promises, whoever wrote it."""

from dataclasses import fields, replace
from itertools import product

import numpy as np
import pytest

from gripperd.effects import EFFECTS
from gripperd.model import Direction, Muscle, StaticMuscle
from gripperd.model.effect import Effect, Stage
from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import in_use, parameters, words
from gripperd.model.track import Array
from gripperd.units import SI_PER_UNIT, split
from tests.effects.tracks import eventful, samples

VOCABULARY = {
    Stage.MUSCLE: """
        rubber_elasticity braid_friction threshold_pressure tapered_ends
        braid_extensibility nonlinear_elasticity temperature_stiffness coulomb_friction
        pressure_friction presliding_hysteresis pressure_hysteresis viscous_friction
        creep fatigue first_cycle""",
    Stage.VALVE: """
        valve_offset valve_gain valve_nonlinearity valve_dead_band valve_lag
        supply_saturation leak""",
    Stage.GRIPPER: """
        linkage_friction linkage_backlash jaw_compliance series_compliance""",
    Stage.SENSOR: """
        pressure_sensor_bias pressure_sensor_gain force_sensor_bias force_sensor_gain
        force_sensor_drift length_datum channel_delay ambient_pressure""",
}
STAGES = {name: stage for stage, names in VOCABULARY.items() for name in names.split()}
COLUMNS = {
    "time", "current", "pressure", "contraction", "force", "opening", "grip", "object",
    "temperature", "supply", "ambient",
}  # fmt: skip
TEXTBOOK = {"rubber_elasticity", "braid_friction"}
"""Their size is a constant of the muscle."""
CURVED = {"threshold_pressure", "tapered_ends", "braid_extensibility"}
"""Not proportional to their amplitudes."""

MUSCLE = [kind for kind in EFFECTS.values() if kind.stage is Stage.MUSCLE]


def spoken(kind: type[Effect]) -> list[Effect]:
    """The effect with every word that it may choose."""
    known = {name: one.choices for name, one in parameters(kind).items() if one.choices}
    return [
        replace(kind(), **dict(zip(known, chosen, strict=True)))
        for chosen in product(*known.values())
    ]


def told(effect: Effect) -> str:
    """Its name and its words."""
    return " ".join((effect.name, *words(effect).values()))


every = pytest.mark.parametrize("kind", EFFECTS.values(), ids=EFFECTS)
of_the_muscle = pytest.mark.parametrize("kind", MUSCLE, ids=lambda kind: kind.name)
each_of_the_muscle = pytest.mark.parametrize(
    "effect", [one for kind in MUSCLE for one in spoken(kind)], ids=told
)
every_one = pytest.mark.parametrize(
    "effect", [one for kind in EFFECTS.values() for one in spoken(kind)], ids=told
)
with_amplitude = pytest.mark.parametrize(
    "effect",
    [one for kind in MUSCLE if kind.name not in TEXTBOOK for one in spoken(kind)],
    ids=told,
)
linear = pytest.mark.parametrize(
    "effect",
    [
        one
        for kind in MUSCLE
        if kind.name not in CURVED | TEXTBOOK
        for one in spoken(kind)
    ],
    ids=told,
)


def amplitudes(effect: Effect) -> dict[str, float]:
    """Typical sizes of the amplitudes that mean something beside its words."""
    known = in_use(effect, effect.idle)
    return {name: one.scale for name, one in known.items() if one.is_amplitude}


def with_amplitudes(effect: Effect, factors: Array) -> Effect:
    """The effect with its amplitudes at their typical size times a factor each."""
    sizes = zip(factors, amplitudes(effect).items(), strict=False)
    return replace(effect, **{name: factor * size for factor, (name, size) in sizes})


def change(effect: Effect, muscle: Muscle) -> Array:
    """What it adds to a pull of 100 N."""
    track = eventful(muscle)
    pull = np.full_like(track.time, 100.0)
    return effect.along(pull, track, effect.rest()) - pull


def test_every_muscle_effect_of_the_vocabulary_is_there() -> None:
    assert {kind.name for kind in MUSCLE} == set(VOCABULARY[Stage.MUSCLE].split())


@every
def test_it_stands_in_the_file_of_its_name(kind: type[Effect]) -> None:
    assert kind.__module__ == f"gripperd.effects.{kind.name}"
    assert EFFECTS[kind.name] is kind


@every
def test_name_and_stage_are_those_of_the_vocabulary(kind: type[Effect]) -> None:
    assert STAGES[kind.name] is kind.stage


@every
def test_rivals_have_names_of_the_vocabulary(kind: type[Effect]) -> None:
    assert set(kind.confused_with) <= STAGES.keys() - {kind.name}
    assert len(set(kind.confused_with)) == len(kind.confused_with)


@every
def test_it_can_be_told_to_a_person(kind: type[Effect]) -> None:
    for text in (kind.shows, kind.remedy):
        assert len(text.split()) > 3
        assert not text.endswith(".")


@every
def test_what_it_needs_are_columns_of_a_recording(kind: type[Effect]) -> None:
    assert kind.needs <= COLUMNS


@every
def test_every_default_lies_inside_its_bounds(kind: type[Effect]) -> None:
    for name, known in parameters(kind).items():
        value = getattr(kind(), name)
        if known.is_amplitude or known.starts:
            assert known.low <= value <= known.high
        if known.is_amplitude:
            # Rubber and braid of the paper's model have nothing to be measured first.
            assert value == (1 if name == "share" and kind.name in TEXTBOOK else 0)
            assert known.scale < max(-known.low, known.high)


@every
def test_every_start_of_a_shape_lies_inside_its_bounds(kind: type[Effect]) -> None:
    for name, known in parameters(kind).items():
        assert all(known.low <= start <= known.high for start in known.starts)
        assert not known.starts or getattr(kind(), name) == known.starts[0]
        assert not (known.starts and known.is_amplitude)


@every
def test_every_key_of_a_file_tells_name_and_unit_apart(kind: type[Effect]) -> None:
    for name, known in parameters(kind).items():
        if known.unit is None:
            assert split(name) == (name, None)
        else:
            assert known.unit in SI_PER_UNIT
            assert split(f"{name}_{known.unit}") == (name, known.unit)


@of_the_muscle
def test_every_number_of_it_is_declared(kind: type[Effect]) -> None:
    numbers = {each.name for each in fields(kind) if isinstance(each.default, float)}
    known = parameters(kind)
    assert numbers == {name for name, one in known.items() if not one.choices}


@with_amplitude
def test_without_amplitude_there_is_no_effect(effect: Effect, muscle: Muscle) -> None:
    known = parameters(effect)
    shapes = {name: each.starts[-1] for name, each in known.items() if each.starts}
    for one in (effect, replace(effect, **shapes)):
        assert change(one, muscle) == pytest.approx(0.0, abs=1e-9)


@with_amplitude
def test_each_amplitude_alone_shows(effect: Effect, muscle: Muscle) -> None:
    for factors in np.eye(len(amplitudes(effect))):
        assert np.abs(change(with_amplitudes(effect, factors), muscle)).max() > 0.05


@linear
def test_amplitudes_add_up(effect: Effect, muscle: Muscle) -> None:
    count = len(amplitudes(effect))
    weights = np.array([2.0, 0.7, 1.3])[:count]
    alone = [change(with_amplitudes(effect, row), muscle) for row in np.eye(count)]
    together = change(with_amplitudes(effect, weights), muscle)
    assert together == pytest.approx(weights @ np.array(alone), abs=1e-9)


@every_one
def test_a_run_given_whole_or_sample_by_sample_is_the_same(
    effect: Effect, muscle: Muscle
) -> None:
    effect = with_amplitudes(effect, np.ones(4))
    track, memory = eventful(muscle), effect.rest()
    pull = np.full_like(track.time, 100.0)
    whole = effect.along(pull, track, effect.rest())
    piecewise = [
        effect.along(pull[:1], sample, memory).item() for sample in samples(track)
    ]
    assert piecewise == pytest.approx(whole, abs=1e-9)


@each_of_the_muscle
@pytest.mark.parametrize("direction", Direction)
def test_the_pressure_for_a_force_gives_that_force(
    effect: Effect, direction: Direction, muscle: Muscle
) -> None:
    effect = with_amplitudes(effect, np.ones(4))
    assert isinstance(effect, InMuscle)
    static = StaticMuscle(muscle, (effect,))
    forces = np.linspace(50.0, 400.0, 8)
    found = static.pressure(forces, 0.08, direction)
    assert static.force(found, 0.08, direction) == pytest.approx(forces, rel=1e-7)
