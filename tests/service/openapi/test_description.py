"""What the service says of itself: OpenAPI, kinds, health, figures, problems, settings."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from running import ROOT, Running, eventually

from service.catalogue.registry import load_kinds
from service.kinds.schemas import KindOut
from service.libraries.library import LIBRARIES
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


def test_every_library_has_the_same_endpoints(running: Running) -> None:
    paths = running.client.get("/v1/openapi.json").json()["paths"]
    for library in LIBRARIES.values():
        assert set(paths[library.address]) == {"get", "post"}
        assert set(paths[f"{library.address}/{{name}}"]) == {"get", "patch", "delete"}
        inspections = [
            operation["operationId"]
            for path, item in paths.items()
            for operation in item.values()
            if path.startswith(f"{library.address}/{{name}}/") and "202" in operation["responses"]
        ]
        assert len(inspections) == 1 and inspections[0].endswith(f"_{library.noun}")


def test_kinds_describe_their_inputs_and_options(running: Running) -> None:
    kinds = {kind["name"]: kind for kind in running.client.get("/v1/kinds").json()["items"]}
    assert set(kinds) == {"tiny"}
    assert kinds["tiny"]["inputs_schema"]["required"] == ["image"]
    assert kinds["tiny"]["correctable"] == ["level", "mask"]
    assert kinds["tiny"]["options_schema"]["properties"]["seconds"]["minimum"] == 0


def test_the_engines_kinds_have_the_names_and_inputs_of_the_contract() -> None:
    offered = {kind.name: KindOut.of(kind, Settings()) for kind in load_kinds(Settings().kinds).values()}
    assert [item.name for item in offered["portrait"].inputs][:2] == ["image", "driver"]
    fixed = {"size", "fps", "format", "strength", "follow", "crop", "loop", "sound", "neutral_frame", "face_index"}
    assert set(offered["portrait"].options_schema["properties"]) >= fixed


def test_health_and_figures(running: Running, picture: bytes) -> None:
    running.until(running.submit(picture)["id"], "succeeded")
    assert running.client.get("/healthz").json() == {"status": "ok"}
    assert running.client.get("/readyz").json()["checks"] == {
        **{"database": True, "redis": True, "storage": True, "disk": True, "worker": True}
    }
    figures = running.client.get("/metrics").text
    assert re.search(r'^galatea_jobs\{kind="tiny",status="succeeded"\} \d', figures, re.MULTILINE)
    assert "galatea_redis_up 1.0" in figures


def test_what_was_counted_outlives_what_it_counts(start: Callable[..., Running], picture: bytes) -> None:
    running = start()
    done = running.until(running.submit(picture, seconds=0.3)["id"], "succeeded")
    refused = running.until(running.submit(picture, crash="refuse")["id"], "failed")
    long, queued = running.submit(picture, seconds=3000), running.submit(picture)
    eventually(lambda: figure(running, 'galatea_queue_oldest_seconds{kind="tiny"}') > 0.5, "one has waited")
    for job in (long, queued):
        running.client.post(f"/v1/jobs/{job['id']}/cancel").raise_for_status()
    for job in (done, refused):
        running.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()
    running.stop()
    running.start()
    ended = 'galatea_jobs_ended_total{code="%s",kind="tiny",status="%s"}'
    assert figure(running, ended % ("", "succeeded")) == 1
    assert figure(running, ended % ("no_face", "failed")) == 1
    assert figure(running, ended % ("", "canceled")) == 2
    assert figure(running, 'galatea_uploaded_bytes_total{media="image"}') == 4 * len(picture)
    assert figure(running, 'galatea_stage_runs_total{kind="tiny",stage="rest"}') == 1
    assert 0.3 <= figure(running, 'galatea_stage_seconds_total{kind="tiny",stage="rest"}') < 100, "no milliseconds"
    assert figure(running, 'galatea_queue_oldest_seconds{kind="tiny"}') == 0


def test_the_dashboard_shows_figures_that_there_are(running: Running, picture: bytes) -> None:
    running.until(running.submit(picture)["id"], "succeeded")
    webhook = running.client.post("/v1/webhooks", json={"url": "http://127.0.0.1:9/"}).raise_for_status().json()
    running.client.post(f"/v1/webhooks/{webhook['id']}/test").raise_for_status()
    eventually(lambda: "galatea_webhook_attempts_total{" in running.client.get("/metrics").text, "it was tried")
    running.client.delete(f"/v1/webhooks/{webhook['id']}").raise_for_status()
    dashboard = json.loads((ROOT / "docs" / "operations" / "grafana.json").read_text())
    asked = [target["expr"] for panel in dashboard["panels"] for target in panel["targets"]]
    figures = running.client.get("/metrics").text
    for expression in asked:
        for name in re.findall(r"galatea_\w+", expression):
            assert re.search(rf"^{name}(\{{| )", figures, re.MULTILINE), name
        labels = re.search(r"by \(([^)]*)\)", expression)
        for label in labels[1].split(", ") if labels else ():
            assert f'{label}="' in figures
    places = [(p["gridPos"]["x"], p["gridPos"]["y"]) for p in dashboard["panels"]]
    assert len(set(places)) == len(places)


def figure(running: Running, name: str) -> float:
    """A figure by its name and labels."""
    found = re.search(rf"^{re.escape(name)} (\S+)$", running.client.get("/metrics").text, re.MULTILINE)
    return float(found[1]) if found else float("nan")


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
