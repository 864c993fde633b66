"""What the service says of itself: OpenAPI, problems, settings."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from running import ROOT, Running

from service.settings import Settings


def test_the_openapi_document_names_every_operation_of_the_contract(running: Running) -> None:
    document = running.client.get("/v1/openapi.json").json()
    offered = {(method.upper(), path) for path, item in document["paths"].items() for method in item}
    assert offered >= {
        *(("POST", "/v1/files"), ("POST", "/v1/jobs"), ("GET", "/v1/jobs"), ("GET", "/v1/jobs/{job_id}")),
        *(("POST", "/v1/jobs/{job_id}/cancel"), ("DELETE", "/v1/jobs/{job_id}"), ("GET", "/v1/jobs/{job_id}/events")),
        *(("GET", "/v1/jobs/{job_id}/artifacts/{name}"), ("GET", "/v1/kinds"), ("GET", "/healthz")),
        *(("POST", "/v1/jobs/{job_id}/revisions"), ("GET", "/v1/jobs/{job_id}/archive")),
        *(("GET", "/v1/drivers"), ("POST", "/v1/drivers"), ("DELETE", "/v1/drivers/{name}")),
        *(("GET", "/v1/motions"), ("POST", "/v1/motions"), ("DELETE", "/v1/motions/{name}")),
    }
    operations = [item["operationId"] for path in document["paths"].values() for item in path.values()]
    assert len(operations) == len(set(operations))
    assert "ProblemDocument" in document["components"]["schemas"]
    references = set(re.findall(r'"#/components/schemas/(\w+)"', running.client.get("/v1/openapi.json").text))
    assert references <= set(document["components"]["schemas"])


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("GET", "/v1/nothing", 404, "not_found"),
        ("GET", "/nothing.js", 404, "not_found"),
        ("DELETE", "/v1/kinds", 405, "method_not_allowed"),
        ("GET", "/v1/jobs/x/cancel", 405, "method_not_allowed"),
        ("PATCH", "/v1/webhooks/deliveries", 405, "method_not_allowed"),
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
    raised |= {
        code for source in sources for code in re.findall(r'(?:failed\(|FetchFailed\(\s*|"code": )"(\w+)"', source)
    }
    assert len(raised) > 30
    assert {code for code in raised if f"`{code}`" not in text} == set()
