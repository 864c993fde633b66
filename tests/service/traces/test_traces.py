"""Traces and the ids of requests: from the client's request to the worker's stages, and in every line of the log."""

from __future__ import annotations

import json
import re
import secrets
import socket
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing
from itertools import pairwise
from pathlib import Path
from typing import Any

import httpx
import pytest
from collector import Collector, Told
from receiver import OK, Receiver, status
from running import ROOT, Running, eventually

SECOND = 1_000_000_000


@pytest.fixture(scope="module")
def collector() -> Iterator[Collector]:
    started = Collector()
    yield started
    started.close()


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, collector: Collector) -> Iterator[Running]:
    """A service with traces switched on."""
    settings = {"traces_url": collector.url, "log_format": "json", "allowed_networks": "127.0.0.0/8"}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OTEL_BSP_SCHEDULE_DELAY", "200")
        started = Running(tmp_path_factory.mktemp("traces") / "data", **settings, lease_seconds=3, sweep_seconds=0.5)
        yield started
        started.stop()


class Trace:
    """A trace that a client began."""

    def __init__(self) -> None:
        self.id, self.span = secrets.token_hex(16), secrets.token_hex(8)
        self.headers = {"traceparent": f"00-{self.id}-{self.span}-01"}


def uploaded(service: Running, picture: bytes) -> str:
    """The id of an uploaded picture."""
    return (
        service.client.post("/v1/files", files={"file": ("anna private.png", picture)}).raise_for_status().json()["id"]
    )


def submit(service: Running, picture: str, trace: Trace, headers: dict[str, str] | None = None, **more: Any) -> str:
    """Submit a job as a part of a trace; its id. `picture` is a file's id, or an address."""
    job = {"kind": "tiny", "inputs": {"image": picture}, **more}
    answer = service.client.post("/v1/jobs", json=job, headers=trace.headers | (headers or {}))
    return answer.raise_for_status().json()["id"]


def named(spans: list[Told], name: str) -> list[Told]:
    return [span for span in spans if span.name == name]


def lines(service: Running) -> list[dict[str, Any]]:
    """What was logged."""
    text = service.output.read_text()
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


def test_a_job_is_one_trace_from_the_clients_request_to_the_last_webhook(
    service: Running, collector: Collector, picture: bytes, receive: Callable[..., Receiver]
) -> None:
    trace = Trace()
    host, told = receive(answer=status(200, picture)), receive(answer=OK)
    secret = "s3cret-" + secrets.token_hex(8)
    job_id = submit(
        service,
        f"{host.url}?token={secret}",
        trace,
        {"X-Request-Id": "order-4711"},
        options={"seconds": 0.6},
        webhook_url=f"{told.url}/{secret}",
    )
    service.until(job_id, "succeeded")
    spans = collector.until(
        lambda spans: {"webhook job.succeeded", "job tiny", "POST /v1/jobs"} <= {span.name for span in spans},
        "the trace is whole",
        trace.id,
    )
    (asked,), (whole,) = named(spans, "POST /v1/jobs"), named(spans, "job tiny")
    assert (asked.service, asked.kind, asked.parent) == ("galatea-api", "SERVER", trace.span)
    assert asked.attributes["http.response.status_code"] == 202
    assert asked.attributes["http.route"] == "/v1/jobs" and asked.attributes["galatea.job"] == job_id
    assert (whole.service, whole.kind, whole.parent) == ("galatea-worker", "CONSUMER", asked.id)
    assert whole.attributes["galatea.outcome"] == "succeeded" and whole.attributes["galatea.attempt"] == 1
    parts = [span for span in spans if span.parent == whole.id]
    assert [span.name for span in parts] == ["fetch", "stage measure", "stage rest", "stage write"]
    for before, after in pairwise(parts):
        assert whole.began <= before.began <= before.ended <= after.began <= after.ended <= whole.ended
    assert 0.6 * SECOND <= parts[2].ended - parts[2].began < whole.ended - whole.began
    (sent,) = named(spans, "webhook job.succeeded")
    assert (sent.service, sent.kind, sent.parent) == ("galatea-worker", "CLIENT", asked.id)
    assert sent.attributes["http.response.status_code"] == 200 and sent.began >= parts[-1].ended
    assert {span.attributes.get("galatea.request", "order-4711") for span in spans} == {"order-4711"}
    assert not any(span.broke for span in spans)
    exported = b"".join(collector.bodies)
    for private in (secret, "token=", "/hook", "anna"):
        assert private.encode() not in exported

    mine = [line for line in lines(service) if line.get("job") == job_id]
    assert {line["event"] for line in mine} >= {
        *("job_accepted", "attempt_started", "attempt_ended", "webhook_attempted")
    }
    assert {(line["request"], line["trace"]) for line in mine} == {("order-4711", trace.id)}
    assert secret not in service.output.read_text()


def test_a_second_attempt_belongs_to_the_same_trace(service: Running, collector: Collector, picture: bytes) -> None:
    trace = Trace()
    job_id = submit(service, uploaded(service, picture), trace, options={"crash": "segv", "crash_once": True})
    service.until(job_id, "succeeded")
    spans = collector.until(
        lambda spans: len(named(spans, "job tiny")) == 2 and bool(named(spans, "POST /v1/jobs")),
        "the request and both attempts were told of",
        trace.id,
    )
    first, second = named(spans, "job tiny")
    (asked,) = named(spans, "POST /v1/jobs")
    assert first.parent == second.parent == asked.id
    assert (first.attributes["galatea.attempt"], second.attributes["galatea.attempt"]) == (1, 2)
    assert first.broke and first.attributes["error.type"] == "crashed" and not second.broke
    assert [span.name for span in spans if span.parent == first.id] == ["stage measure"]
    assert [span.name for span in spans if span.parent == second.id] == ["stage measure", "stage rest", "stage write"]


def test_failures_are_told_by_their_code_and_never_by_their_words(
    service: Running, collector: Collector, picture: bytes
) -> None:
    trace = Trace()
    file = uploaded(service, picture)
    job_id = submit(service, file, trace, options={"crash": "refuse"})
    assert service.until(job_id, "failed")["error"]["code"] == "no_face"
    refused = {"kind": "tiny", "inputs": {"image": file}, "options": {"private": "wish"}}
    assert service.client.post("/v1/jobs", json=refused, headers=trace.headers).status_code == 422
    spans = collector.until(lambda spans: len(spans) >= 4, "all was told of", trace.id)
    (whole,) = named(spans, "job tiny")
    assert whole.broke and whole.attributes["error.type"] == "no_face"
    (wrong,) = [span for span in spans if span.attributes.get("http.response.status_code") == 422]
    assert not wrong.broke, "the client's mistake is none of the service's"
    assert wrong.attributes["error.type"] == "invalid_options"
    exported = b"".join(collector.bodies)
    assert b"No face was found" not in exported and b"private" not in exported


def test_a_stage_that_was_under_way_breaks_off_with_its_job(
    service: Running, collector: Collector, picture: bytes
) -> None:
    trace = Trace()
    job_id = submit(service, uploaded(service, picture), trace, options={"seconds": 3000})
    service.until_at_rest(job_id)
    service.client.post(f"/v1/jobs/{job_id}/cancel").raise_for_status()
    spans = collector.until(lambda spans: named(spans, "job tiny") != [], "the attempt was told of", trace.id)
    (whole,), (rest,) = named(spans, "job tiny"), named(spans, "stage rest")
    assert whole.attributes["galatea.outcome"] == "lost" and not whole.broke, "it was canceled"
    assert rest.broke and rest.ended <= whole.ended


def test_a_stream_is_told_of_when_it_begins(service: Running, collector: Collector, picture: bytes) -> None:
    trace = Trace()
    job_id = submit(service, uploaded(service, picture), Trace(), options={"seconds": 3000})
    service.until_at_rest(job_id)
    with service.client.stream("GET", f"/v1/jobs/{job_id}/events?after=0", headers=trace.headers):
        (span,) = collector.until(lambda spans: spans != [], "the stream was told of", trace.id)
        assert span.name == "GET /v1/jobs/{job_id}/events"
        assert service.job(job_id)["status"] == "running"
    service.client.post(f"/v1/jobs/{job_id}/cancel").raise_for_status()


def test_addresses_are_told_by_their_template_and_probes_not_at_all(service: Running, collector: Collector) -> None:
    trace = Trace()
    token = secrets.token_urlsafe(16)
    for path in (f"/v1/public/{token}/{token}.mp4", f"/v1/jobs?cursor={token}", f"/{token}.js", "/healthz", "/readyz"):
        service.client.get(path, headers=trace.headers)
    service.client.request("BREW", "/v1/jobs", headers=trace.headers)
    spans = collector.until(lambda spans: len(spans) == 4, "all was told of", trace.id)
    assert [span.name for span in spans] == ["GET /v1/public/{token}/{name}", "GET /v1/jobs", "GET", "_OTHER /v1/jobs"]
    assert token.encode() not in b"".join(collector.bodies)


def test_a_client_that_keeps_no_trace_gets_none(service: Running, collector: Collector) -> None:
    unsampled, sampled = Trace(), Trace()
    unsampled.headers["traceparent"] = unsampled.headers["traceparent"].removesuffix("01") + "00"
    for trace in (unsampled, sampled):
        service.client.get("/v1/kinds", headers=trace.headers)
    collector.until(lambda spans: len(spans) == 1, "the other was told of", sampled.id)
    assert collector.of(unsampled.id) == []


@pytest.mark.parametrize("listens", [False, True], ids=["nobody", "one that never answers"])
def test_a_collector_that_is_away_holds_nothing_up(
    start: Callable[..., Running], picture: bytes, monkeypatch: pytest.MonkeyPatch, listens: bool
) -> None:
    monkeypatch.setenv("OTEL_BSP_SCHEDULE_DELAY", "200")
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        if listens:
            listening.listen()
        running = start(traces_url=f"http://127.0.0.1:{listening.getsockname()[1]}/v1/traces")
        trace = Trace()
        job_id = submit(running, uploaded(running, picture), trace)
        assert running.until(job_id, "succeeded")["error"] is None
        if not listens:
            eventually(lambda: "Failed to export spans" in running.output.read_text(), "the log says so")
        running.stop()
        assert running.process.returncode == 0
        assert "program_killed" not in running.output.read_text(), "the worker ended by itself"


def test_nothing_of_it_is_loaded_where_traces_are_off(tmp_path: Path) -> None:
    # FastAPI loads OpenTelemetry's API and redis-py a part of its SDK, whether or not anybody asks for traces.
    script = (
        "import sys\n"
        "from service.app import make_app\n"
        "from service.context import Context\n"
        "from service.settings import Settings\n"
        "from worker.app import Worker\n"
        "context = Context.open(Settings())\n"
        "make_app(context)\n"
        "print([name for name in sys.modules\n"
        "       if name.startswith(('opentelemetry.sdk.trace', 'opentelemetry.exporter', 'opentelemetry.proto'))])\n"
        "context.close()\n"
    )
    environment = {"GALATEA_DATA_DIR": str(tmp_path), "PYTHONPATH": str(ROOT), "GALATEA_TRACES_URL": ""}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.parametrize("given", ["order-4711", "A.b_c-" + "9" * 58])
def test_a_callers_request_id_comes_back(running: Running, given: str) -> None:
    answer = running.client.get("/v1/kinds", headers={"X-Request-Id": given})
    assert answer.headers.get_list("X-Request-Id") == [given]


@pytest.mark.parametrize("given", ["", "9" * 65, "two words", "a/b", "line\tbreak", "<script>", "\u00fc"])
def test_one_of_another_form_is_replaced(running: Running, given: str) -> None:
    answer = running.client.get("/v1/kinds", headers={"X-Request-Id": given.encode()})
    assert answer.status_code == 200
    (made,) = answer.headers.get_list("X-Request-Id")
    assert re.fullmatch("[A-Za-z0-9._-]{1,64}", made) and made != given


@pytest.mark.parametrize(
    ("path", "headers", "code"),
    [
        ("/v1/nothing", {}, 404),
        ("/v1/jobs", {"Host": "elsewhere.example"}, 403),
        ("/v1/jobs", {"Authorization": "Bearer galatea_no"}, 401),
        ("/v1/jobs?limit=0", {}, 422),
        ("/v1/jobs/x/y/z", {}, 404),
    ],
)
def test_problems_name_their_request(running: Running, path: str, headers: dict[str, str], code: int) -> None:
    answer = running.client.get(path, headers={**headers, "X-Request-Id": "r-1"})
    assert answer.status_code == code
    assert answer.headers["X-Request-Id"] == answer.json()["request_id"] == "r-1"


def test_where_traces_are_off_a_job_still_belongs_to_the_callers(start: Callable[..., Running], picture: bytes) -> None:
    running, trace = start(log_format="json", worker=False), Trace()
    with httpx.Client(base_url=running.client.base_url) as one_line:
        file = one_line.post("/v1/files", files={"file": ("a.png", picture)}).json()["id"]
        asked = {"kind": "tiny", "inputs": {"image": file}}
        one_line.post("/v1/jobs", json=asked, headers=trace.headers).raise_for_status()
        one_line.post("/v1/jobs", json=asked, headers={"traceparent": "nonsense"}).raise_for_status()
    first, second = [line for line in lines(running) if line["event"] == "job_accepted"]
    assert first["trace"] == trace.id and "trace" not in second
    running.stop()
    with closing(sqlite3.connect(running.data_dir / "galatea.db")) as database:
        kept = database.execute("SELECT request, trace FROM jobs ORDER BY id").fetchall()
    assert kept == [(first["request"], trace.headers["traceparent"]), (second["request"], None)]
