"""What every effect outside the muscle promises, whatever it does."""

from dataclasses import fields, replace

import numpy as np
import pytest

from gripperd.effects import EFFECTS
from gripperd.model import Muscle
from gripperd.model.effect import Effect, SensorEffect, Stage, acts_in_sensor
from gripperd.model.parameter import parameters
from gripperd.model.track import Array, Track
from tests.effects.tracks import eventful, samples

KINDS = [kind for kind in EFFECTS.values() if kind.stage is not Stage.MUSCLE]
SENSORS = [kind for kind in KINDS if kind.stage is Stage.SENSOR]
elsewhere = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
CURVED = {"valve_dead_band", "linkage_backlash", "channel_delay", "leak"}
"""Not proportional to their amplitudes."""


def course(muscle: Muscle) -> Track:
    """Every column moves, the supply and the weather too."""
    track = eventful(muscle)
    time = track.time
    return replace(
        track,
        command=200e3 * (1 - np.cos(0.8 * time)),
        still=time % 5.0,
        waiting=time % 5.0,
        force=300.0 + 200.0 * np.sin(time),
        grip=30.0 + 20.0 * np.sin(time),
        supply_drop=40e3 - 40e3 * np.sin(0.3 * time),
        ambient=101e3 - 100.0 * time,
    )


def signal(track: Track) -> Array:
    """What the effect acts on: swings over most of the regulator's line."""
    return 250e3 - 240e3 * np.cos(0.8 * track.time)


def with_sizes(kind: type[Effect], factor: float) -> Effect:
    known = parameters(kind)
    sizes = {name: factor * p.scale for name, p in known.items() if p.is_amplitude}
    return replace(kind(), **sizes)


def change(effect: Effect, track: Track) -> Array:
    value = signal(track)
    return effect.along(value, track, effect.rest()) - value


@elsewhere
def test_without_amplitude_there_is_no_effect(
    kind: type[Effect], muscle: Muscle
) -> None:
    shapes = {
        name: each.starts[-1] for name, each in parameters(kind).items() if each.starts
    }
    for effect in (with_sizes(kind, 0.0), replace(with_sizes(kind, 0.0), **shapes)):
        assert change(effect, course(muscle)) == pytest.approx(0.0, abs=1e-9)


@elsewhere
def test_each_amplitude_alone_shows(kind: type[Effect], muscle: Muscle) -> None:
    for name, known in parameters(kind).items():
        if known.is_amplitude and name != "shortening":
            effect = replace(with_sizes(kind, 0.0), **{name: known.scale})
            assert np.abs(change(effect, course(muscle))).max() >= 0.1 * known.scale


@pytest.mark.parametrize(
    "kind",
    [kind for kind in KINDS if kind.name not in CURVED],
    ids=lambda kind: kind.name,
)
def test_twice_the_amplitude_is_twice_the_effect(
    kind: type[Effect], muscle: Muscle
) -> None:
    once, half = (change(with_sizes(kind, f), course(muscle)) for f in (1.0, 0.5))
    assert once == pytest.approx(2 * half, rel=1e-9, abs=1e-6)


@elsewhere
def test_a_run_given_whole_or_sample_by_sample_is_the_same(
    kind: type[Effect], muscle: Muscle
) -> None:
    effect, track = with_sizes(kind, 1.0), course(muscle)
    memory, value = effect.rest(), signal(track)
    whole = effect.along(value, track, effect.rest())
    piecewise = [
        effect.along(value[i : i + 1], sample, memory).item()
        for i, sample in enumerate(samples(track))
    ]
    assert piecewise == pytest.approx(whole, abs=1e-9)


@elsewhere
def test_every_parameter_is_declared(kind: type[Effect]) -> None:
    assert {each.name for each in fields(kind)} == parameters(kind).keys()


@pytest.mark.parametrize(
    "kind",
    [kind for kind in SENSORS if kind.name != "channel_delay"],
    ids=lambda kind: kind.name,
)
def test_the_truth_behind_a_reading_is_found_again(
    kind: type[Effect], muscle: Muscle
) -> None:
    effect, track = with_sizes(kind, 1.0), course(muscle)
    assert acts_in_sensor(effect)
    sensor: SensorEffect = effect
    reading = sensor.along(signal(track), track, sensor.rest())
    assert sensor.truth(reading, track) == pytest.approx(signal(track), rel=1e-12)


def test_a_choice_lists_all_its_words() -> None:
    known = parameters(EFFECTS["channel_delay"])["channel"]
    assert [*known.choices] == [
        "pressure", "contraction", "force", "opening", "grip",
    ]  # fmt: skip
    assert not known.starts
    assert not known.is_amplitude
