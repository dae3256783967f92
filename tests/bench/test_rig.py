from random import Random

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel
from gripperd.model import Chain

EGG = BenchObject(
    diameter=0.041, stiffness=3e4, mass=0.060, friction=0.4, damage_force=35.0
)


def grasped(chain: Chain, seed: int = 1) -> Rig:
    rig = Rig(chain, Random(seed))
    rig.plant.place(EGG)
    rig.write_current(0.0107)
    rig.advance(2.0)
    return rig


def test_the_inputs_show_pressure_opening_and_grip(chain: Chain) -> None:
    rig = grasped(chain)
    pressure, opening, grip = rig.read_inputs()
    # 209.4 of 600 kPa, 40.3 of 100 mm, 21.8 of 250 N; five sigma of 16 µA.
    assert pressure == pytest.approx(0.004 + 0.016 * 209.375 / 600, abs=8e-5)
    assert opening == pytest.approx(0.004 + 0.016 * 40.3 / 100, abs=9e-5)
    assert grip == pytest.approx(0.004 + 0.016 * 21.8 / 250, abs=9e-5)


def test_time_is_made_up_in_whole_steps(chain: Chain) -> None:
    rig = Rig(chain, Random(1))
    rig.advance(0.0105)
    assert rig.plant.time == pytest.approx(0.010)
    rig.advance(0.0110)
    assert rig.plant.time == pytest.approx(0.011)
    rig.advance(0.005)
    assert rig.plant.time == pytest.approx(0.011)


def test_it_does_not_matter_how_often_one_looks(chain: Chain) -> None:
    often, once = (Rig(chain, Random(1)) for _ in range(2))
    for rig in (often, once):
        rig.plant.place(EGG)
        rig.write_current(0.0107)
    for look in range(1, 101):
        often.advance(look * 0.0037)
    once.advance(0.37)
    assert often.plant.time == pytest.approx(0.37)
    assert often.plant.grip == once.plant.grip
    assert often.plant.opening == once.plant.opening


def test_the_same_seed_gives_the_same_readings(chain: Chain) -> None:
    first, second, other = (grasped(chain, seed) for seed in (7, 7, 8))
    assert list(first.trace) == list(second.trace)
    readings = [rig.read_inputs() for rig in (first, second, other)]
    assert readings[0] == readings[1]
    assert readings[0] != readings[2]


def test_a_broken_sensor_reads_zero_and_a_frozen_one_the_past(chain: Chain) -> None:
    rig = grasped(chain)
    before = rig.read_inputs()
    rig.plant.faults = BenchFaults(
        broken=frozenset({Channel.GRIP}), frozen=frozenset({Channel.PRESSURE})
    )
    rig.write_current(0.0)
    rig.advance(4.0)
    pressure, opening, grip = rig.read_inputs()
    assert grip == 0.0
    assert pressure == before[0]
    assert opening == pytest.approx(0.0176, abs=9e-5)


def test_holding_the_present_pressure_freezes_the_jaws(chain: Chain) -> None:
    rig = Rig(chain, Random(1))
    for step in range(150):
        rig.write_current(0.004 + 0.004 * step * 0.01)
        rig.advance(step * 0.01)
    assert rig.plant.velocity > 0.005
    stopped = rig.plant.time
    rig.write_current(float(chain.regulator.current(rig.plant.pressure)))
    rig.advance(stopped + 1.0)
    later = [sample for sample in rig.trace if sample.time > stopped + 0.1]
    assert max(sample.opening for sample in later) == pytest.approx(
        min(sample.opening for sample in later), abs=1e-6
    )


def test_the_trace_tells_the_whole_motion(chain: Chain) -> None:
    rig = grasped(chain)
    openings = [sample.opening for sample in rig.trace]
    assert openings[0] == 0.085
    assert openings[-1] == rig.plant.opening
    assert rig.trace[-1].time == rig.plant.time
    assert all(sample.current == 0.0107 for sample in rig.trace)


def test_a_day_at_rest_costs_one_step(chain: Chain) -> None:
    rig = grasped(chain)
    held = rig.plant.grip
    samples = len(rig.trace)
    rig.advance(86_400.0)
    assert len(rig.trace) == samples + 1
    assert rig.plant.time == pytest.approx(86_400.0)
    assert rig.plant.grip == held
