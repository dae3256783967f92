from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from gripperd.config import (
    Complaint,
    load_profile,
    load_profiles,
    parse_profile,
    profile_document,
    reference_chain,
    shipped,
)
from gripperd.control.profile import Mode, Profile
from gripperd.errors import ConfigError

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]

PLUM = """\
name: plum
version: 3
diameter_mm: 45
size_tolerance_mm: {smaller: 4, larger: 5}
mass_g: 66
stiffness_N_per_mm: 8
pad_friction: 0.5
acceleration_m_per_s2: 5
limits: {damage_N: 40, source: guessed}
margins: {slip: 1.5, crush: 1.3}
grasp:
  mode: force
  current_mA: 10.7
  force_N: 12
  approach_mA_per_s: 8
  ramp_mA_per_s: 2
"""


def test_a_profile_file_becomes_a_profile_in_si(write: Write) -> None:
    assert load_profile(write("plum.yaml", PLUM)) == Profile(
        name="plum",
        version=3,
        diameter=0.045,
        smaller=0.004,
        larger=0.005,
        mass=0.066,
        stiffness=8000.0,
        pad_friction=0.5,
        acceleration=5.0,
        damage_force=40.0,
        source="guessed",
        slip_margin=1.5,
        crush_margin=1.3,
        mode=Mode.FORCE,
        current=0.0107,
        force=12.0,
        approach=0.008,
        ramp=0.002,
    )


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("mm: 45", "mm: -45", "diameter_mm: -45 mm is not above 0 mm"),
        ("mm: 45", "mm: 4500", "diameter_mm: 4500 mm is above 1000 mm"),
        ("mm: 45", "mm: 45 mm", 'diameter_mm: "45 mm" is not a number (mm); write 45'),
        ("mm: 45", "mm: yes", 'diameter_mm: "yes" is not a number (mm)'),
        ("mm: 45", "mm: true", "diameter_mm: true is not a number (mm)"),
        ("mm: 45", "mm:", "diameter_mm: an empty value is not a number (mm)"),
        ("mm: 45", "mm: [45]", "diameter_mm: a list of 1 is not a number (mm)"),
        ("mm: 45", "mm: .nan", "diameter_mm: .nan is not a finite number"),
        ("10.7", "10,7", 'grasp.current_mA: "10,7" is not a number (mA); write 10.7'),
        ("10.7", "'10.7'", 'grasp.current_mA: "10.7" is not a number (mA); write 10.7'),
        # A comma before three digits may be thousands: nothing is proposed.
        ("10.7", "1,070", 'grasp.current_mA: "1,070" is not a number (mA)'),
        ("10.7", "1_0", 'grasp.current_mA: "1_0" is not a number (mA); write 10'),
        ("10.7", "25", "grasp.current_mA: 25 mA is above 24 mA"),
        ("s: 2", "s: 0", "grasp.ramp_mA_per_s: 0 mA/s is not above 0 mA/s"),
        ("version: 3", "version: 3.0", "version: 3 is not a whole number"),
        ("version: 3", "version: 0", "version: 0 is below 1"),
        ("guessed", "''", "limits.source: is empty"),
        ("guessed", "12", "limits.source: 12 is not text; put it in quotes"),
        (
            "crush: 1.3",
            "crush: 1.19",
            "margins.crush: 1.19 is below 1.2; a grasp is broken off at 1.15 and"
            " could not get there",
        ),
        (
            "mode: force",
            "mode: forse",
            'grasp.mode: "forse" is unknown; did you mean "force"?',
        ),
        (
            "mode: force",
            "mode: 3",
            "grasp.mode: 3 is unknown; there are: current, force",
        ),
        ("mass_g", "mass_kg", 'mass_kg: is not a key here; did you mean "mass_g"?'),
        (
            "{slip: 1.5, crush: 1.3}",
            "1.5",
            "margins: 1.5 is not a mapping of keys to values",
        ),
        (
            "{slip: 1.5, crush: 1.3}",
            "{slip_margin: 1.5, crush: 1.3}",
            "margins.slip_margin: is not a key here; there are: crush, slip",
        ),
        (
            "smaller: 4",
            "smaller: 45",
            "size_tolerance_mm: 45 mm smaller leaves nothing of 45 mm to hold",
        ),
        (
            "smaller: 4,",
            "smaller: -1,",
            "size_tolerance_mm.smaller: -1 mm is below 0 mm",
        ),
    ],
)
def test_a_bad_value_is_refused_with_line_value_unit_and_limit(
    write: Write, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    assert PLUM.count(good) == 1
    line = PLUM[: PLUM.index(good)].count("\n") + 1
    said = refusal(load_profile, write("plum.yaml", PLUM.replace(good, bad)))
    assert f"plum.yaml:{line}: {complaint}" in said
    assert len(said) == 1 or "is not a key here" in complaint


def test_everything_wrong_is_said_at_once_in_the_order_of_the_lines(
    write: Write, refusal: Refusal
) -> None:
    text = (
        PLUM.replace("version: 3", "version: 3\nversion: 4")
        .replace("mass_g: 66", "mass_g: *x")
        .replace("pad_friction: 0.5", "pad_friction: slippery")
        .replace("  force_N: 12\n", "")
    )
    assert refusal(load_profile, write("plum.yaml", text)) == [
        "plum.yaml:3: version: stands twice, first on line 2",
        'plum.yaml:6: mass_g: alias "*x" is refused',
        'plum.yaml:8: pad_friction: "slippery" is not a number',
        "plum.yaml:12: grasp.force_N: is missing (N)",
    ]


@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        (
            "version: 3",
            "version: 3\nversion: 3",
            "3: version: stands twice, first on line 2",
        ),
        ("mass_g: 66", "mass_g: &mass 66", '5: mass_g: anchor "&mass" is refused'),
        ("mass_g: 66", "mass_g: !!int 66", '5: mass_g: tag "!!int" is refused'),
    ],
)
def test_a_trick_is_refused_though_the_value_would_do(
    write: Write, refusal: Refusal, good: str, bad: str, complaint: str
) -> None:
    path = write("plum.yaml", PLUM.replace(good, bad))
    assert refusal(load_profile, path) == [f"plum.yaml:{complaint}"]


def test_an_empty_profile_misses_everything(write: Write, refusal: Refusal) -> None:
    assert refusal(load_profile, write("plum.yaml", "")) == [
        "plum.yaml:1: an empty value is not a mapping of keys to values"
    ]


def test_a_folder_gives_each_profile_under_its_name(tmp_path: Path) -> None:
    for name in ("plum", "pear"):
        text = PLUM.replace("name: plum", f"name: {name}")
        (tmp_path / f"{name}.yaml").write_text(text)
    (tmp_path / "notes.txt").write_text("not a profile")
    (tmp_path / ".plum.yaml").write_text("an editor's leftover")
    profiles = load_profiles(tmp_path)
    assert sorted(profiles) == ["pear", "plum"]
    assert profiles["pear"] == replace(profiles["plum"], name="pear")


def test_a_folder_tells_what_is_wrong_with_all_its_files(
    write: Write, refusal: Refusal, tmp_path: Path
) -> None:
    write("pear.yaml", PLUM)
    write("plum.yml", PLUM)
    write("quince.yaml", "name: [")
    assert refusal(load_profiles, tmp_path) == [
        'pear.yaml:1: name: the profile "plum" belongs in a file plum.yaml',
        'plum.yml:1: name: the profile "plum" belongs in a file plum.yaml',
        "quince.yaml:1: not YAML: expected the node content, but found '<stream end>'",
    ]


def test_a_missing_folder_is_named(tmp_path: Path, refusal: Refusal) -> None:
    said = refusal(load_profiles, tmp_path / "nowhere")
    assert said == ["nowhere: there is no such folder"]


def test_a_request_is_refused_with_pointers() -> None:
    mapping = yaml.safe_load(PLUM)
    mapping["grasp"]["current_mA"] = "10,7"
    mapping["grasp"]["a/b"] = 1
    del mapping["limits"]["source"]
    mapping["mass_g"] = float("inf")
    mapping["stiffness_N_per_mm"] = 10**400
    with pytest.raises(ConfigError) as refused:
        parse_profile(mapping)
    complaints = [c for c in refused.value.complaints if isinstance(c, Complaint)]
    assert {c.pointer: c.detail for c in complaints} == {
        "/mass_g": "inf is not a finite number (g)",
        "/stiffness_N_per_mm": "a number of over 15 digits is not a finite number"
        " (N/mm)",
        "/limits/source": "is missing",
        "/grasp/current_mA": '"10,7" is not a number (mA); write 10.7',
        "/grasp/a~1b": "is not a key here; there are: approach_mA_per_s, current_mA,"
        " force_N, mode, ramp_mA_per_s",
    }


@pytest.mark.parametrize("junk", [None, 3, "plum", [], [1, 2], object(), {1: 2}])
def test_a_request_of_any_shape_is_refused_with_complaints(junk: object) -> None:
    with pytest.raises(ConfigError):
        parse_profile(junk)


def test_a_written_profile_has_the_shape_of_the_file(write: Write) -> None:
    profile = load_profile(write("plum.yaml", PLUM))
    written = profile_document(profile)
    assert written == yaml.safe_load(PLUM)
    # It holds nothing that only this program could read.
    assert yaml.safe_load(yaml.safe_dump(written)) == written


def decimal(low: int, high: int) -> st.SearchStrategy[float]:
    """Numbers as a person writes them: up to three digits after the point."""
    return st.integers(low, high).map(lambda thousandths: thousandths / 1000)


@st.composite
def documents(draw: Callable[[st.SearchStrategy[object]], object]) -> object:
    size = draw(decimal(1000, 900_000))
    assert isinstance(size, float)
    return {
        "name": draw(st.from_regex(r"[a-z][a-z0-9_.-]{0,20}", fullmatch=True)),
        "version": draw(st.integers(1, 1000)),
        "diameter_mm": size,
        "size_tolerance_mm": {
            "smaller": draw(decimal(0, int(size * 999))),
            "larger": draw(decimal(0, 50_000)),
        },
        "mass_g": draw(decimal(1, 5_000_000)),
        "stiffness_N_per_mm": draw(decimal(1, 1_000_000)),
        "pad_friction": draw(decimal(1, 2000)),
        "acceleration_m_per_s2": draw(decimal(0, 50_000)),
        "limits": {"damage_N": draw(decimal(1, 500_000)), "source": "a guess"},
        "margins": {
            "slip": draw(decimal(1000, 5000)),
            "crush": draw(decimal(1200, 5000)),
        },
        "grasp": {
            "mode": draw(st.sampled_from(["force", "current"])),
            "current_mA": draw(decimal(4000, 20_000)),
            "force_N": draw(decimal(1, 200_000)),
            "approach_mA_per_s": draw(decimal(1, 100_000)),
            "ramp_mA_per_s": draw(decimal(1, 100_000)),
        },
    }


@given(documents())
def test_a_profile_survives_the_way_to_si_and_back_to_the_last_digit(
    document: object,
) -> None:
    profile = parse_profile(document)
    assert profile_document(profile) == document
    assert parse_profile(profile_document(profile)) == profile


SHIPPED = sorted(shipped("profiles").iterdir())


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_profile_is_held_safely_by_the_reference_rig(path: Path) -> None:
    profile, chain = load_profile(path), reference_chain()
    assert profile.current == 0.0107
    assert (profile.slip_margin, profile.crush_margin) == (1.5, 1.3)
    current = chain.current_for(profile.force, profile.pressed)
    for held_at in (profile.current, current):
        force = chain.predict(held_at, profile.pressed).grip_force
        # Two pads carry m (g + a) by friction, in plain numbers of the file.
        weight = profile.mass * (9.80665 + 5.0)
        assert 2 * profile.pad_friction * force >= 1.5 * weight
        assert profile.damage_force >= 1.3 * force
    assert chain.predict(current, profile.pressed).grip_force == pytest.approx(
        profile.force
    )
