from random import Random
from statistics import fmean, stdev

import pytest

from gripperd.bench.sensors import Channel, Sensor, Sensors, SensorSettings
from gripperd.protocol.live_zero import LoopScale

PRESSURE = Sensor(LoopScale(value_low=0.0, value_high=600e3), 0.0)
VALUES = {Channel.PRESSURE: 300e3, Channel.OPENING: 0.05, Channel.GRIP: 125.0}


@pytest.mark.parametrize(
    ("pressure", "current"),
    [
        (0.0, 0.004),
        (300e3, 0.012),
        (600e3, 0.020),
        (100e3, 0.006667),
        (-50e3, 0.0038),
        (900e3, 0.0205),
    ],
)
def test_a_transmitter_is_linear_and_saturates_as_namur_says(
    pressure: float, current: float
) -> None:
    assert PRESSURE.current(pressure, Random(0)) == current


def test_noise_is_that_part_of_the_span() -> None:
    noisy = Sensor(LoopScale(value_low=0.0, value_high=600e3), 0.002)
    rng = Random(1)
    currents = [noisy.current(300e3, rng) for _ in range(4000)]
    assert fmean(currents) == pytest.approx(0.012, abs=3e-6)
    assert stdev(currents) == pytest.approx(0.002 * 0.016, rel=0.05)


def test_channels_come_in_the_order_of_the_module() -> None:
    settings = SensorSettings(
        pressure=Sensor(LoopScale(value_low=0.0, value_high=400e3), 0.0),
        opening=Sensor(LoopScale(value_low=0.0, value_high=0.1), 0.0),
        grip=Sensor(LoopScale(value_low=0.0, value_high=1000.0), 0.0),
    )
    read = Sensors(settings, Random(0)).read(VALUES)
    assert read == (0.016, 0.012, 0.006)


def test_a_broken_sensor_gives_no_current() -> None:
    sensors = Sensors(SensorSettings(), Random(0))
    read = sensors.read(VALUES, broken={Channel.OPENING})
    assert read[1] == 0.0
    assert read[0] == pytest.approx(0.012, abs=1e-4)


def test_a_shorted_sensor_gives_more_than_any_working_one() -> None:
    sensors = Sensors(SensorSettings(), Random(0))
    pressure, opening, _ = sensors.read(VALUES, shorted={Channel.OPENING})
    assert opening == 0.024
    assert pressure == pytest.approx(0.012, abs=1e-4)


def test_a_spiking_sensor_is_wild_now_and_then_and_right_in_between() -> None:
    healthy = Sensors(SensorSettings(), Random(3))
    spiking = Sensors(SensorSettings(), Random(3))
    good = [healthy.read(VALUES)[2] for _ in range(2000)]
    read = [spiking.read(VALUES, spiking={Channel.GRIP})[2] for _ in range(2000)]
    wild = [now for now, right in zip(read, good, strict=True) if now != right]
    assert len(wild) == pytest.approx(200, rel=0.2)
    assert 0.0 <= min(wild) < 0.0015
    assert 0.0225 < max(wild) <= 0.024


def test_the_same_seed_gives_the_same_spikes() -> None:
    one, another = (Sensors(SensorSettings(), Random(7)) for _ in range(2))
    for _ in range(50):
        spiking = {Channel.PRESSURE, Channel.GRIP}
        assert one.read(VALUES, spiking=spiking) == another.read(
            VALUES, spiking=spiking
        )


def test_a_frozen_sensor_repeats_its_last_reading() -> None:
    sensors = Sensors(SensorSettings(), Random(0))
    before = sensors.read(VALUES)
    moved = {**VALUES, Channel.GRIP: 10.0, Channel.PRESSURE: 100e3}
    after = sensors.read(moved, frozen={Channel.GRIP})
    assert after[2] == before[2]
    assert after[0] == pytest.approx(0.006667, abs=1e-4)
    assert sensors.read(moved)[2] == pytest.approx(0.00464, abs=1e-4)


def test_a_fault_of_one_sensor_leaves_the_noise_of_the_others_alone() -> None:
    healthy = Sensors(SensorSettings(), Random(5))
    faulty = Sensors(SensorSettings(), Random(5))
    for _ in range(3):
        good = healthy.read(VALUES)
        bad = faulty.read(VALUES, broken={Channel.PRESSURE}, frozen={Channel.OPENING})
        assert bad[2] == good[2]


def test_spikes_of_one_sensor_leave_the_noise_of_the_others_alone() -> None:
    healthy = Sensors(SensorSettings(), Random(5))
    faulty = Sensors(SensorSettings(), Random(5))
    for _ in range(100):
        good = healthy.read(VALUES)
        bad = faulty.read(VALUES, spiking={Channel.PRESSURE})
        assert bad[1:] == good[1:]
