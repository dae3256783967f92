from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.config import Provenance, Settings, load_settings, shipped
from gripperd.effects.creep import Creep
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_lag import ValveLag
from gripperd.errors import ConfigError
from gripperd.model import StaticMuscle
from gripperd.store import versions_of, with_active_models

NOW = datetime(2026, 1, 31, 12, 0, tzinfo=UTC)


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return replace(load_settings(shipped("gripperd.yaml"), {}), state_dir=tmp_path)


def test_without_versions_settings_stay_as_they_are(settings: Settings) -> None:
    assert with_active_models(settings) == settings


def test_settings_get_the_active_version_with_all_its_effects(
    settings: Settings, provenance: Provenance
) -> None:
    configured = settings.grippers["g0"]
    versions = versions_of(settings, configured)
    muscle = configured.model.static.muscle
    model = replace(
        configured.model,
        static=StaticMuscle(muscle, (Creep(slow=0.03),)),
        effects=(ValveLag(share=1.0),),
    )
    versions.add(model, parent=0, created_at=NOW, provenance=provenance)
    assert with_active_models(settings) == settings
    versions.activate(1)
    updated = with_active_models(settings).grippers["g0"]
    assert updated.chain.name == "reference-1"
    assert updated.chain.static.effects == (Creep(slow=0.03),)
    assert updated.chain.effects == (ValveLag(share=1.0),)
    assert updated.output == configured.output


def test_a_version_whose_valve_the_module_cannot_drive_is_refused(
    settings: Settings, provenance: Provenance
) -> None:
    configured = settings.grippers["g0"]
    versions = versions_of(settings, configured)
    assert configured.model.regulator is not None
    regulator = replace(configured.model.regulator, current_high=0.0235)
    model = replace(configured.model, regulator=regulator)
    versions.add(model, parent=0, created_at=NOW, provenance=provenance)
    versions.activate(1)
    with pytest.raises(ConfigError, match=r"valve\.current_mA ends at 23\.5 mA"):
        with_active_models(settings)


def test_a_version_that_no_current_closes_is_refused(
    settings: Settings, provenance: Provenance
) -> None:
    configured = settings.grippers["g0"]
    versions = versions_of(settings, configured)
    # The supply gives 25 kPa, and the bladder takes 60 before it pulls.
    static = configured.model.static
    model = replace(
        configured.model,
        static=replace(static, effects=(*static.effects, ThresholdPressure(60e3))),
        effects=(SupplySaturation(share=1.0, limit=0.05),),
    )
    versions.add(model, parent=0, created_at=NOW, provenance=provenance)
    versions.activate(1)
    with pytest.raises(ConfigError, match="does not close") as refused:
        with_active_models(settings)
    assert "4 mA and 20 mA give" in str(refused.value)
