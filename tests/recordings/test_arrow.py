"""What Arrow reads from."""

import sys

from gripperd.recordings.arrow import stream

CONTENT = b"t_s,force_N\n" * 1000


def test_arrow_reads_the_content() -> None:
    assert stream(CONTENT).read() == CONTENT


def test_arrow_holds_nothing_of_the_interpreter() -> None:
    content = CONTENT + b"0,1\n"
    before = sys.getrefcount(content)
    given = stream(content)
    assert sys.getrefcount(content) == before
    assert given.size() == len(content)
