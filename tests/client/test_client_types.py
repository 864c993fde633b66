"""The Python client and the service's OpenAPI document say the same."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest
from pydantic import BaseModel
from running import ROOT, Running

import galatea_client
from galatea_client import events, models
from galatea_client.operations import OPERATIONS

SCHEMAS: dict[type[BaseModel], str] = {
    galatea_client.Job: "JobOut",
    models.Progress: "Progress",
    models.JobError: "JobError",
    models.Artifact: "ArtifactOut",
    models.File: "FileOut",
    models.Kind: "KindOut",
    models.KindLimits: "KindLimits",
    models.Input: "InputOut",
    models.Driver: "DriverOut",
    models.Moment: "MomentOut",
    models.Motion: "MotionOut",
    models.MotionJoint: "MotionJoint",
    models.MotionError: "MotionError",
    models.Live: "LiveOut",
    models.Key: "KeyOut",
    models.NewKey: "NewKeyOut",
    models.OwnKey: "OwnKeyOut",
    models.Link: "LinkOut",
    models.Webhook: "WebhookOut",
    models.NewWebhook: "NewWebhookOut",
    models.Disabled: "Disabled",
    models.WebhookSecret: "SecretOut",
    models.Delivery: "DeliveryOut",
    models.Attempt: "AttemptOut",
    models.DeliveryError: "DeliveryError",
}


@pytest.fixture(scope="module")
def document(shared_service: Running) -> dict[str, Any]:
    return shared_service.client.get("/v1/openapi.json").raise_for_status().json()


def test_every_operation_is_where_the_client_looks_for_it(document: dict[str, Any]) -> None:
    offered = {
        operation["operationId"]: (method.upper(), path)
        for path, item in document["paths"].items()
        for method, operation in item.items()
    }
    assert {name: offered.get(name) for name in OPERATIONS} == OPERATIONS


@pytest.mark.parametrize("model", SCHEMAS, ids=lambda model: model.__name__)
def test_every_answer_has_the_fields_and_types_that_the_client_expects(
    document: dict[str, Any], model: type[BaseModel]
) -> None:
    schema = document["components"]["schemas"][SCHEMAS[model]]
    mine = model.model_json_schema(mode="serialization")["properties"]
    assert set(mine) == set(schema["properties"])
    for name, told in schema["properties"].items():
        assert _types(mine[name]) == _types(told), name


def test_all_models_are_held_against_the_document() -> None:
    defined = {
        one
        for module in (models, galatea_client.job, events)
        for one in vars(module).values()
        if isinstance(one, type) and issubclass(one, BaseModel) and one.__module__.startswith("galatea_client")
    }
    base = {
        models.Model,
        galatea_client.job.JobDocument,
        galatea_client.AsyncJob,
        events.StatusEvent,
        events.ProgressEvent,
        events.ArtifactEvent,
    }
    assert defined - base == set(SCHEMAS)


def test_it_needs_nothing_else_of_this_repository() -> None:
    program = (
        "import sys, galatea_client\n"
        "roots = {name.partition('.')[0] for name in sys.modules}\n"
        "print(roots & {'engine', 'service', 'worker', 'shell', 'numpy', 'fastapi', 'sqlalchemy', 'structlog'})"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def _types(schema: dict[str, Any]) -> set[str]:
    """The JSON types that a schema allows; objects that are models, and enumerations, count by what they are."""
    if "anyOf" in schema:
        return {one for part in schema["anyOf"] for one in _types(part)}
    if "$ref" in schema:
        return {"string"} if schema["$ref"].endswith(("Status", "EventType")) else {"object"}
    if "additionalProperties" in schema or schema.get("type") == "object":
        return {"object"}
    return {schema.get("format") or schema.get("type", "any")}
