"""How a child of a model is gone by."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.cli.parentage import Parent, parent_of
from gripperd.config import ModelFile, load_model, shipped
from gripperd.config.lineage import Provenance, Recorded
from gripperd.errors import Refused
from gripperd.store import Version
from tests.daemon import settings_file

CHILD = "/kept/1.yaml"
NOW = datetime(2026, 1, 31, 12, 0, tzinfo=UTC)


@pytest.fixture
def provenance() -> Provenance:
    recorded = Recorded(name="steps.csv", sha256="0" * 64)
    return Provenance(
        program="0.1.0", recording=recorded, seed=7, effects=(), heldout_runs=()
    )


def whole(name: str) -> ModelFile:
    return replace(
        load_model(shipped("models/reference.yaml")), name=name, source=CHILD
    )


def test_a_child_of_a_configured_model_can_be_activated(tmp_path: Path) -> None:
    config = settings_file(tmp_path)
    parent = parent_of(whole("reference"), config)
    assert parent.way_to(Version(1, whole("reference-1"))) == (
        "to go by it: gripperd model activate 1"
    )


def test_a_child_of_another_is_written_down_by_its_key(tmp_path: Path) -> None:
    config = settings_file(tmp_path)
    parent = parent_of(whole("mine"), config)
    assert parent.way_to(Version(1, whole("mine-1"))) == (
        f"to go by it: set grippers.g0.model to {CHILD} in {config}"
    )


def test_nobody_is_sent_to_a_file_that_is_shipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("GRIPPERD_CONFIG", raising=False)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    parent = parent_of(whole("mine"), None)
    assert parent.way_to(Version(1, whole("mine-1"))) == (
        f"to go by it: set grippers.g0.model to {CHILD} in a configuration of your own"
    )


def child(parent: Parent, provenance: Provenance) -> Version:
    model = replace(parent.versions.get(parent.number).model, lineage=None)
    return parent.versions.add(
        model, parent=parent.number, created_at=NOW, provenance=provenance
    )


def test_a_child_of_a_child_is_of_the_same_family(
    tmp_path: Path, provenance: Provenance
) -> None:
    config = settings_file(tmp_path)
    first = child(parent_of(whole("mine"), config), provenance)
    parent = parent_of(load_model(Path(first.model.source)), config)
    second = child(parent, provenance)
    assert (second.name, parent.number) == ("mine-2", 1)
    assert second.model.lineage is not None
    assert second.model.lineage.parent == 1


def test_another_model_of_that_name_is_no_parent(
    tmp_path: Path, provenance: Provenance
) -> None:
    config = settings_file(tmp_path)
    mine = whole("mine")
    kept = child(parent_of(mine, config), provenance)
    assert child(parent_of(mine, config), provenance).number == 2
    muscle = replace(mine.static.muscle, diameter=0.019)
    other = replace(mine, static=replace(mine.static, muscle=muscle))
    with pytest.raises(Refused) as refused:
        parent_of(other, config)
    base = Path(kept.model.source).with_name("0.yaml")
    assert str(refused.value) == (
        f"{CHILD}: another model is version 0 of mine ({base}); nothing was kept"
    )


def test_a_muscle_without_a_gripper_is_nothing_to_go_by(tmp_path: Path) -> None:
    parent = parent_of(whole("mine"), settings_file(tmp_path))
    bare = replace(whole("mine-1"), linkage=None)
    assert parent.way_to(Version(1, bare)) == (
        "no gripper can go by it: it has no gripper"
    )
