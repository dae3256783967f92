"""Strict JSON."""

import json
from json import JSONDecodeError

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.service.body import parsed

from .conftest import Daemon

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inside: st.lists(inside) | st.dictionaries(st.text(), inside),
    max_leaves=10,
)


@given(JSON)
def test_what_json_writes_is_read(value: object) -> None:
    assert parsed(json.dumps(value).encode()) == value


@pytest.mark.parametrize(
    ("body", "place", "says"),
    [
        (b'{"a": 1, "b": {"a": 2, "a": 3}}', 23, '"a" stands twice'),
        (b'{"a": "\xff"}', 7, "not UTF-8"),
        (b"[" * 100_000, 0, "nested too deeply"),
        (b"9" * 5000, 0, "too many digits"),
        (b"{", 1, "Expecting"),
    ],
)
def test_what_is_wrong_is_placed(body: bytes, place: int, says: str) -> None:
    with pytest.raises(JSONDecodeError, match=says) as refused:
        parsed(body)
    assert refused.value.pos == place


def test_a_key_may_stand_in_two_objects() -> None:
    assert parsed(b'[{"a": 1}, {"a": 2}]') == [{"a": 1}, {"a": 2}]


def test_every_answer_in_json_is_a_line(daemon: Daemon) -> None:
    for path in ("/v1/grippers", "/v1/grippers/g0", "/v1/info", "/v1/nothing"):
        answer = daemon.http.get(path)
        assert answer.text.endswith("}\n")
        assert int(answer.headers["content-length"]) == len(answer.content)
