"""The OpenAPI document: as FastAPI draws it, with every error as the problem document that it is."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from pydantic.json_schema import models_json_schema

from service.problems import ProblemDocument, responses

REFERENCE = "#/components/schemas/{model}"
DRAWN_BY_FASTAPI = ("HTTPValidationError", "ValidationError")
"""Errors that are never answered, because validation errors are problems too."""


def describe(app: FastAPI) -> None:
    """Make the application's document tell of problems."""
    drawn = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            document = drawn()
            schemas = document.setdefault("components", {}).setdefault("schemas", {})
            for name in DRAWN_BY_FASTAPI:
                schemas.pop(name, None)
            _, definitions = models_json_schema([(ProblemDocument, "serialization")], ref_template=REFERENCE)
            schemas |= definitions["$defs"]
            for item in document["paths"].values():
                for operation in item.values():
                    if "HTTPValidationError" in str(operation["responses"].get("422")):
                        operation["responses"]["422"] = responses(422)[422]
            app.openapi_schema = document
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]
