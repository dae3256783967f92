from collections.abc import Mapping

import pytest

from gripperd.control.command import GraspOrder, Status
from gripperd.control.ledger import LONGEST_QUEUE, Key
from gripperd.control.profile import Mode, Profile
from gripperd.errors import InputError, Refused

from .stage import Stage, ordered

Profiles = Mapping[str, Profile]


def test_the_queue_is_bounded(ready: Stage, apple: GraspOrder) -> None:
    ready.submit(apple)
    ready.tick()
    for _ in range(LONGEST_QUEUE):
        ready.submit(None)
    with pytest.raises(Refused, match="8 commands are waiting") as refused:
        ready.submit(None)
    assert refused.value.code == "queue-full"
    assert len(ready.gripper.ledger.newest(100)) == LONGEST_QUEUE + 1


def test_the_same_key_is_the_same_command(ready: Stage, apple: GraspOrder) -> None:
    key = Key("k", "grasp apple")
    first, replayed = ready.gripper.submit(apple, 30.0, key, ready.instant)
    assert not replayed
    again, replayed = ready.gripper.submit(apple, 30.0, key, ready.instant)
    assert replayed
    assert again.id == first.id
    ready.until(lambda: ready.command(first).final)
    over, replayed = ready.gripper.submit(apple, 30.0, key, ready.instant)
    assert replayed
    assert over.status is Status.FAILED
    assert len(ready.gripper.ledger.newest(100)) == 1


def test_a_replay_is_answered_in_any_state(ready: Stage, apple: GraspOrder) -> None:
    key = Key("k", "grasp apple")
    first = ready.submit(apple, key=key)
    ready.gripper.link_lost("gone", ready.instant)
    assert ready.submit(apple, key=key).id == first.id


def test_a_key_for_another_request_is_an_error(ready: Stage, apple: GraspOrder) -> None:
    ready.submit(apple, key=Key("k", "grasp apple"))
    with pytest.raises(InputError, match="k was given with another") as wrong:
        ready.submit(None, key=Key("k", "release"))
    assert wrong.value.key == "Idempotency-Key"


def test_a_refused_command_leaves_its_key_free(
    ready: Stage, profiles: Profiles, apple: GraspOrder
) -> None:
    with pytest.raises(Refused):
        ready.submit(ordered(profiles["apple"], Mode.FORCE, 1.0), key=Key("k", "1 N"))
    assert ready.submit(apple, key=Key("k", "25 N")).status is Status.QUEUED
