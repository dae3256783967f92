import logging

import pytest


@pytest.fixture(autouse=True)
def quiet() -> None:
    """The library logs each frame that it cannot decode."""
    logging.getLogger("pymodbus_internal").setLevel(logging.CRITICAL)
