"""What is told of a diagnosis that is kept as a version."""

from pathlib import Path

import pytest

from gripperd.cli.acceptance import accept
from gripperd.config import ModelFile, load_model
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis
from tests.daemon import settings_file
from tests.demonstration import example


@pytest.fixture
def config(tmp_path: Path) -> Path:
    return settings_file(tmp_path)


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """Where the first version of the model as drawn goes."""
    return tmp_path / "state/models/as-drawn/1.yaml"


@pytest.fixture(scope="module")
def creep() -> tuple[ModelFile, Diagnosis]:
    return example(Hidden.CREEP)


def test_what_was_named_is_told_apart_from_constants_that_moved_with_it(
    creep: tuple[ModelFile, Diagnosis], config: Path, kept: Path
) -> None:
    model, found = creep
    first, gap, moved, way = accept(found, model, config)
    assert first == f"kept as as-drawn-1: {kept}"
    version = load_model(kept)
    assert version.lineage is not None
    assert version.regulator is not None
    made = version.lineage.provenance
    assert [one.name for one in made.effects] == ["creep"]
    assert [one.name for one in made.refitted] == ["parameter:valve.pressure_high_kPa"]
    pressure = version.regulator.pressure_high / 1e3
    said = f"valve.pressure_high_kPa to {pressure:.4g}"
    assert made.gap is not None
    after, before, floor = (
        f"{size:.3g} N"
        for size in (made.gap.rmse_after, made.gap.rmse_before, made.gap.noise_floor)
    )
    assert gap == (
        "by itself, without zeros and delays of this rig, its force_N is off by"
        f" {after} on held-out runs instead of {before}, and repeats by {floor}"
    )
    assert moved == f"with it these constants moved: {said}"
    assert way == "no gripper can go by it: it has no gripper"


def test_what_was_kept_is_not_kept_again(
    creep: tuple[ModelFile, Diagnosis], config: Path, kept: Path
) -> None:
    model, found = creep
    said = accept(found, model, config)
    again = accept(found, model, config)
    assert again == [f"already {said[0]}", *said[1:]]
    there = sorted(one.name for one in kept.parent.glob("[!.]*.yaml"))
    assert there == ["0.yaml", "1.yaml", "active.yaml"]
