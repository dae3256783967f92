"""A channel that is sampled late."""

import numpy as np
import pytest

from gripperd.effects.channel_delay import ChannelDelay
from gripperd.model import Muscle
from gripperd.model.effect import Signal
from gripperd.model.memory import KEPT
from tests.effects.tracks import samples, track_of

TIME = np.arange(0.0, 4.0, 0.02)
SWING = 100.0 + 50.0 * np.sin(2 * np.pi * 0.5 * TIME)


def test_a_ramp_is_late_by_the_delay(muscle: Muscle) -> None:
    effect = ChannelDelay(delay=0.05, channel=Signal.FORCE)
    track = track_of(muscle, time=TIME)
    late = effect.along(30.0 * TIME, track, effect.rest())
    assert late[10:] == pytest.approx(30.0 * (TIME[10:] - 0.05))
    assert late[:3] == pytest.approx(0.0)


def test_what_was_late_is_put_back(muscle: Muscle) -> None:
    effect = ChannelDelay(delay=0.05)
    track = track_of(muscle, time=TIME)
    back = effect.truth(effect.along(SWING, track, effect.rest()), track)
    # Two linear interpolations of a swing of 0.5 Hz, each within a² dt² / 8 of it.
    error = 2 * 50.0 * (np.pi * 0.02) ** 2 / 8
    assert back[3:-3] == pytest.approx(SWING[3:-3], abs=error)


def test_no_delay_changes_nothing(muscle: Muscle) -> None:
    effect = ChannelDelay()
    track = track_of(muscle, time=TIME)
    assert effect.along(SWING, track, effect.rest()).tolist() == SWING.tolist()


@pytest.mark.parametrize("channel", Signal)
def test_any_channel_may_be_late(channel: Signal) -> None:
    assert ChannelDelay(channel=channel).signal is channel


def test_sample_by_sample_it_remembers_a_second_at_a_kilohertz(muscle: Muscle) -> None:
    effect = ChannelDelay(delay=1.0)
    time = 1e-3 * np.arange(2.5 * KEPT)
    track, memory = track_of(muscle, time=time), effect.rest()
    value = np.sin(3 * time)
    late = [
        effect.along(value[i : i + 1], sample, memory).item()
        for i, sample in enumerate(samples(track))
    ]
    assert late == pytest.approx(effect.along(value, track, effect.rest()))


def test_nothing_is_not_late(muscle: Muscle) -> None:
    effect = ChannelDelay(delay=0.05)
    track = track_of(muscle, time=np.empty(0))
    assert effect.along(np.empty(0), track, effect.rest()).size == 0


def test_what_is_not_known_lies_between_what_is(muscle: Muscle) -> None:
    effect = ChannelDelay(delay=0.03)
    holed = 30.0 * TIME
    holed[[50, 51]] = np.nan
    track = track_of(muscle, time=TIME)
    late = effect.along(holed, track, effect.rest())
    assert late[2:] == pytest.approx(30.0 * (TIME[2:] - 0.03))
    nothing = effect.along(np.full_like(TIME, np.nan), track, effect.rest())
    assert np.isnan(nothing).all()
