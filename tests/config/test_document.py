import math
import os
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gripperd.config import load_profile
from gripperd.config.document import read_document
from gripperd.errors import ConfigError

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("false", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("10", 10),
        ("-3", -3),
        ("+3", 3),
        ("10.7", 10.7),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("-2.5E-3", -0.0025),
        # All of these mean something else to a YAML 1.1 reader.
        ("no", "no"),
        ("on", "on"),
        ("True", "True"),
        ("1:30", "1:30"),
        ("1_000", "1_000"),
        ("0o7", "0o7"),
        ("010", "010"),
        ("0x10", "0x10"),
        ("2026-01-01", "2026-01-01"),
        ("'10'", "10"),
        ('"true"', "true"),
        ("٣", "٣"),
    ],
)
def test_only_plain_decimals_and_three_words_are_more_than_text(
    write: Write, text: str, value: object
) -> None:
    document = read_document(write("a.yaml", f"key: {text}\n"))
    assert document.complaints == ()
    assert document.value == {"key": value}
    assert isinstance(document.value, dict)
    assert type(document.value["key"]) is type(value)


def test_every_key_and_item_knows_its_line(write: Write) -> None:
    text = "# comment\na:\n  b: 1\n  c: [10,\n    20]\n\nd: 2\n"
    document = read_document(write("a.yaml", text))
    assert document.lines == {
        (): 1,
        ("a",): 2,
        ("a", "b"): 3,
        ("a", "c"): 4,
        ("a", "c", 0): 4,
        ("a", "c", 1): 5,
        ("d",): 7,
    }


def test_a_key_that_stands_three_times_is_counted_from_the_first(write: Write) -> None:
    document = read_document(write("x.yaml", "a: 1\na: 2\na: 3\n"))
    assert [said.detail for said in document.complaints] == [
        "stands twice, first on line 1",
        "stands twice, first on line 1",
    ]
    assert [said.line for said in document.complaints] == [2, 3]


def test_an_empty_file_holds_nothing(write: Write) -> None:
    assert read_document(write("a.yaml", "# only a comment\n")).value is None


def test_a_byte_order_mark_is_no_part_of_the_first_key(write: Write) -> None:
    assert read_document(write("a.yaml", "\ufeffa: 1\n")).value == {"a": 1}


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("a: 1\nb: 2\na: 3\n", "x.yaml:3: a: stands twice, first on line 1"),
        ("a: {b: 1, b: 2}\n", "x.yaml:1: a.b: stands twice, first on line 1"),
        ("a: 1\nb: *a\n", 'x.yaml:2: b: alias "*a" is refused'),
        ("a: 1\nb: &c 2\n", 'x.yaml:2: b: anchor "&c" is refused'),
        ("&c a: 1\n", 'x.yaml:1: anchor "&c" is refused'),
        ("a: [1, !!python/name:os.system x]\n", 'x.yaml:1: a[1]: tag "!!python'),
        ("a: !secret 1\n", 'x.yaml:1: a: tag "!secret" is refused'),
        ("a: .inf\n", "x.yaml:1: a: .inf is not a finite number"),
        ("a: -.Inf\n", "x.yaml:1: a: -.Inf is not a finite number"),
        ("a: .nan\n", "x.yaml:1: a: .nan is not a finite number"),
        ("a: 1e999\n", "x.yaml:1: a: 1e999 is not a finite number"),
        (f"a: {'9' * 5000}\n", "x.yaml:1: a: 999999"),
        ("a: 1\n---\na: 2\n", "x.yaml:2: a second document starts; a file holds one"),
        ("? [1, 2]\n: 3\n", "x.yaml:1: a key must be a word"),
    ],
)
def test_what_could_surprise_is_refused_at_its_line(
    write: Write, text: str, complaint: str
) -> None:
    (said,) = read_document(write("x.yaml", text)).complaints
    assert said[said.index("x.yaml") :].startswith(complaint)


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (b"a: 1\nb: [1, 2\nc: 3\n", "x.yaml:3: not YAML: expected ',' or ']'"),
        (b"a: 1\n\tb: 2\n", "x.yaml:2: not YAML: found character '\\t'"),
        (b"a: 1\nb: '\n", "x.yaml:3: not YAML: found unexpected end of stream"),
        (b'a: "\\UFFFFFFFF"\n', "x.yaml: not YAML: "),
        (b'a: "\\U00110000"\n', "x.yaml: not YAML: "),
        (b"a: 1\nb: \x07\n", "x.yaml:2: holds a control character"),
        (b"a: 1\nb: \xff\n", "x.yaml:2: is not UTF-8 text"),
        ("a: 1\n".encode("utf-16"), "x.yaml:1: is not UTF-8 text"),
        (b"#" * 1_000_001, "x.yaml: is larger than 1000000 bytes"),
        (b"a: " + b"[" * 100_000, "x.yaml:1: a: nested deeper than 20 levels"),
        (b"a:\n  " + b"- " * 50_000, "x.yaml:2: a: nested deeper than 20 levels"),
    ],
)
def test_a_file_that_cannot_be_read_says_where_it_breaks(
    tmp_path: Path, refusal: Refusal, content: bytes, complaint: str
) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(content)
    (said,) = refusal(read_document, path)
    assert said.startswith(complaint)


def test_a_file_of_exactly_one_megabyte_is_read(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(b"a: 1\n#" + b"x" * 999_994)
    assert read_document(path).value == {"a": 1}


def test_a_missing_file_is_named(tmp_path: Path, refusal: Refusal) -> None:
    missing = tmp_path / "nope.yaml"
    assert refusal(read_document, missing) == ["nope.yaml: there is no such file"]


def test_a_folder_and_a_pipe_are_not_read(tmp_path: Path, refusal: Refusal) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    assert refusal(read_document, tmp_path / "pipe") == ["pipe: is not a file"]
    assert refusal(read_document, tmp_path / "folder") == ["folder: is not a file"]


def test_a_path_that_is_too_long_is_a_complaint(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be read: File name too long"):
        read_document(tmp_path / ("x" * 300))


def test_an_alias_bomb_is_refused_without_being_blown_up(
    write: Write, refusal: Refusal
) -> None:
    levels = [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 40)]
    text = "\n".join(["a0: &a0 [x, x, x, x, x, x, x, x, x]", *levels])
    said = refusal(load_profile, write("bomb.yaml", text))
    assert 'bomb.yaml:1: a0: anchor "&a0" is refused' in said
    assert 'bomb.yaml:40: a39[8]: alias "*a38" is refused' in said


MARKS = st.sampled_from("[]{}'\"|>#@`~%?\n\x00\ud800\u2028")
WORDS = st.sampled_from(
    ["name", "diameter_mm", ": ", "- ", "  ", ", ", "&a", "*a", "!!int", "1e999"]
)
MORE_WORDS = st.sampled_from(["10,7", "---", "...", "? ", "\\U", "<<: ", "null"])
FRAGMENTS = MARKS | WORDS | MORE_WORDS | st.text(max_size=4)


@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(FRAGMENTS, max_size=25))
def test_any_text_is_refused_with_complaints_and_never_with_a_defect(
    tmp_path: Path, fragments: list[str]
) -> None:
    path = tmp_path / "any.yaml"
    path.write_bytes("".join(fragments).encode("utf-8", "surrogatepass"))
    with pytest.raises(ConfigError) as refused:
        load_profile(path)
    assert all(line.isprintable() for line in refused.value.complaints)
    assert all(line.startswith(str(path)) for line in refused.value.complaints)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_is_read_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory, number: float
) -> None:
    path = tmp_path_factory.getbasetemp() / "number.yaml"
    path.write_text(f"x: {number!r}\n")
    value = read_document(path).value
    assert isinstance(value, dict)
    read = value["x"]
    assert math.isclose(read, number, rel_tol=0, abs_tol=0)
    assert struct.pack("<d", read) == struct.pack("<d", number)
