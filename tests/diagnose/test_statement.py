from dataclasses import replace

import pytest

from gripperd.demo.rig import Hidden
from gripperd.diagnose.conclude import Verdict
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.recording import Contradiction
from gripperd.diagnose.statement import offered, reasons, span, statement, summary
from gripperd.diagnose.where import Finding
from gripperd.effects.creep import Creep
from gripperd.model.effect import Signal
from tests.demonstration import example
from tests.diagnose.offered import bump


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


def test_a_statement_says_how_it_shows_and_what_to_do(creep: Diagnosis) -> None:
    entry = replace(creep.named[0], size=12.04)
    assert statement(creep, entry) == (
        "Creep is at work, worth 12 N of force (rms):"
        f" {Creep.shows}; so {Creep.remedy}."
    )


def test_what_is_not_established_is_not_claimed(creep: Diagnosis) -> None:
    unexplained = replace(creep, verdict=Verdict.UNEXPLAINED)
    said = statement(unexplained, creep.named[0])
    assert said.startswith("Creep comes nearest, worth ")
    assert "at work" not in said


def test_the_verdict_has_the_gap_before_and_after(creep: Diagnosis) -> None:
    gap = replace(creep.gaps[Signal.FORCE], before=29.65, after=2.617, noise_floor=3.04)
    said = summary(replace(creep, gaps={Signal.FORCE: gap}))
    assert said == (
        "The model lacks creep; on data it never saw the force is off by 2.62 N"
        " instead of 29.6 N, and repeats by 3.04 N."
    )


def test_a_contradiction_says_what_contradicts_what(creep: Diagnosis) -> None:
    names = tuple("abcdef")
    found = Contradiction(names, ("x",), "force_N", -310.4, "N", 3.21)
    recording = replace(creep.recording, contradictions=(found,))
    said = summary(
        replace(creep, verdict=Verdict.UNUSABLE, named=(), recording=recording)
    )
    assert said == (
        "The recording contradicts itself, no verdict can rest on it: force_N of a, b,"
        " c, d and 2 more differs from that of x by 310 N at the same place, and"
        " repeats by 3.2 N."
    )


def test_a_correction_is_called_no_physics() -> None:
    assert offered(bump()) == (
        "A smooth correction of the force by pressure leaves 5 N of 20 N on data it"
        " never saw, of which 75% lie inside its fence; it is no physics, and no part"
        " of the model"
    )


def test_effects_not_tested_are_listed_by_the_reason(creep: Diagnosis) -> None:
    told = replace(
        creep,
        untested={"leak": "too short", "parameter:valve.pressure_low": "too short"},
    )
    assert reasons(told) == {"too short": ["leak", "parameter:valve.pressure_low_kPa"]}


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("time", "820 to 880"),
        ("pressure", "0 to 434"),
        ("contraction", "0.105"),
        ("temperature", "-"),
    ],
)
def test_a_region_is_told_in_the_units_of_the_file(name: str, said: str) -> None:
    region = {
        "time": (819.8, 880.3),
        "pressure": (-120.0, 433.6e3),
        "contraction": (0.1051, 0.1052),
    }
    finding = Finding("muscle", Signal.FORCE, "step_0", region, 9.3, 1.6, 1e-10)
    assert span(finding, name) == said
