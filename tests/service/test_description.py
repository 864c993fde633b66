"""What the service says of itself: OpenAPI, kinds, health, figures, problems, settings."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from running import ROOT, Running

from service.kinds.registry import load_kinds
from service.kinds.schemas import KindOut
from service.settings import Settings


def test_the_openapi_document_names_every_operation_of_the_contract(running: Running) -> None:
    document = running.client.get("/v1/openapi.json").json()
    offered = {(method.upper(), path) for path, item in document["paths"].items() for method in item}
    assert offered >= {
        *(("POST", "/v1/files"), ("POST", "/v1/jobs"), ("GET", "/v1/jobs"), ("GET", "/v1/jobs/{job_id}")),
        *(("POST", "/v1/jobs/{job_id}/cancel"), ("DELETE", "/v1/jobs/{job_id}"), ("GET", "/v1/jobs/{job_id}/events")),
        *(("GET", "/v1/jobs/{job_id}/artifacts/{name}"), ("GET", "/v1/kinds"), ("GET", "/healthz")),
        *(("GET", "/v1/drivers"), ("POST", "/v1/drivers"), ("DELETE", "/v1/drivers/{name}")),
    }
    operations = [item["operationId"] for path in document["paths"].values() for item in path.values()]
    assert len(operations) == len(set(operations))
    assert "ProblemDocument" in document["components"]["schemas"]
    references = set(re.findall(r'"#/components/schemas/(\w+)"', running.client.get("/v1/openapi.json").text))
    assert references <= set(document["components"]["schemas"])


def test_kinds_describe_their_inputs_and_options(running: Running) -> None:
    kinds = {kind["name"]: kind for kind in running.client.get("/v1/kinds").json()["items"]}
    assert set(kinds) == {"tiny"}
    assert kinds["tiny"]["inputs_schema"]["required"] == ["image"]
    assert kinds["tiny"]["options_schema"]["properties"]["seconds"]["minimum"] == 0


def test_the_engines_kinds_have_the_names_and_inputs_of_the_contract() -> None:
    offered = {kind.name: KindOut.of(kind) for kind in load_kinds(Settings().kinds).values()}
    assert [item.name for item in offered["portrait"].inputs][:2] == ["image", "driver"]
    fixed = {"size", "fps", "format", "strength", "follow", "crop", "loop", "sound", "neutral_frame", "face_index"}
    assert set(offered["portrait"].options_schema["properties"]) >= fixed


def test_health_and_figures(running: Running) -> None:
    assert running.client.get("/healthz").json() == {"status": "ok"}
    assert running.client.get("/readyz").json()["checks"] == {"database": True, "redis": True, "disk": True}
    figures = running.client.get("/metrics").text
    assert re.search(r'^galatea_jobs\{kind="tiny",status="succeeded"\} \d', figures, re.MULTILINE)
    assert "galatea_redis_up 1.0" in figures


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("GET", "/v1/nothing", 404, "not_found"),
        ("GET", "/nothing.js", 404, "not_found"),
        ("DELETE", "/v1/kinds", 405, "method_not_allowed"),
        ("GET", "/v1/jobs/x/cancel", 405, "method_not_allowed"),
        ("GET", "/v1/jobs?limit=none", 422, "invalid_request"),
    ],
)
def test_every_error_is_a_problem_document(running: Running, method: str, path: str, status: int, code: str) -> None:
    response = running.client.request(method, path)
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert (response.status_code, problem["status"], problem["code"]) == (status, status, code)
    assert problem["type"] == f"urn:galatea:problem:{code}"
    assert problem["title"] and problem["detail"]


def test_every_setting_is_in_the_docs_with_its_default() -> None:
    text = (ROOT / "docs" / "settings.md").read_text()
    documented = dict(re.findall(r"^\| `GALATEA_(\w+)` \| ([^|]*) \|", text, re.MULTILINE))
    assert set(documented) == {name.upper() for name in Settings.model_fields}
    for name, field in Settings.model_fields.items():
        if isinstance(field.default, int | float | str) and not isinstance(field.default, Path):
            assert documented[name.upper()].strip() == f"`{field.default}`", name


def test_every_problem_code_is_in_the_docs() -> None:
    text = (ROOT / "docs" / "api.md").read_text()
    sources = [path.read_text() for folder in ("service", "worker") for path in (ROOT / folder).rglob("*.py")]
    raised = {code for source in sources for code in re.findall(r'(?:Problem\(\s*\d+,|Refused\()\s*"(\w+)"', source)}
    raised |= {code for source in sources for code in re.findall(r'(?:failed\(|"code": )"(\w+)"', source)}
    assert len(raised) > 30
    assert {code for code in raised if f"`{code}`" not in text} == set()
