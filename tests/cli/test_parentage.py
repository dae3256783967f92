"""How a child of a model is gone by."""

from dataclasses import replace
from pathlib import Path

import pytest

from gripperd.cli.parentage import parent_of
from gripperd.config import ModelFile, load_model, shipped
from gripperd.store import Version
from tests.daemon import settings_file

CHILD = "/kept/1.yaml"


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


def test_a_muscle_without_a_gripper_is_nothing_to_go_by(tmp_path: Path) -> None:
    parent = parent_of(whole("mine"), settings_file(tmp_path))
    bare = replace(whole("mine-1"), linkage=None)
    assert parent.way_to(Version(1, bare)) == (
        "no gripper can go by it: it has no gripper"
    )
