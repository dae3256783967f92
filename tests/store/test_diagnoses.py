"""Diagnoses in files, and what may become a version."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.config import (
    ModelFile,
    Provenance,
    Settings,
    load_settings,
    model_text,
    shipped,
)
from gripperd.effects.creep import Creep
from gripperd.errors import NotFound, Refused
from gripperd.model import StaticMuscle
from gripperd.store import versions_of
from gripperd.store.acceptance import accept
from gripperd.store.diagnoses import (
    MODEL,
    Diagnoses,
    Status,
    StoredDiagnosis,
    Why,
    write_improvement,
)

NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)
LATER = datetime(2026, 1, 31, 13, tzinfo=UTC)


def asked(digit: str, status: Status = Status.QUEUED) -> StoredDiagnosis:
    return StoredDiagnosis(
        id=digit * 32,
        recording="f" * 64,
        gripper="g0",
        model="reference",
        version=0,
        seed=3,
        created_at=NOON.replace(minute=int(digit)),
        status=status,
    )


@pytest.fixture
def kept(tmp_path: Path) -> Diagnoses:
    return Diagnoses(tmp_path / "diagnoses")


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return replace(load_settings(shipped("gripperd.yaml"), {}), state_dir=tmp_path)


def test_what_was_interrupted_is_called_failed_and_the_rest_stays(
    kept: Diagnoses,
) -> None:
    done = [
        asked(str(digit), status)
        for digit, status in enumerate(
            (Status.SUCCEEDED, Status.FAILED, Status.CANCELLED)
        )
    ]
    for one in (*done, asked("3"), asked("4", Status.RUNNING)):
        kept.put(one)
    kept.give_up_interrupted(LATER)
    *interrupted, third, second, first = kept.all()
    assert [first, second, third] == done
    for one in interrupted:
        assert (one.status, one.completed_at) == (Status.FAILED, LATER)
        assert one.error is not None
        assert one.error.code == "interrupted"


def better(settings: Settings) -> ModelFile:
    base = settings.grippers["g0"].model
    effects = (*base.static.effects, Creep(slow=0.03))
    return replace(base, static=StaticMuscle(base.static.muscle, effects))


@pytest.fixture
def found(
    kept: Diagnoses, settings: Settings, provenance: Provenance
) -> StoredDiagnosis:
    """A diagnosis that has named creep."""
    return named("7", kept, settings, provenance)


def named(
    digit: str, kept: Diagnoses, settings: Settings, provenance: Provenance
) -> StoredDiagnosis:
    one = asked(digit, Status.SUCCEEDED)
    kept.put(one)
    place = kept.place(one.id)
    (place / MODEL).write_text(model_text(settings.grippers["g0"].model))
    write_improvement(better(settings), provenance, place)
    return one


def test_what_was_named_becomes_a_version_and_is_not_active(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis, provenance: Provenance
) -> None:
    version = accept(found, kept, settings, LATER)
    assert version.name == "reference-1"
    assert version.model.static.effects == better(settings).static.effects
    lineage = version.model.lineage
    assert lineage is not None
    assert (lineage.parent, lineage.created_at) == (0, LATER)
    assert lineage.provenance == provenance
    assert versions_of(settings, settings.grippers["g0"]).active == 0
    assert kept.get(found.id).kept_as == "reference-1"


def refused(found: StoredDiagnosis, kept: Diagnoses, settings: Settings) -> Refused:
    versions = versions_of(settings, settings.grippers["g0"])
    before = len(versions.all().versions)
    with pytest.raises(Refused) as refusal:
        accept(found, kept, settings, LATER)
    assert len(versions.all().versions) == before
    return refusal.value


def test_it_is_accepted_once(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis
) -> None:
    accept(found, kept, settings, LATER)
    refusal = refused(kept.get(found.id), kept, settings)
    assert (refusal.code, str(refusal)) == (
        "already-accepted",
        "it was kept already, as reference-1",
    )


def test_two_diagnoses_that_say_the_same_of_one_recording_are_one_version(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis, provenance: Provenance
) -> None:
    again = named("8", kept, settings, provenance)
    names = [accept(one, kept, settings, LATER).name for one in (found, again)]
    assert names == ["reference-1", "reference-1"]
    assert kept.get(again.id).kept_as == "reference-1"


def test_without_a_name_there_is_nothing_to_accept(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis
) -> None:
    nothing = replace(found, objection=Why(code="not-named", message="no name"))
    refusal = refused(nothing, kept, settings)
    assert (refusal.code, str(refusal)) == ("not-named", "no name")


def test_a_model_that_was_changed_since_is_not_improved(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis
) -> None:
    gripper = settings.grippers["g0"]
    linkage = gripper.model.linkage
    assert linkage is not None
    edited = replace(gripper.model, linkage=replace(linkage, ratio=4.1))
    others = replace(settings, grippers={"g0": replace(gripper, model=edited)})
    refusal = refused(found, kept, others)
    assert refusal.code == "model-changed"
    assert refusal.hints == ("diagnose the recording again",)


def test_a_gripper_that_is_gone_has_no_versions(
    kept: Diagnoses, settings: Settings, found: StoredDiagnosis
) -> None:
    with pytest.raises(NotFound, match="no gripper 'g0' any more"):
        accept(found, kept, replace(settings, grippers={}), LATER)
