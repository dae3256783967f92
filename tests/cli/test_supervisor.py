from itertools import islice

from gripperd.cli.supervisor import pauses


def test_what_does_not_start_is_tried_ever_more_seldom() -> None:
    assert list(islice(pauses(), 7)) == [1, 2, 4, 8, 10, 10, 10]
