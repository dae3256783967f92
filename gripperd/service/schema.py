"""The OpenAPI document, with problem documents in place of the framework's errors."""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from gripperd.service.problems import Problem, ProblemResponse

PROBLEM: dict[int | str, dict[str, Any]] = {
    "default": {"model": Problem, "description": "What went wrong (RFC 9457)."}
}
"""Response of every operation that fails."""


def describe(app: FastAPI) -> dict[str, Any]:
    """Give the OpenAPI document of an application, made once."""
    if app.openapi_schema is None:
        schema = get_openapi(
            title=app.title,
            version=app.version,
            description=app.description,
            routes=app.routes,
        )
        for operations in schema["paths"].values():
            for operation in operations.values():
                failed = operation["responses"].get("default")
                if failed:
                    (content,) = failed["content"].values()
                    failed["content"] = {ProblemResponse.media_type: content}
        app.openapi_schema = schema
    return app.openapi_schema
