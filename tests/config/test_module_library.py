import pickle
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from gripperd.config import shipped
from gripperd.config.module_library import ModuleLibrary, load_module
from gripperd.errors import ConfigError
from gripperd.protocol.modules import Evidence, OutputModule

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

OWN = """\
name: korenix
title: Korenix JetI/O 6520
kind: output
evidence: unverified
sources: [a public register map that says so itself]
channels: 4
power_on: not documented
ranges:
  0-20mA: {current_mA: [0, 20], counts: [0, 20000], code: 2}
modbus:
  values: {table: holding, address: 22, type: s16}
  range_code: {address: 9, stride: 0}
  status: {address: 0x0200, bits: {3: no current}}
vectors:
  - {current_mA: 10.7, registers: [10700]}
"""

DOCS = shipped().parent / "docs" / "modules.md"
SHIPPED = sorted(shipped("modules").glob("*.yaml"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_shipped_description_gives_10_7_ma_and_both_ends(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for current in ("10.7", "4", "20"):
        assert re.search(rf"current_mA: {re.escape(current)},", text)
    module = load_module(path)
    assert module.name == path.stem
    assert pickle.loads(pickle.dumps(module)) == module


@pytest.mark.skipif(not DOCS.is_file(), reason="the documentation is not installed")
def test_the_example_of_the_documentation_is_a_description(write: Write) -> None:
    blocks = DOCS.read_text(encoding="utf-8").split("```yaml\n")[1:]
    (example,) = (text for text in blocks if text.startswith("name: "))
    module = load_module(write("my_output.yaml", example.partition("```")[0]))
    assert module.range("0-20mA").current_low == 0.0


def test_a_description_is_read_as_it_is_written(write: Write) -> None:
    module = load_module(write("korenix.yaml", OWN))
    assert isinstance(module, OutputModule)
    assert module.evidence is Evidence.UNVERIFIED
    assert module.modbus is not None
    assert module.modbus.values.of(3) == 25
    assert module.modbus.range_code is not None
    assert module.modbus.range_code.of(3) == 9
    assert module.modbus.status is not None
    assert module.modbus.status.bits == {3: "no current"}
    assert module.doubts == ("korenix: nobody has verified this description",)


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("kind: output", "kind: outputs", 'kind: "outputs" is unknown; did you mean'),
        ("kind: output\n", "", "kind: is missing"),
        ("evidence: unverified", "evidence: sure", 'evidence: "sure" is unknown; '),
        (
            "name: korenix",
            "name: jetio",
            'name: the module "jetio" belongs in a file jetio.yaml',
        ),
        ("channels: 4", "channels: 0", "channels: 0 is below 1"),
        ("channels: 4", "chanels: 4", "channels: is missing"),
        ("address: 22", "address: 0x10000", 'modbus.values.address: "0x10000" is'),
        ("address: 22", "address: x16", 'modbus.values.address: "x16" is not a whole'),
        (
            "table: holding",
            "table: holdings",
            'modbus.values.table: "holdings" is not a table; did you mean "holding"?',
        ),
        ("type: s16", "type: i16", 'modbus.values.type: "i16" is unknown; did you'),
        (
            "type: s16",
            "type: s16, resolution: 6",
            "modbus.values.resolution: 6 is not a power of two",
        ),
        (
            "type: s16",
            "type: s16, word_ordr: low_first",
            'modbus.values.word_ordr: is not a key here; did you mean "word_order"?',
        ),
        (
            "[0, 20], c",
            "[20, 0], c",
            "ranges.0-20mA.current_mA: the low end, 20 mA, is not below",
        ),
        (
            "counts: [0, 20000], ",
            "",
            "ranges.0-20mA: counts are missing: integer registers do not count in mA",
        ),
        (", code: 2", "", "ranges.0-20mA: code is missing: there is a range_code to"),
        (
            "counts: [0, 20000]",
            "counts: [0, 40000]",
            "ranges.0-20mA: counts: 40000 does not fit s16",
        ),
        (
            "{3: no current}",
            "{19: no current}",
            "modbus.status: bit 19 is beyond the 16 bits that are read",
        ),
        (
            "bits: {3: no current}}",
            "bits: {3: no current}, fail_safe_bit: 18}",
            "modbus.status: bit 18 is beyond the 16 bits that are read",
        ),
        (
            "bits: {3: no current}",
            "bits: {3: no current}, signs: {open: 4}",
            "modbus.status.signs.open: 4 stands neither in bits nor in codes",
        ),
        (
            "type: s16}",
            "type: s16}\n  beyond_range: clampd",
            'modbus.beyond_range: "clampd" is unknown; did you mean "clamped"?',
        ),
        (
            "power_on: not documented",
            "power_on: x\npower_on_mA: 25",
            "power_on_mA: 25 mA",
        ),
        ("{3: no", "{32: no", 'modbus.status.bits.32: "32" is above 31'),
        (
            "registers: [10700]",
            "registers: [10701]",
            "vectors[0]: 10.7 mA is 0x29CC by the rest of the file, not 0x29CD",
        ),
        (
            "registers: [10700]",
            'text: "#010+10.700"',
            'vectors[0]: 10.7 mA is "" by the rest of the file, not "#010+10.700"',
        ),
        (
            "- {current_mA: 10.7",
            "- {range: 4-20mA, current_mA: 10.7",
            'vectors[0]: 4-20mA is not a range; did you mean "0-20mA"?',
        ),
        (
            ", registers: [10700]",
            "",
            "vectors[0]: has neither registers nor text",
        ),
        ("sources: [a public register map that says so itself]", "sources: []", "sour"),
    ],
)
def test_a_bad_description_is_refused_at_its_place(
    write: Write, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    assert OWN.count(good) == 1
    said = refusal(load_module, write("korenix.yaml", OWN.replace(good, bad)))
    places = (re.fullmatch(r"korenix\.yaml:\d+: (.*)", line) for line in said)
    assert any(place and place[1].startswith(complaint) for place in places), said


DCON = (
    OWN[: OWN.index("modbus:")].replace("code: 2", "")
    + """\
dcon:
  write: {ask: "#{unit}{channel}{value}", reply: ">"}
  read_back: {ask: "${unit}6{channel}", reply: "!{unit}{value}"}
vectors:
  - {current_mA: 10.7, text: "#010+10.700"}
"""
)


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ('"#{unit}{ch', '"{unit}{ch', "does not begin with one of # $ ~ % and {unit}"),
        ('reply: ">"', 'reply: "?"', 'begins neither with ">" nor with "!{unit}"'),
        ("6{channel}", "6{n}", "has a place that is not one of {channel}, {time}"),
        ("6{channel}", "6{channel", "has a place that is not one of"),
        ('010+10.700"', '020+10.700"', 'is "#010+10.700" by the rest of the file'),
        (
            'reply: ">"}',
            'reply: ">"}\n  range_code: {ask: "${unit}2", reply: "!{unit}{value}"}',
            "ranges.0-20mA: code is missing: there is a range_code to compare it with",
        ),
        ("dcon:", "dcn:", 'is not a key here; did you mean "dcon"?'),
    ],
)
def test_bad_lines_of_text_are_refused(
    write: Write, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    load_module(write("korenix.yaml", DCON))
    assert DCON.count(good) == 1
    said = refusal(load_module, write("korenix.yaml", DCON.replace(good, bad)))
    assert any(complaint in line for line in said), said


def test_a_time_out_must_fit_the_digits_of_its_line(
    write: Write, refusal: Refusal
) -> None:
    watchdog = """\
  watchdog:
    {step_s: 0.1, longest_s: 25.6, acts: x, arm: {ask: "~{unit}31{time}", reply: ">"}}
vectors:"""
    said = refusal(
        load_module, write("korenix.yaml", DCON.replace("vectors:", watchdog))
    )
    assert any("25.6 s does not fit 2 digits" in line for line in said), said


def test_a_description_must_speak_something(write: Write, refusal: Refusal) -> None:
    mute = DCON[: DCON.index("dcon:")] + DCON[DCON.index("vectors:") :]
    said = refusal(load_module, write("korenix.yaml", mute))
    assert "korenix.yaml:1: says nothing of modbus, dcon, adam_ascii or itv" in said[0]


def test_a_users_description_goes_before_the_shipped(write: Write) -> None:
    shipped_one = ModuleLibrary().output("waveshare_ao_8ch")
    path = write(
        "modules/waveshare_ao_8ch.yaml", OWN.replace("korenix", shipped_one.name)
    )
    own = ModuleLibrary(path.parent).output(shipped_one.name)
    assert own.title == "Korenix JetI/O 6520"
    assert ModuleLibrary(path.parent).output("adam_6224").channels == 4


@pytest.mark.parametrize("name", ["../modules/adam_6224", "adam_6224.y", "", 7])
def test_only_a_name_finds_a_module(name: object) -> None:
    with pytest.raises(ValueError, match="is not an output module"):
        ModuleLibrary().output(name)


def test_a_module_of_the_other_kind_is_not_found() -> None:
    with pytest.raises(ValueError, match='did you mean "moxa_e1241"'):
        ModuleLibrary().output("moxa_e1240")
    with pytest.raises(ValueError, match='did you mean "moxa_e1240"'):
        ModuleLibrary().input("moxa_e1241")


def test_everything_wrong_in_a_users_folder_is_said(write: Write) -> None:
    write("modules/one.yaml", OWN.replace("korenix", "one").replace(": 4", ": 0"))
    path = write("modules/two.yaml", OWN)
    with pytest.raises(ConfigError) as refused:
        ModuleLibrary(path.parent).check_own()
    assert len(refused.value.complaints) == 2
