"""What the service answers when something fails: always a problem document."""

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.routing import compile_path

from gripperd.errors import ConfigError, GripperdError, InputError, LinkError
from gripperd.service.problems import Fault, ProblemResponse, code_of, problem
from gripperd.service.validation import complaints_problem, validation_problem

HTTP_CODES = {
    400: "bad-request",
    404: "not-found",
    405: "method-not-allowed",
    415: "unsupported-media-type",
}
"""Code of what the framework itself refuses."""
OTHER_DEFECT = "another process met a defect; its log has the details"
SEE_ALL = "GET /docs lists every resource"
REPEATABLE = "with an Idempotency-Key it is safe to send a command again"


def answer_failures(app: FastAPI) -> None:
    """Let every failure of an application end as a problem document."""

    @app.exception_handler(GripperdError)
    async def ours(request: Request, error: GripperdError) -> ProblemResponse:
        return failure(request, error)

    @app.exception_handler(RequestValidationError)
    async def invalid(
        request: Request, refused: RequestValidationError
    ) -> ProblemResponse:
        return ProblemResponse(validation_problem(request, refused))

    @app.exception_handler(HTTPException)
    async def framework(request: Request, error: HTTPException) -> ProblemResponse:
        return _of_framework(request, error)

    @app.exception_handler(Exception)
    async def defect(request: Request, _: Exception) -> ProblemResponse:
        # The server logs it with its traceback; the client gets neither.
        detail = "the request met a defect; the log of the service has the details"
        return ProblemResponse(problem("internal", detail, instance=request.url.path))


def failure(request: Request, error: GripperdError) -> ProblemResponse:
    """Answer with an error of ours."""
    path = request.url.path
    if isinstance(error, ConfigError):
        return ProblemResponse(complaints_problem(error.complaints, path))
    code = code_of(error)
    hints: tuple[str, ...] = getattr(error, "hints", ())
    faults: tuple[Fault, ...] = ()
    if isinstance(error, InputError) and error.key == "Idempotency-Key":
        code = "idempotency-mismatch"
        hints = ("a new request needs a new key",)
    elif isinstance(error, InputError) and code == "invalid" and error.key:
        faults = (Fault(detail=str(error), pointer=f"/{error.key}"),)
    elif isinstance(error, LinkError) and path.endswith("/commands"):
        hints = (REPEATABLE,)
    detail = OTHER_DEFECT if code == "internal" else str(error)
    return ProblemResponse(
        problem(code, detail, instance=path, hints=hints, faults=faults)
    )


def _of_framework(request: Request, error: HTTPException) -> ProblemResponse:
    path, code = request.url.path, HTTP_CODES.get(error.status_code, "bad-request")
    detail, hints = str(error.detail), tuple[str, ...]()
    headers = dict(error.headers or {})
    if code == "not-found":
        detail, hints = f"there is nothing at {path}", (SEE_ALL,)
    elif code == "method-not-allowed":
        detail = f"{request.method} is not possible at {path}"
        allowed = ", ".join(_methods(request)) or "GET"
        hints = (f"possible: {allowed}",)
        headers = {"allow": allowed}
    return ProblemResponse(problem(code, detail, instance=path, hints=hints), headers)


def _methods(request: Request) -> list[str]:
    """Every documented method of a path; the framework names those of one route."""
    return sorted(
        method.upper()
        for template, operations in request.app.openapi()["paths"].items()
        if compile_path(template)[0].match(request.url.path)
        for method in operations
    )
