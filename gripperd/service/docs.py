"""A page that lists every operation, made from the OpenAPI document; works offline."""

import json
from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, RedirectResponse

from gripperd.service.problems import PROBLEMS

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto;
       padding: 0 1rem; color: #1a1a1a; background: #fff }
code, pre { font: 13px/1.4 ui-monospace, monospace; background: #f3f3f0 }
pre { padding: .6rem; overflow-x: auto }
summary { cursor: pointer; padding: .2rem 0 }
summary b { display: inline-block; min-width: 4.5rem }
td, th { text-align: left; padding: .1rem 1rem .1rem 0; vertical-align: top }
"""
POLICY = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"

routes = APIRouter(include_in_schema=False)


@routes.get("/")
async def front() -> RedirectResponse:
    """Lead people to the documentation."""
    return RedirectResponse("/docs")


@routes.get("/docs")
async def docs(request: Request) -> HTMLResponse:
    """Every operation, for people."""
    page = documentation(request.app.openapi())
    return HTMLResponse(page, headers={"content-security-policy": POLICY})


def documentation(schema: Mapping[str, Any]) -> str:
    """Write the page of an OpenAPI document."""
    title = escape(f"{schema['info']['title']} {schema['info']['version']}")
    return "".join(
        (
            "<!doctype html><html lang=en><meta charset=utf-8>",
            f"<title>{title}</title><style>{STYLE}</style><h1>{title}</h1>",
            f"<p>{escape(schema['info'].get('description', ''))}</p>",
            "<p>For programs: <a href=/openapi.json>/openapi.json</a>.</p>",
            *_operations(schema),
            *_problems(),
            *_schemas(schema),
        )
    )


def _operations(schema: Mapping[str, Any]) -> Iterator[str]:
    tag = None
    for path, operations in schema["paths"].items():
        for method, operation in operations.items():
            if operation["tags"][0] != tag:
                tag = operation["tags"][0]
                yield f"<h2>{escape(tag)}</h2>"
            yield (
                f"<details><summary><b>{escape(method.upper())}</b>"
                f" <code>{escape(path)}</code>"
                f" {escape(operation.get('description', ''))}</summary>"
            )
            yield from _parameters(operation.get("parameters", ()))
            yield from _bodies(operation)
            yield "</details>"


def _parameters(parameters: Any) -> Iterator[str]:  # noqa: ANN401 - JSON
    if not parameters:
        return
    yield "<table>"
    for each in parameters:
        yield (
            f"<tr><td><code>{escape(each['name'])}</code><td>{escape(each['in'])}"
            f"<td>{escape(each.get('description', ''))}"
        )
    yield "</table>"


def _bodies(operation: Mapping[str, Any]) -> Iterator[str]:
    body = operation.get("requestBody", {}).get("content", {})
    yield from _content("Body", body)
    for status, answer in operation["responses"].items():
        if status != "default":
            yield from _content(f"Answer {status}", answer.get("content", {}))


def _content(name: str, content: Mapping[str, Any]) -> Iterator[str]:
    for kind in content.values():
        names = sorted(_references(kind["schema"]))
        links = ", ".join(f"<a href=#{escape(to)}>{escape(to)}</a>" for to in names)
        yield f"<p>{name}: {links or 'JSON'}</p>"


def _references(part: object) -> Iterator[str]:
    if isinstance(part, dict):
        if "$ref" in part:
            yield str(part["$ref"]).rpartition("/")[2]
        for inside in part.values():
            yield from _references(inside)
    elif isinstance(part, list):
        for inside in part:
            yield from _references(inside)


def _problems() -> Iterator[str]:
    yield "<h2>problems</h2><p>Every failure is a problem document (RFC 9457) with one"
    yield " of these codes.</p><table><tr><th>status<th>code<th>meaning<th>again?"
    for code, kind in PROBLEMS.items():
        again = "may help" if kind.retryable else ""
        yield (
            f"<tr><td>{kind.status}<td><code>{escape(code)}</code>"
            f"<td>{escape(kind.title)}<td>{again}"
        )
    yield "</table>"


def _schemas(schema: Mapping[str, Any]) -> Iterator[str]:
    yield "<h2>documents</h2>"
    for name, document in sorted(schema["components"]["schemas"].items()):
        text = json.dumps(document, indent=2, ensure_ascii=False)
        yield f"<details id={escape(name)}><summary><code>{escape(name)}</code>"
        yield f" {escape(document.get('description', ''))}</summary>"
        yield f"<pre>{escape(text)}</pre></details>"
