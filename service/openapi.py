"""The OpenAPI document: as FastAPI draws it, with what FastAPI does not know.

Every error is the problem document that it is; the job kinds on offer and their options are named; whoever makes
something is linked to what can be done with it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fastapi import FastAPI
from pydantic.json_schema import models_json_schema

from service.auth.sessions import SESSION_COOKIE
from service.http.guard import PUBLIC_PATH
from service.jobs.schemas import JobIn, RevisionIn
from service.problems import ProblemDocument, responses
from service.traces.requests import REQUEST_ID_HEADER, REQUEST_ID_PATTERN

SCHEMA_REFERENCE = "#/components/schemas/{model}"
DRAWN_BY_FASTAPI = ("HTTPValidationError", "ValidationError")
"""Errors that are never answered, because validation errors are problems too."""
REQUEST_ID = {
    "description": "The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form.",
    "required": True,
    "schema": {"type": "string", "pattern": f"^{REQUEST_ID_PATTERN}$"},
}
"""The header of every answer. It is no parameter: one of another form is not refused, but replaced."""

KEYLESS_PATHS = (PUBLIC_PATH, "/v1/session")
"""The beginnings of addresses where nobody needs a key."""

SECURITY_SCHEMES = {
    "key": {"type": "http", "scheme": "bearer", "description": "A key that `galatea keys create` or POST /keys made."},
    "session": {"type": "apiKey", "in": "cookie", "name": SESSION_COOKIE, "description": "A session of the web page."},
}
"""How callers prove who they are; nobody needs to where the service is bound to loopback."""


def describe(app: FastAPI, keys_required: bool) -> None:
    """Make the application's document tell the whole truth."""
    drawn = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            document = drawn()
            _name_schemas(app, document)
            for path, _, operation in _operations(document):
                _tell_of_problems(operation)
                _tell_of_bodies(operation)
                if path == "/metrics" or (path.startswith("/v1/") and not path.startswith(KEYLESS_PATHS)):
                    _tell_of_keys(operation, keys_required)
                for parameter in operation.get("parameters", ()):
                    _never_null(parameter)
                for answer in operation["responses"].values():
                    answer["headers"] = {**answer.get("headers", {}), REQUEST_ID_HEADER: REQUEST_ID}
            _link(document)
            app.openapi_schema = document
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]


def _operations(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for path, item in document["paths"].items():
        for method, operation in item.items():
            yield path, method, operation


def _name_schemas(app: FastAPI, document: dict[str, Any]) -> None:
    components = document.setdefault("components", {})
    schemas = components.setdefault("schemas", {})
    for name in DRAWN_BY_FASTAPI:
        schemas.pop(name, None)
    kinds = app.state.context.kinds
    requests = [JobIn, RevisionIn, *(kind.options for kind in kinds.values())]
    _, definitions = models_json_schema(
        [(ProblemDocument, "serialization"), *((model, "validation") for model in requests)],
        ref_template=SCHEMA_REFERENCE,
    )
    schemas |= definitions["$defs"]
    schemas["JobIn"]["properties"]["kind"]["enum"] = list(kinds)
    components["securitySchemes"] = SECURITY_SCHEMES


def _tell_of_problems(operation: dict[str, Any]) -> None:
    answers = operation["responses"]
    if "HTTPValidationError" in str(answers.get("422")):
        answers["422"] = responses(422)[422]


def _tell_of_bodies(operation: dict[str, Any]) -> None:
    """No body may be of any length (`service.http.bodies`)."""
    if "requestBody" in operation:
        for status, answer in responses(413).items():
            operation["responses"].setdefault(str(status), answer)


def _tell_of_keys(operation: dict[str, Any], required: bool) -> None:
    operation["security"] = [*([] if required else [{}]), {"key": []}, {"session": []}]
    for status, answer in responses(401, 403, 429).items():
        operation["responses"].setdefault(str(status), answer)


def _never_null(parameter: dict[str, Any]) -> None:
    """Parameters are there or are not: unlike values in JSON, none can be null."""
    schema = parameter["schema"]
    rest = [one for one in schema.get("anyOf", ()) if one != {"type": "null"}]
    if len(rest) == 1:
        parameter["schema"] = {**rest[0], **{name: value for name, value in schema.items() if name != "anyOf"}}


def _link(document: dict[str, Any]) -> None:
    """Link every POST that makes something to the operations on what it made, whose addresses lie below its own."""
    for path, item in document["paths"].items():
        for answer in (item.get("post", {}).get("responses", {}).get(status) for status in ("201", "202")):
            made = _properties(document, answer) if answer is not None else {}
            for below, _, operation in _operations(document):
                parameter, brace, _ = below.removeprefix(f"{path}/{{").partition("}")
                named = "id" if "id" in made else parameter
                if (
                    below.startswith(f"{path}/{{")
                    and brace
                    and named in made
                    and below.count("{") == path.count("{") + 1
                ):
                    link = {"operationId": operation["operationId"], "parameters": _given(path, parameter, named)}
                    answer.setdefault("links", {})[operation["operationId"]] = link


def _given(path: str, parameter: str, named: str) -> dict[str, str]:
    above = [part[1:-1] for part in path.split("/") if part.startswith("{")]
    return {**{name: f"$request.path.{name}" for name in above}, parameter: f"$response.body#/{named}"}


def _properties(document: dict[str, Any], answer: dict[str, Any]) -> dict[str, Any]:
    schema = answer.get("content", {}).get("application/json", {}).get("schema", {})
    name = schema.get("$ref", "").rpartition("/")[2]
    return document["components"]["schemas"].get(name, {}).get("properties", {})
