"""Defects: reported, and nothing told."""

import logging

import httpx
import pytest
from fastapi import FastAPI

from gripperd.errors import GripperdError
from gripperd.link.frames import failed, raised
from gripperd.service.failures import answer_failures
from gripperd.service.server import serve
from tests.daemon import PATIENCE

from .conftest import Report, running
from .test_bad_input import is_problem


async def _beyond(report: Report) -> None:
    """A service in front of a process that meets a defect."""
    app = FastAPI()
    answer_failures(app)

    @app.get("/")
    async def ask() -> None:
        raise raised(failed(GripperdError("defect: secret")))

    await serve(app, "127.0.0.1", 0, report)


def test_a_defect_of_another_process_is_no_lost_link() -> None:
    with running(_beyond) as url:
        answer = httpx.get(url, timeout=PATIENCE)
    found = is_problem(answer, 500, "internal")
    assert found["retryable"] is False
    assert "secret" not in answer.text


async def _defective(report: Report) -> None:
    app = FastAPI()
    answer_failures(app)

    @app.get("/")
    async def divide() -> float:
        secret = 0
        return 1 / secret

    await serve(app, "127.0.0.1", 0, report)


def test_a_defect_is_logged_and_not_told(caplog: pytest.LogCaptureFixture) -> None:
    with running(_defective) as url, caplog.at_level(logging.ERROR):
        answer = httpx.get(url, timeout=PATIENCE)
    found = is_problem(answer, 500, "internal")
    assert "secret" not in answer.text
    assert "ZeroDivision" not in answer.text
    assert found["retryable"] is False
    assert "ZeroDivisionError" in caplog.text
