"""What a fault makes the jaws do."""

from gripperd.control.dispatch import STOP_TIME
from gripperd.control.reaction import Ease

from .stage import PERIOD, Stage


def test_a_stall_before_the_current_is_written_is_no_time_to_follow_it(
    ready: Stage,
) -> None:
    assert ready.raw is not None
    ease = Ease(0.0100, 0.0099)
    assert ease.step(ready.raw, 2.0) is None
    waited = 0.0
    while ease.step(ready.raw, PERIOD) is None:
        waited += PERIOD
    assert 0.5 * STOP_TIME < waited <= STOP_TIME
