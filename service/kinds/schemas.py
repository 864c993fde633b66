"""Job kinds as the API shows them: enough to draw a form."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from engine.kind import Kind


class InputOut(BaseModel):
    """A named input."""

    name: str
    media: str
    description: str
    required: bool
    many: bool
    library: str | None
    """Where set, the input may also be the name of an item of that library."""


class KindOut(BaseModel):
    """A job kind."""

    name: str
    summary: str
    inputs: list[InputOut]
    inputs_schema: dict[str, Any]
    """JSON Schema of a job's `inputs`."""
    options_schema: dict[str, Any]
    """JSON Schema of a job's `options`."""

    @classmethod
    def of(cls, kind: Kind) -> KindOut:
        properties: dict[str, Any] = {}
        for item in kind.inputs:
            one = {"type": "string", "description": item.description}
            properties[item.name] = {"type": "array", "items": one} if item.many else one
        return cls(
            name=kind.name,
            summary=kind.summary,
            inputs=[InputOut.model_validate(item, from_attributes=True) for item in kind.inputs],
            inputs_schema={
                "type": "object",
                "properties": properties,
                "required": [item.name for item in kind.inputs if item.required],
                "additionalProperties": False,
            },
            options_schema=kind.options.model_json_schema(),
        )


class KindList(BaseModel):
    """All job kinds."""

    items: list[KindOut]
