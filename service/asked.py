"""What clients send: how every body is read."""

from __future__ import annotations

import json
from typing import Any

from fastapi import Request
from pydantic import BeforeValidator, ConfigDict

from service.files.intake import FIELD_BYTES
from service.problems import Problem

ASKED = ConfigDict(extra="forbid", strict=True)
"""No names but the model's own, and every value of the type that the OpenAPI document says: `true` is no number."""


def _whole(value: object) -> object:
    return int(value) if isinstance(value, float) and value.is_integer() else value


WHOLE = BeforeValidator(_whole)
"""For whole numbers, which JSON may also write as 3.0: `Annotated[int, Field(ge=1), WHOLE]`, in this order, so that
the OpenAPI document tells the bounds."""

JSON_TYPES = ("", "application/json")
"""Media types of bodies that are read as JSON."""


async def read_json(request: Request) -> Any:
    """What a JSON body holds. Raises a 413 or a 422 problem."""
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > FIELD_BYTES:
            raise Problem(413, "request_too_large", f"The JSON body may have {FIELD_BYTES} bytes at most.")
    return parse_json(body, "The body")


def parse_json(text: str | bytes, what: str) -> Any:
    """What a JSON text holds. Raises a 422 problem."""
    try:
        return json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise Problem(422, "invalid_json", f"{what} is not valid JSON.") from None


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no JSON")
