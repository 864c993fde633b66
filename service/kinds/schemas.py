"""Job kinds as the API shows them: enough to draw a form."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from engine.kind import Kind
from service.catalogue.allowance import Allowance
from service.jobs.inputs import correctable
from service.settings import Settings


class InputOut(BaseModel):
    """A named input."""

    name: str
    media: str
    description: str
    required: bool
    many: bool
    library: str | None
    """Where set, the input may also be the name of an item of that library, built-in or one's own. Items of `performances`
    are those that `GET /drivers` lists, or `auto`, which takes what fits best; those of `motions` are of `GET /motions`."""
    trimmed_by: str | None
    """Where set, the input may also be a moment of a driver, `name/moment`: the option of this name is set to it."""
    spared_by: str | None
    """Where set, the option of this name makes a required input one that may be left out."""
    spared_by_input: str | None
    """Where set, the input of this name, given instead, makes a required input one that may be left out."""
    artifact: str | None
    """Where set, the input may also be the id of a job of the same kind that has succeeded: its artifact of this name."""
    corrects: bool
    """Whether a revision may give it as a correction."""


class KindLimits(BaseModel):
    """The most that a job may take."""

    seconds: float
    memory_mb: float
    cores: int | None
    """Null: all that there are."""


class KindOut(BaseModel):
    """A job kind."""

    name: str
    summary: str
    inputs: list[InputOut]
    inputs_schema: dict[str, Any]
    """JSON Schema of a job's `inputs`."""
    options_schema: dict[str, Any]
    """JSON Schema of a job's `options`."""
    correctable: list[str]
    """Names of options and inputs that a revision may give as `corrections`."""
    short: bool
    """Whether a job usually takes seconds: it does not wait behind those that take minutes."""
    limits: KindLimits

    @classmethod
    def of(cls, kind: Kind, settings: Settings) -> KindOut:
        allowed = Allowance.of(kind, settings)
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
                "required": [item.name for item in kind.inputs if item.always_needed],
                "additionalProperties": False,
            },
            options_schema=kind.options.model_json_schema(),
            correctable=correctable(kind),
            short=kind.needs.short,
            limits=KindLimits(seconds=allowed.seconds, memory_mb=allowed.memory_mb, cores=allowed.cores or None),
        )


class KindList(BaseModel):
    """All job kinds."""

    items: list[KindOut]
