"""Whether the service lives, and its figures, for machines that watch."""

from __future__ import annotations

import json
import re
from collections.abc import Callable

from running import ROOT, Running, eventually


def figure(running: Running, name: str) -> float:
    """A figure by its name and labels."""
    found = re.search(rf"^{re.escape(name)} (\S+)$", running.client.get("/metrics").text, re.MULTILINE)
    return float(found[1]) if found else float("nan")


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
