from dataclasses import replace

from gripperd.config.lineage import Provenance
from gripperd.effects.creep import Creep
from gripperd.model import StaticMuscle
from gripperd.store import Change, Versions, difference
from tests.store.conftest import NOW


def test_nothing_differs_from_itself(versions: Versions) -> None:
    model = versions.get(0).model
    assert difference(model, model) == ()


def test_constants_tolerances_and_effects_are_told_in_the_units_of_the_file(
    versions: Versions,
) -> None:
    before = versions.get(0).model
    assert before.regulator is not None
    rubber, _ = before.static.effects
    wider = replace(before.static.muscle, diameter=20.1 * 1e-3)
    after = replace(
        before,
        name="another name is no difference",
        static=StaticMuscle(wider, (rubber, Creep(slow=0.03, time=5.0))),
        regulator=replace(before.regulator, pressure_high=510e3),
        tolerances={
            **before.tolerances,
            "muscle.diameter": 0.02 * 1e-3,
            "effects.creep.slow": 0.002,
        },
    )
    assert difference(before, after) == (
        Change("muscle.diameter_mm", 20.0, 20.1),
        Change("muscle.diameter_mm.tolerance", 0.1, 0.02),
        Change("valve.pressure_kPa[1]", 500.0, 510.0),
        Change("effects.braid_friction", "present", None),
        Change("effects.braid_friction.form", "rebraced", None),
        Change("effects.braid_friction.share", 1.0, None),
        Change("effects.creep", None, "present"),
        Change("effects.creep.fast", None, 0.0),
        Change("effects.creep.medium", None, 0.0),
        Change("effects.creep.slow", None, 0.03),
        Change("effects.creep.slow.tolerance", None, 0.002),
        Change("effects.creep.time_s", None, 5.0),
        Change("effects.creep.leverage", None, 1.0),
        Change("effects.creep.fresh", None, 0.0),
        Change("effects.creep.stretch", None, 0.0),
        Change("effects.creep.even", None, 0.0),
        Change("effects.creep.of", None, "pull"),
        Change("effects.creep.holds", None, "settled"),
    )


def test_a_deviation_that_is_no_tolerance_is_told_all_the_same(
    versions: Versions, provenance: Provenance
) -> None:
    before = versions.get(0).model
    # Nothing beyond 0.15 is possible, so 0.149 has no tolerance of 0.002.
    effects = (*before.static.effects, Creep(slow=0.149, time=2.0))
    after = replace(before, static=replace(before.static, effects=effects))
    kept = versions.add(after, parent=0, created_at=NOW, provenance=provenance)
    found = difference(before, kept.model)
    assert Change("effects.creep.slow.std", None, 0.002) in found
    known = replace(
        kept.model, tolerances={**before.tolerances, "effects.creep.slow": 0.0005}
    )
    paths = {change.path for change in difference(before, known)}
    assert "effects.creep.slow.tolerance" in paths
    assert "effects.creep.slow.std" not in paths


def test_a_part_that_is_new_is_a_difference(versions: Versions) -> None:
    whole = versions.get(0).model
    bare = replace(whole, linkage=None)
    found = difference(bare, whole)
    assert Change("gripper.open_width_mm", None, 85.0) in found
    assert {change.before for change in found} == {None}
