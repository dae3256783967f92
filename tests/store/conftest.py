from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.config import load_model, shipped
from gripperd.config.lineage import Added, Gap, Provenance, Recorded
from gripperd.store import Versions

NOW = datetime(2026, 1, 31, 12, 0, tzinfo=UTC)


@pytest.fixture
def provenance() -> Provenance:
    return Provenance(
        program="0.1.0",
        recording=Recorded(name="steps.csv", sha256="0" * 64),
        seed=7,
        effects=(
            Added(
                name="creep",
                parameters={"slow": 0.03, "time_s": 2.0},
                std={"slow": 0.002},
            ),
        ),
        gap=Gap(
            signal="force_N",
            unit="N",
            rmse_before=23.4,
            rmse_recalibrated=14.1,
            rmse_after=5.2,
            noise_floor=5.0,
        ),
        heldout_runs=("steps_h0.10",),
    )


@pytest.fixture
def versions(tmp_path: Path) -> Versions:
    base = load_model(shipped("models/reference.yaml"))
    return Versions(tmp_path / "models" / "reference", base)
