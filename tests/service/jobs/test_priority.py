"""Which job comes first."""

from __future__ import annotations

from collections.abc import Callable

from running import Running


def test_an_urgent_job_that_comes_last_runs_first(running: Running, picture: bytes) -> None:
    busy = running.job(running.rest(picture))
    asked = {"kind": "tiny", "inputs": busy["inputs"]}
    submitted = {
        name: running.client.post("/v1/jobs", json=asked | more).raise_for_status().json()
        for name, more in (("low", {"priority": "low"}), ("unsaid", {}), ("high", {"priority": "high"}))
    }
    assert [job["priority"] for job in submitted.values()] == ["low", "normal", "high"]
    running.client.post(f"/v1/jobs/{busy['id']}/cancel").raise_for_status()
    started = {name: running.until(job["id"], "succeeded")["started_at"] for name, job in submitted.items()}
    assert sorted(started, key=lambda name: started[name]) == ["high", "unsaid", "low"]
    again = running.client.post(f"/v1/jobs/{submitted['high']['id']}/revisions", json={"options": {"seconds": 0.1}})
    assert again.json()["priority"] == "high"
    wrong = running.client.post("/v1/jobs", json=asked | {"priority": "now"})
    assert (wrong.status_code, wrong.json()["code"]) == (422, "invalid_request")


def test_a_worker_serves_only_its_kinds(start: Callable[..., Running], picture: bytes) -> None:
    running = start(kinds="tiny_kind:KIND,tiny_kind:OTHER", worker_kinds="other")
    tiny = running.submit(picture)
    other = running.client.post("/v1/jobs", json={"kind": "other", "inputs": tiny["inputs"]}).json()
    running.until(other["id"], "succeeded")
    assert running.job(tiny["id"])["status"] == "queued"
