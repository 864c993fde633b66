"""Following a job by server-sent events."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from running import Running


def follow(running: Running, job_id: str, **headers: str) -> Iterator[dict[str, Any]]:
    """The events of a stream: `{"id", "event", "data"}`."""
    headers = {name.replace("_", "-"): value for name, value in headers.items()}
    with running.client.stream("GET", f"/v1/jobs/{job_id}/events", headers=headers) as response:
        assert response.status_code == 200
        assert response.headers["content-type"].startswith("text/event-stream")
        event: dict[str, Any] = {}
        for line in response.iter_lines():
            if not line:
                if event:
                    yield event | {"data": json.loads(event["data"])}
                event = {}
            elif not line.startswith(":"):
                name, _, value = line.partition(": ")
                event[name] = value


def test_events_come_while_the_job_runs_and_end_with_it(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=1.5)
    events = list(follow(running, job["id"]))
    assert [e["data"]["status"] for e in events if e["event"] == "status"] == ["queued", "running", "succeeded"]
    assert events[-1]["data"] == {"status": "succeeded"}
    fractions = [e["data"]["fraction"] for e in events if e["event"] == "progress"]
    assert fractions == sorted(fractions) and len(fractions) > 2
    names = [e["data"]["name"] for e in events if e["event"] == "artifact"]
    assert names[0] == "preview.jpg" and set(names) == set(running.job(job["id"])["artifacts"])
    ids = [int(e["id"]) for e in events]
    assert ids == sorted(set(ids))


def test_a_stream_resumes_after_the_last_event_and_then_says_that_there_is_no_more(
    running: Running, picture: bytes
) -> None:
    job = running.submit(picture, seconds=0.5)
    all_of_them = list(follow(running, job["id"]))
    for place in (0, len(all_of_them) // 2, len(all_of_them) - 2):
        assert list(follow(running, job["id"], Last_Event_ID=all_of_them[place]["id"])) == all_of_them[place + 1 :]
    last = all_of_them[-1]["id"]
    assert running.client.get(f"/v1/jobs/{job['id']}/events", headers={"Last-Event-ID": last}).status_code == 204
    assert running.client.get(f"/v1/jobs/{job['id']}/events", params={"after": last}).status_code == 204


def test_a_connection_that_broke_misses_nothing(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=2)
    seen = []
    for event in follow(running, job["id"]):
        seen.append(event)
        if event["event"] == "progress":
            break
    seen += follow(running, job["id"], Last_Event_ID=seen[-1]["id"])
    assert seen == list(follow(running, job["id"]))


def test_wrong_addresses_and_ids_are_problems(running: Running, picture: bytes) -> None:
    job = running.submit(picture)
    assert running.client.get("/v1/jobs/nope/events").json()["code"] == "job_not_found"
    for wrong in ("x", "-1", "1" * 30):
        response = running.client.get(f"/v1/jobs/{job['id']}/events", headers={"Last-Event-ID": wrong})
        assert (response.status_code, response.json()["code"]) == (422, "invalid_event_id")


def test_a_canceled_job_ends_its_stream(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=3000)
    for event in follow(running, job["id"]):  # they come as they happen, not all at the end
        if event["event"] == "progress":
            running.client.post(f"/v1/jobs/{job['id']}/cancel").raise_for_status()
    assert event["data"] == {"status": "canceled"}
