import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.config import ModelFile, load_model, shipped
from gripperd.config.lineage import Provenance, Recorded
from gripperd.effects.creep import Creep
from gripperd.effects.valve_lag import ValveLag
from gripperd.errors import ConfigError, NotFound, Refused
from gripperd.store import Version, Versions

NOW = datetime(2026, 1, 31, 12, 0, tzinfo=UTC)


def with_creep(model: ModelFile, slow: float = 0.03) -> ModelFile:
    effects = (*model.static.effects, Creep(slow=slow))
    return replace(model, static=replace(model.static, effects=effects))


def add(
    versions: Versions, provenance: Provenance, slow: float = 0.03, parent: int = 0
) -> Version:
    model = with_creep(versions.get(0).model, slow)
    return versions.add(model, parent=parent, created_at=NOW, provenance=provenance)


def test_without_versions_the_configured_model_is_active(versions: Versions) -> None:
    assert versions.active == 0
    assert versions.get() == Version(0, load_model(shipped("models/reference.yaml")))


def test_a_version_is_kept_with_where_it_comes_from(
    versions: Versions, provenance: Provenance
) -> None:
    first = add(versions, provenance)
    second = add(versions, provenance, slow=0.04, parent=1)
    assert [first.number, second.number] == [1, 2]
    assert [first.name, second.name] == ["reference-1", "reference-2"]
    assert versions.get(1) == first
    assert Creep(slow=0.04) in versions.get("reference-2").model.static.effects
    lineage = versions.get("2").model.lineage
    assert lineage is not None
    assert (lineage.parent, lineage.created_at) == (1, NOW)
    assert lineage.provenance == provenance
    assert versions.active == 0


def test_the_same_of_the_same_recording_is_found_again(
    versions: Versions, provenance: Provenance
) -> None:
    kept = add(versions, provenance)
    add(versions, provenance)
    model = with_creep(versions.get(0).model)
    other = provenance.model_copy(
        update={"recording": Recorded(name="steps.csv", sha256="1" * 64)}
    )
    assert versions.same(model, parent=0, provenance=provenance) == kept
    assert versions.same(model, parent=1, provenance=provenance) is None
    assert versions.same(model, parent=0, provenance=other) is None
    stiffer = with_creep(versions.get(0).model, 0.031)
    assert versions.same(stiffer, parent=0, provenance=provenance) is None


def test_an_effect_outside_the_muscle_is_kept_too(
    versions: Versions, provenance: Provenance
) -> None:
    model = replace(versions.get(0).model, effects=(ValveLag(share=1.0, time=0.15),))
    versions.add(model, parent=0, created_at=NOW, provenance=provenance)
    assert versions.get(1).model.effects == (ValveLag(share=1.0, time=0.15),)


def test_rollback_walks_back_through_what_was_active(
    versions: Versions, provenance: Provenance
) -> None:
    for slow in (0.01, 0.02, 0.03):
        add(versions, provenance, slow=slow)
    for which in (1, "reference-3", 3, 2):
        versions.activate(which)
    assert versions.active == 2
    walked = [versions.rollback().number for _ in range(3)]
    assert walked == [3, 1, 0]
    with pytest.raises(Refused, match="version 0 was the first") as refused:
        versions.rollback()
    assert refused.value.code == "nothing-before"
    assert versions.active == 0


@pytest.mark.parametrize("which", [4, "reference-4", "-1", "", "../1", "1.yaml"])
def test_a_version_that_is_not_there_is_told(
    versions: Versions, provenance: Provenance, which: int | str
) -> None:
    add(versions, provenance)
    with pytest.raises(NotFound, match="reference has no version"):
        versions.get(which)
    with pytest.raises(NotFound):
        versions.activate(which)
    assert versions.active == 0


def test_a_version_of_another_model_is_told_with_its_file(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    base = replace(versions.get(0).model, name="other")
    other = add(Versions(tmp_path / "models/other", base), provenance)
    with pytest.raises(NotFound) as refused:
        versions.get("other-1")
    assert str(refused.value) == (
        f"reference has no version 'other-1'; it is one of other: {other.model.source}"
    )


def test_a_model_that_could_not_be_read_again_is_not_kept(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    with pytest.raises(Refused) as refused:
        add(versions, provenance, slow=0.6)
    assert str(refused.value) == (
        "nothing was kept, for nobody could read it again: effects[2].slow: 0.6 is"
        " outside -0.15 to 0.15, the physical bounds of creep"
    )
    assert [one.name for one in tmp_path.rglob("*.yaml")] == ["0.yaml"]
    assert Versions.kept(tmp_path / "models/reference") is None
    assert list(tmp_path.rglob("*.draft")) == []


def test_a_version_that_lost_or_changed_a_byte_is_refused_and_harms_no_other(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    for slow in (0.01, 0.02):
        add(versions, provenance, slow=slow)
    file = tmp_path / "models/reference/1.yaml"
    whole = file.read_bytes()
    for end in range(0, len(whole), 7):
        file.write_bytes(whole[:end])
        with pytest.raises(ConfigError, match="is not as it was written"):
            versions.get(1)
    file.write_bytes(
        whole.replace(b"diameter_mm: {value: 20.0", b"diameter_mm: {value: 21.0")
    )
    shelf = versions.all()
    assert [version.number for version in shelf.versions] == [0, 2]
    (said,) = shelf.complaints
    assert said.startswith(f"{file}: is not as it was written")
    with pytest.raises(ConfigError):
        versions.activate(1)


def test_a_damaged_version_can_be_rolled_back(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    add(versions, provenance)
    versions.activate(1)
    (tmp_path / "models/reference/1.yaml").write_text("name: reference-1\n")
    with pytest.raises(ConfigError):
        versions.get()
    assert versions.rollback().number == 0
    assert versions.get().number == 0


def test_a_version_that_is_gone_can_be_rolled_back(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    for number in (1, 2, 3):
        add(versions, provenance)
        versions.activate(number)
    for number in (2, 3):
        (tmp_path / f"models/reference/{number}.yaml").unlink()
    said = f"{tmp_path}/models/reference/3.yaml: is not there, and is the active"
    with pytest.raises(ConfigError, match=said):
        versions.get()
    assert versions.all().complaints == (f"{said} version",)
    assert versions.before().number == 1
    assert versions.rollback().number == 1
    assert versions.get().number == 1


def test_rollback_never_ends_where_it_began(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    for _ in range(2):
        add(versions, provenance)
    for number in (1, 2, 1):
        versions.activate(number)
    (tmp_path / "models/reference/2.yaml").unlink()
    assert versions.rollback().number == 0


def test_the_model_that_versions_were_made_from_is_kept_as_it_was(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    folder = tmp_path / "models/reference"
    add(versions, provenance)
    other = replace(versions.get(0).model, tolerances={})
    add(Versions(folder, other), provenance)
    kept = Versions.kept(folder)
    assert kept is not None
    assert kept.get(0).model == versions.get(0).model
    base = folder / "0.yaml"
    base.write_text(base.read_text().replace("250.0", "251.0"))
    with pytest.raises(ConfigError, match="is not as it was written"):
        Versions.kept(folder)


def test_the_number_of_a_version_that_is_gone_goes_to_no_other(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    folder = tmp_path / "models/reference"
    for number in (1, 2):
        add(versions, provenance)
        (folder / f"{number}.yaml").unlink()
    assert add(versions, provenance).number == 3
    versions.activate(3)
    versions.rollback()
    (folder / "3.yaml").unlink()
    assert add(versions, provenance).number == 4


def test_a_version_put_in_the_place_of_another_is_refused(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    add(versions, provenance)
    folder = tmp_path / "models/reference"
    (folder / "2.yaml").write_bytes((folder / "1.yaml").read_bytes())
    with pytest.raises(ConfigError, match='"reference-1" is not version 2'):
        versions.get(2)


@pytest.mark.parametrize("left", ["", "name: refer", "active: "])
def test_what_a_power_cut_left_of_a_draft_is_no_version(
    versions: Versions, provenance: Provenance, tmp_path: Path, left: str
) -> None:
    folder = tmp_path / "models/reference"
    folder.mkdir(parents=True)
    (folder / ".1.draft").write_text(left)
    (folder / ".active.draft").write_text(left)
    assert versions.all().versions == (versions.get(0),)
    assert add(versions, provenance).number == 1
    assert versions.activate(1).number == 1


def test_a_damaged_pointer_says_how_to_go_on(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    add(versions, provenance)
    pointer = tmp_path / "models/reference/active.yaml"
    pointer.write_text("active: one\n")
    with pytest.raises(ConfigError, match="remove the file for version 0"):
        versions.get()
    pointer.unlink()
    assert versions.active == 0


def test_a_bare_muscle_is_no_model_to_drive_by(
    versions: Versions, provenance: Provenance
) -> None:
    model = replace(versions.get(0).model, linkage=None, tolerances={})
    versions.add(model, parent=0, created_at=NOW, provenance=provenance)
    with pytest.raises(ConfigError, match="gripper: is missing"):
        versions.activate(1)
    assert versions.active == 0


def test_a_full_or_closed_disk_changes_nothing(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "models/reference").write_text("a file where the folder should be")
    with pytest.raises(Refused, match="nothing was kept"):
        add(versions, provenance)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs the full device")
@pytest.mark.parametrize("draft", [".1.draft", ".active.draft"])
def test_a_full_disk_is_told_as_such(
    versions: Versions, provenance: Provenance, tmp_path: Path, draft: str
) -> None:
    folder = tmp_path / "models/reference"
    folder.mkdir(parents=True)
    (folder / draft).symlink_to("/dev/full")
    with pytest.raises(Refused, match="nothing was kept: No space left") as refused:
        add(versions, provenance)
    assert refused.value.code == "storage-full"
    assert versions.all().versions == (versions.get(0),)


def _add_some(folder: Path, provenance: Provenance) -> list[int]:
    base = load_model(shipped("models/reference.yaml"))
    versions = Versions(folder, base)
    return [add(versions, provenance).number for _ in range(3)]


def test_where_the_number_is_not_noted_no_version_is_kept(
    versions: Versions, provenance: Provenance, tmp_path: Path
) -> None:
    (tmp_path / "models/reference/.active.draft").mkdir(parents=True)
    with pytest.raises(Refused, match="nothing was kept"):
        add(versions, provenance)
    assert [one.number for one in versions.all().versions] == [0]


def test_two_writers_at_once_lose_no_version(
    tmp_path: Path, provenance: Provenance
) -> None:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, context) as pool:
        adding = [pool.submit(_add_some, tmp_path, provenance) for _ in range(2)]
        numbers = sorted(number for each in adding for number in each.result())
    assert numbers == [1, 2, 3, 4, 5, 6]
    base = load_model(shipped("models/reference.yaml"))
    shelf = Versions(tmp_path, base).all()
    assert [version.number for version in shelf.versions] == [0, 1, 2, 3, 4, 5, 6]
    assert shelf.complaints == ()


def _add_once(folder: Path, provenance: Provenance, barrier: float) -> int:
    base = load_model(shipped("models/reference.yaml"))
    versions = Versions(folder, base)
    model = with_creep(base)
    time.sleep(max(0.0, barrier - time.time()))
    return versions.add(
        model, parent=0, created_at=NOW, provenance=provenance, once=True
    ).number


def test_two_that_judge_one_recording_at_once_keep_one_version(
    tmp_path: Path, provenance: Provenance
) -> None:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, context) as pool:
        list(pool.map(abs, range(2)))
        for round_ in range(10):
            folder, barrier = tmp_path / str(round_), time.time() + 0.05
            adding = [
                pool.submit(_add_once, folder, provenance, barrier) for _ in range(2)
            ]
            assert [each.result() for each in adding] == [1, 1]
            assert not (folder / "2.yaml").exists()


def test_the_version_before_is_told_without_going_back(
    versions: Versions, provenance: Provenance
) -> None:
    base = versions.get(0).model
    versions.add(base, parent=0, created_at=NOW, provenance=provenance)
    with pytest.raises(Refused, match="version 0 was the first"):
        versions.before()
    versions.activate(1)
    assert versions.before().number == 0
    assert versions.active == 1
