"""What strangers send, through a service that runs: each request is answered, briefly, and by no fault of ours."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from running import Running
from servers import PostgresServer

from benchmarks.hostile_bodies import send
from benchmarks.service_figures.strangers import Sent, document, nested, picture, strangers
from benchmarks.service_figures.strangers import texts as queries_and_paths

ROOT = Path(__file__).parent.parent.parent
SETTINGS = {"kinds": "tiny_kind:KIND,engine.kinds:KINDS", "worker": False}
LONGEST_PROBLEM = 30_000
"""Bytes: ten errors, of each no more than 2,000 characters."""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    running = Running(tmp_path_factory.mktemp("bodies") / "data", **SETTINGS, image_mb=2, video_mb=2)
    yield running
    running.stop()


@pytest.fixture(scope="module")
def on_postgres(tmp_path_factory: pytest.TempPathFactory, postgres: PostgresServer) -> Iterator[Running]:
    running = Running(tmp_path_factory.mktemp("texts") / "data", **SETTINGS, database_url=postgres.new_database())
    yield running
    running.stop()


def documented() -> set[str]:
    """Every code that the documentation of the API names."""
    return set(re.findall(r"`([a-z_]+)`", (ROOT / "docs" / "api.md").read_text()))


def wrong(service: Running, requests: list[Sent]) -> list[tuple[str, object]]:
    """Those of the requests that are not answered as they should be."""
    found: list[tuple[str, object]] = []
    codes = documented()
    for one in requests:
        status, body = send(str(service.client.base_url), "", one)
        if not 200 <= status < 500:
            found.append((one.what, (status, body[:300])))
        elif status == 404 and not one.path.startswith("/v1"):
            pass  # people who are lost see the page, which says so
        elif status >= 400:
            problem = json.loads(body)
            if len(body) > LONGEST_PROBLEM or len(problem.get("errors", ())) > 10 or problem["code"] not in codes:
                found.append((one.what, (len(body), problem["code"])))
    return found


def without_a_key(requests: Iterator[Sent]) -> list[Sent]:
    """On loopback a proxy's headers are refused before anything is looked at, and so would be a key that is none."""
    return [one for one in requests if "Authorization" not in one.headers]


def test_every_request_is_answered_briefly_and_by_no_fault(service: Running) -> None:
    requests = without_a_key(strangers())
    assert len(requests) > 400
    assert wrong(service, requests) == []
    assert service.client.get("/readyz").status_code == 200
    assert not list((service.data_dir / "incoming").iterdir())


def test_no_text_is_a_fault_of_another_database(on_postgres: Running) -> None:
    file = on_postgres.client.post("/v1/files", files={"file": picture()}).raise_for_status().json()["id"]
    bodies: list[Sent] = []
    for text in ("\\u0000", "\\ud800", "\\udfff\\ud800", "a\\u0000b"):
        given = f'"inputs": {{"image": "{file}"}}'
        bodies += [
            document(f"{text} in a value", f'{{"kind": "tiny", {given}, "metadata": {{"a": "{text}"}}}}'.encode()),
            document(f"{text} in a name", f'{{"kind": "tiny", {given}, "metadata": {{"{text}": 1}}}}'.encode()),
            document(f"{text} as a kind", f'{{"kind": "{text}"}}'.encode()),
            document(f"{text} as an input", f'{{"kind": "tiny", "inputs": {{"image": "{text}"}}}}'.encode()),
            document(f"{text} as a driver", f'{{"name": "a", "file": "{text}"}}'.encode(), "/v1/drivers"),
            document(f"{text} as a key", f'{{"key": "{text}"}}'.encode(), "/v1/session"),
            document(f"{text} as a key's name", f'{{"name": "{text}"}}'.encode(), "/v1/keys"),
            document(f"{text} as a webhook", f'{{"url": "https://{text}.example"}}'.encode(), "/v1/webhooks"),
        ]
    assert wrong(on_postgres, bodies) == []
    assert wrong(on_postgres, list(queries_and_paths())) == []


def test_a_document_at_its_bounds_comes_back_as_it_was_sent(service: Running) -> None:
    file = service.client.post("/v1/files", files={"file": picture()}).raise_for_status().json()["id"]
    notes: dict[str, Any] = {"deep": nested(45), "large": 10**300, "small": -1.5e-300, "text": "ü💥", "": None}
    job = {"kind": "tiny", "inputs": {"image": file}, "metadata": notes}
    made = service.client.post("/v1/jobs", json=job).raise_for_status().json()
    assert service.job(made["id"])["metadata"] == notes


def with_bodies(service: Running) -> list[tuple[str, str]]:
    """Every operation that takes JSON."""
    paths = service.client.get("/v1/openapi.json").json()["paths"]
    return [
        (method.upper(), re.sub(r"\{\w+\}", "00000000-0000-7000-8000-000000000000", path))
        for path, item in paths.items()
        for method, operation in item.items()
        if "application/json" in operation.get("requestBody", {}).get("content", {})
    ]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b'{"a": "' + b"a" * 1_000_000 + b'"}', (413, "request_too_large")),
        (json.dumps({f"n{i}": 1 for i in range(5001)}).encode(), (422, "too_many_names")),
        (b'{"a": ' * 51 + b"1" + b"}" * 51, (422, "json_too_deep")),
        (b"[" * 100_000, (422, "json_too_deep")),
        (b'{"a": 1e999}', (422, "number_too_large")),
        (b'{"a": 1' + b"0" * 400 + b"}", (422, "number_too_large")),
        (b'{"a": 1' + b"0" * 10_000 + b"}", (422, "invalid_json")),
        (b'{"a": "\\ud800"}', (422, "invalid_json")),
        (b'{"\\udc00": 1}', (422, "invalid_json")),
        (b'{"a": "\\u0000"}', (422, "invalid_request")),
        (b"\xff", (422, "invalid_json")),
    ],
    ids=lambda one: None if isinstance(one, tuple) else repr(one[:20]),
)
def test_every_endpoint_reads_bodies_within_the_same_bounds(
    service: Running, content: bytes, expected: tuple[int, str]
) -> None:
    operations = with_bodies(service)
    assert len(operations) >= 8
    for method, path in operations:
        answer = service.client.request(method, path, content=content, headers={"Content-Type": "application/json"})
        assert (answer.status_code, answer.json()["code"]) == expected, (method, path)


def test_of_many_errors_ten_are_told(service: Running) -> None:
    many = {f"unknown{i}": 1 for i in range(4000)}
    problem = service.client.post("/v1/webhooks", json=many).json()
    assert len(problem["errors"]) == 10 and "There are 4000 more errors." in problem["detail"]  # `url` is missing, too
    of_options = service.client.post("/v1/jobs", json={"kind": "tiny", "options": many}).json()
    assert [error["code"] for error in of_options["errors"]] == ["extra_forbidden"] * 10
    query = service.client.get("/v1/jobs", params={"status": ["x"] * 4000}).json()
    assert query["code"] == "invalid_request" and len(query["errors"]) <= 10
