from datetime import UTC, datetime

import pytest

from gripperd.config import reference_chain
from gripperd.model import Chain
from gripperd.reproduce import Report, reproduce

MADE_AT = datetime(2024, 6, 7, 8, 30, tzinfo=UTC)


@pytest.fixture(scope="session")
def chain() -> Chain:
    return reference_chain()


@pytest.fixture(scope="session")
def report(chain: Chain, tmp_path_factory: pytest.TempPathFactory) -> Report:
    folder = tmp_path_factory.mktemp("reproduce") / "report"
    return reproduce(chain, folder, version="1.2.3", made_at=MADE_AT)
