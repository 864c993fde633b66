"""Jobs as the API takes them."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field, JsonValue

from service.http.request_models import REQUEST_MODEL
from service.job_records.schemas import PriorityName
from service.tables.jobs import TITLE_CHARACTERS, TITLE_PATTERN
from service.webhooks.schemas import Events, Url

Given = str | Annotated[list[str], Field(fail_fast=True, max_length=800)]
"""Of an input that takes many, as many as photos of a persona may be (`engine.persona`)."""
Title = Annotated[str, Field(min_length=1, max_length=TITLE_CHARACTERS, pattern=TITLE_PATTERN)]


class JobIn(BaseModel):
    """What a client asks for."""

    model_config = REQUEST_MODEL

    kind: str
    inputs: dict[str, Given] = {}
    """Input names to file ids, https addresses or names of drivers; a list where an input takes many."""
    options: dict[str, JsonValue] = {}
    webhook_url: Url | None = None
    """An address that is told of this job, signed with the secret of the caller's key (`GET /key`)."""
    webhook_events: Events | None = None
    """What it is told; of the job's end alone if not given."""
    metadata: dict[str, JsonValue] = Field({}, max_length=100)
    priority: PriorityName = "normal"
    """Waiting jobs of a kind are taken in this order; among equals, each key has its turn."""
    title: Title | None = None
    """What the work is called."""


class JobChange(BaseModel):
    """What is to be different about a job."""

    model_config = REQUEST_MODEL

    title: Title | None
    """What the work is called, in all its versions; null takes the title away."""


class RevisionIn(BaseModel):
    """What is to be different."""

    model_config = REQUEST_MODEL

    corrections: dict[str, JsonValue] = {}
    """What was found wrongly, by the names that the kind offers (`GET /kinds`); of inputs, file ids or https addresses,
    and null takes one back."""
    options: dict[str, JsonValue] = {}
    """Options to change; null takes one back to its default. The others stay as they were."""
    webhook_url: Url | None = None
    """Null keeps the job's own."""
    webhook_events: Events | None = None
    """Null keeps the job's own."""
    metadata: dict[str, JsonValue] | None = Field(None, max_length=100)
    """Null keeps the job's own."""
    priority: PriorityName | None = None
    """Null keeps the job's own."""
