"""What clients send: how a model of a body is."""

from __future__ import annotations

from pydantic import BeforeValidator, ConfigDict

REQUEST_MODEL = ConfigDict(extra="forbid", strict=True)
"""No names but the model's own, and every value of the type that the OpenAPI document says: `true` is no number."""


def _whole(value: object) -> object:
    return int(value) if isinstance(value, float) and value.is_integer() else value


WHOLE_NUMBER = BeforeValidator(_whole)
"""For whole numbers, which JSON may also write as 3.0: `Annotated[int, Field(ge=1), WHOLE_NUMBER]`, in this order, so that
the OpenAPI document tells the bounds."""
