from collections.abc import Iterable
from random import Random

from gripperd.control.spikes import Spikes

SPAN, SIGMA, PERIOD = 100.0, 0.05, 0.01


def doubted(
    spikes: Spikes, values: Iterable[float | None], dt: float = PERIOD
) -> list[float | None]:
    """Samples that are not to be used."""
    return [value for value in values if spikes.update(value, SIGMA, dt)]


def test_a_sample_that_stands_alone_is_doubted_and_no_other() -> None:
    assert doubted(Spikes(SPAN), [20.0, 20.1, 99.0, 20.0, 20.1]) == [99.0]


def test_a_second_sample_confirms_a_step() -> None:
    assert doubted(Spikes(SPAN), [20.0, 60.0, 60.1, 60.0]) == [60.0]


def test_a_quick_motion_is_doubted_at_its_beginning_and_at_its_turn() -> None:
    there = [float(value) for value in range(0, 100, 20)]
    spikes = Spikes(SPAN)
    assert doubted(spikes, [0.0, *there, *there[-2::-1], 0.0]) == [20.0, 60.0]
    assert not spikes.many


def test_less_than_a_twentieth_of_the_span_is_no_leap() -> None:
    assert doubted(Spikes(SPAN), [20.0, 24.9, 20.0, 15.1, 20.0]) == []
    assert doubted(Spikes(SPAN), [20.0, 25.1, 20.0, 14.9, 20.0]) == [25.1, 14.9]


def test_a_sensor_that_is_noisy_throughout_has_no_spikes() -> None:
    rng, spikes = Random(1), Spikes(SPAN)
    noisy = [rng.gauss(50.0, 3.0) for _ in range(5000)]
    assert not any(spikes.update(value, 3.0, PERIOD) for value in noisy)
    assert not spikes.many


def test_a_third_spike_within_a_second_is_one_too_many() -> None:
    spikes = Spikes(SPAN)
    quiet = [20.0] * 40
    doubted(spikes, [*quiet, 99.0, *quiet, 0.0, 20.0])
    assert not spikes.many
    doubted(spikes, [50.0])
    assert not spikes.many
    doubted(spikes, [20.0])
    assert spikes.many


def test_spikes_that_come_rarely_are_never_too_many() -> None:
    spikes = Spikes(SPAN)
    for _ in range(20):
        assert doubted(spikes, [*[20.0] * 60, 99.0]) == [99.0]
        assert not spikes.many


def test_a_second_without_spikes_is_enough_to_be_believed() -> None:
    spikes = Spikes(SPAN)
    doubted(spikes, [20.0, 99.0, 20.0, 0.0, 20.0, 50.0, 20.0])
    doubted(spikes, [20.0] * 99)
    assert spikes.many
    doubted(spikes, [20.0] * 2)
    assert not spikes.many


def test_a_loose_contact_is_as_bad_as_spikes() -> None:
    spikes = Spikes(SPAN)
    doubted(spikes, [20.0, None, 20.0, None, None, 20.0, None])
    assert not spikes.many
    doubted(spikes, [20.0])
    assert spikes.many


def test_a_sensor_that_was_away_begins_anew() -> None:
    spikes = Spikes(SPAN)
    away = [None] * 3
    for _ in range(5):
        assert doubted(spikes, [20.0, *away, 90.0, *away]) == []
    assert not spikes.many


def test_rare_samples_may_differ_by_anything() -> None:
    spikes = Spikes(SPAN)
    assert doubted(spikes, [0.0, 99.0] * 5, dt=0.1) == []
    assert not spikes.many
