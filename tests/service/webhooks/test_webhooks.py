"""Webhooks through the API of a running service: endpoints, secrets, deliveries; what comes can be verified by others,
and nothing is lost when a worker is killed."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import httpx
import pytest
import standardwebhooks
from missing import missing
from receiver import OK, Receiver, status
from running import ROOT, Running, eventually

from service.ids import new_id

Receive = Callable[..., Receiver]


def problem(response: httpx.Response) -> tuple[int, str]:
    return response.status_code, response.json()["code"]


@pytest.fixture
def endpoint(running: Running) -> Iterator[Callable[..., dict[str, Any]]]:
    """`endpoint(url, events=...)` is one that is there until the test ends."""
    made: list[str] = []

    def make(url: str, **more: Any) -> dict[str, Any]:
        webhook = running.client.post("/v1/webhooks", json={"url": url, **more}).raise_for_status().json()
        made.append(webhook["id"])
        return webhook

    yield make
    for webhook_id in made:
        running.client.delete(f"/v1/webhooks/{webhook_id}")


def deliveries(running: Running, **wanted: Any) -> list[dict[str, Any]]:
    return running.client.get("/v1/webhooks/deliveries", params=wanted).raise_for_status().json()["items"]


def until_called(receiver: Receiver, times: int = 1) -> None:
    eventually(lambda: len(receiver.calls) >= times, f"there were {times} calls")


def test_an_endpoint_is_made_changed_and_erased(running: Running) -> None:
    response = running.client.post("/v1/webhooks", json={"url": "https://hooks.example.com/galatea"})
    assert response.status_code == 201
    made = response.json()
    assert response.headers["location"] == f"/v1/webhooks/{made['id']}"
    secret = made.pop("secret")
    assert secret.startswith("whsec_")
    assert made["events"] == ["job.succeeded", "job.failed", "job.canceled"]
    assert (made["enabled"], made["disabled"], made["failing_since"]) == (True, None, None)
    path = f"/v1/webhooks/{made['id']}"
    assert running.client.get(path).json() == made
    assert made in running.client.get("/v1/webhooks").json()["items"]
    assert running.client.get(f"{path}/secret").json() == {
        "secret": secret,
        "previous_secret": None,
        "previous_until": None,
    }
    events = ["job.progress", "job.failed", "job.failed"]
    change = {"description": "Mine", "events": events, "enabled": False}
    changed = running.client.patch(path, json=change).json()
    assert (changed["description"], changed["events"]) == ("Mine", ["job.failed", "job.progress"])
    assert (changed["enabled"], changed["disabled"]["code"], changed["url"]) == (False, "by_owner", made["url"])
    assert problem(running.client.post(f"{path}/test")) == (409, "webhook_disabled")
    assert running.client.delete(path).status_code == 204
    assert problem(running.client.get(path)) == (404, "webhook_not_found")


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"url": "http://hooks.example.com/x y"}, None),
        ({"url": "https://10.0.0.1/"}, "webhook_url_refused"),
        ({"url": "https://[::1]/"}, "webhook_url_refused"),
        ({"url": "https://169.254.169.254/latest/meta-data"}, "webhook_url_refused"),
        ({"description": "a\0b"}, "invalid_request"),
        ({"url": "https://user:word@hooks.example.com/"}, "webhook_url_refused"),
        ({"url": "ftp://hooks.example.com/"}, "webhook_url_refused"),
        ({"url": ""}, "invalid_request"),
        ({"url": "https://hooks.example.com/" + "x" * 2000}, "invalid_request"),
        ({"events": []}, "invalid_request"),
        ({"events": ["job.exploded"]}, "invalid_request"),
        ({"secret": "whsec_mine"}, "invalid_request"),
    ],
)
def test_what_an_endpoint_cannot_be(running: Running, change: dict[str, Any], code: str | None) -> None:
    response = running.client.post("/v1/webhooks", json={"url": "https://hooks.example.com/", **change})
    if code is None:
        running.client.delete(response.headers["location"]).raise_for_status()
    else:
        assert problem(response) == (422, code)


def test_a_job_s_end_comes_to_an_endpoint_and_can_be_looked_up(
    running: Running, picture: bytes, receive: Receive, endpoint: Callable
) -> None:
    receiver = receive()
    webhook = endpoint(receiver.url)
    job = running.until(running.submit(picture)["id"], "succeeded")
    until_called(receiver)
    call = receiver.calls[0]
    told = standardwebhooks.Webhook(webhook["secret"]).verify(call.body, call.headers)
    shown = running.job(job["id"])
    for document in (told["data"], shown):
        for artifact in document["artifacts"].values():
            artifact.pop("signed_url", None)
    assert told["data"] == shown, "it says what the API says"
    delivery_id = call.headers["webhook-id"]
    eventually(lambda: deliveries(running, job=job["id"])[0]["status"] == "delivered", "it is recorded")
    (listed,) = deliveries(running, webhook=webhook["id"], status="delivered", event="job.succeeded")
    assert (listed["id"], listed["job_id"], listed["url"]) == (delivery_id, job["id"], receiver.url)
    assert (listed["attempts"], listed["last_attempt"]["response_excerpt"]) == (1, "ok")
    one = running.client.get(f"/v1/webhooks/deliveries/{delivery_id}").json()
    assert {name: one[name] for name in listed} == listed
    assert one["data"]["id"] == job["id"] and len(one["history"]) == 1
    assert deliveries(running, webhook=webhook["id"], status=["pending", "failed"]) == []
    again = running.client.post(f"/v1/webhooks/deliveries/{delivery_id}/replay")
    assert (again.status_code, again.json()["status"]) == (202, "pending")
    until_called(receiver, 2)
    assert receiver.calls[1].headers["webhook-id"] == delivery_id
    running.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()
    assert problem(running.client.get(f"/v1/webhooks/deliveries/{delivery_id}")) == (404, "delivery_not_found")


def test_a_link_in_the_message_opens_without_a_key(
    running: Running, picture: bytes, receive: Receive, endpoint: Callable
) -> None:
    receiver = receive()
    endpoint(receiver.url)
    running.submit(picture)
    until_called(receiver)
    link = receiver.calls[0].json["data"]["artifacts"]["preview.jpg"]["signed_url"]
    assert running.client.get(link).content == picture


def test_an_endpoint_can_be_tried(running: Running, receive: Receive, endpoint: Callable) -> None:
    receiver = receive(answer=status(418, b"I am a teapot"))
    webhook = endpoint(receiver.url)
    response = running.client.post(f"/v1/webhooks/{webhook['id']}/test")
    assert response.status_code == 202
    path = response.headers["location"]
    eventually(lambda: running.client.get(path).json()["attempts"] == 1, "there was an attempt")
    attempt = running.client.get(path).json()["history"][0]
    assert (attempt["response_status"], attempt["response_excerpt"]) == (418, "I am a teapot")
    assert attempt["error"] == {"code": "refused", "detail": "It answered 418."}
    assert receiver.calls[0].json["type"] == "webhook.test"
    assert running.client.get(f"/v1/webhooks/{webhook['id']}").json()["failing_since"] is not None


@pytest.mark.parametrize("form", [False, True])
def test_a_job_may_name_an_address_itself(running: Running, picture: bytes, receive: Receive, form: bool) -> None:
    receiver = receive()
    if form:
        fields = {"kind": "tiny", "webhook_url": receiver.url, "webhook_events": '["job.succeeded", "job.progress"]'}
        fields["options"] = '{"seconds": 1}'
        response = running.client.post("/v1/jobs", data=fields, files={"image": picture})
    else:
        file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
        asked = {"kind": "tiny", "inputs": {"image": file}, "webhook_url": receiver.url}
        response = running.client.post("/v1/jobs", json=asked)
    job = running.until(response.raise_for_status().json()["id"], "succeeded")
    secret = running.client.get("/v1/key").json()["signing_secret"]

    def told() -> list[str]:
        verify = standardwebhooks.Webhook(secret).verify
        return [verify(call.body, call.headers)["type"] for call in receiver.calls]

    eventually(lambda: "job.succeeded" in told(), "its end was told")
    assert ("job.progress" in told()) == form
    listed = deliveries(running, job=job["id"])
    assert {one["webhook_id"] for one in listed} == {None}


def test_a_revision_tells_the_same_address(running: Running, picture: bytes, receive: Receive) -> None:
    first, second = receive(), receive()
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file}, "webhook_url": first.url}
    job = running.client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=30"}).json()
    running.client.post(f"/v1/jobs/{job['id']}/revisions", json={}).raise_for_status()
    until_called(first, 2)
    running.client.post(f"/v1/jobs/{job['id']}/revisions", json={"webhook_url": second.url}).raise_for_status()
    until_called(second)
    assert len(first.calls) == 2


@pytest.mark.parametrize(
    ("more", "code"),
    [
        ({"webhook_url": "https://192.168.1.1/"}, "webhook_url_refused"),
        ({"webhook_url": "nonsense"}, "webhook_url_refused"),
        ({"webhook_events": ["job.failed"]}, "webhook_url_missing"),
        ({"webhook_url": "https://example.com/", "webhook_events": ["webhook.test"]}, "invalid_request"),
    ],
)
def test_what_a_job_cannot_name(running: Running, picture: bytes, more: dict[str, Any], code: str) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    response = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": file}, **more})
    assert problem(response) == (422, code)


def test_two_secrets_live_after_a_rotation(running: Running, receive: Receive, endpoint: Callable) -> None:
    receiver = receive()
    webhook = endpoint(receiver.url)
    path = f"/v1/webhooks/{webhook['id']}"
    rotated = running.client.post(f"{path}/secret/rotate", json={"overlap_hours": 2}).json()
    assert rotated["previous_secret"] == webhook["secret"] != rotated["secret"]
    assert running.client.get(f"{path}/secret").json() == rotated
    running.client.post(f"{path}/test").raise_for_status()
    until_called(receiver)
    for secret in (webhook["secret"], rotated["secret"]):
        assert standardwebhooks.Webhook(secret).verify(receiver.calls[0].body, receiver.calls[0].headers)
    at_once = running.client.post(f"{path}/secret/rotate", json={"overlap_hours": 0}).json()
    assert at_once["previous_secret"] is None
    assert running.client.post(f"{path}/secret/rotate").status_code == 200, "a day, if nothing is said"
    assert problem(running.client.post(f"{path}/secret/rotate", json={"overlap_hours": -1})) == (422, "invalid_request")


def test_the_list_of_deliveries_has_pages(running: Running, receive: Receive, endpoint: Callable) -> None:
    receiver = receive()
    webhook = endpoint(receiver.url)
    sent = [running.client.post(f"/v1/webhooks/{webhook['id']}/test").json()["id"] for _ in range(5)]
    until_called(receiver, 5)
    pages, link = [], f"/v1/webhooks/deliveries?webhook={webhook['id']}&limit=2"
    while link:
        response = running.client.get(link).raise_for_status()
        pages.append([one["id"] for one in response.json()["items"]])
        link = response.links.get("next", {}).get("url")
    assert pages == [sent[:2:-1], sent[2:0:-1], sent[:1]]
    bad = running.client.get("/v1/webhooks/deliveries", params={"cursor": "x"})
    assert problem(bad) == (422, "invalid_cursor")


def test_what_belongs_to_another_key_is_not_there(running: Running, receive: Receive, endpoint: Callable) -> None:
    webhook = endpoint(receive().url)
    sent = running.client.post(f"/v1/webhooks/{webhook['id']}/test").json()["id"]
    key = running.client.post("/v1/keys", json={"name": "other", "scopes": ["read", "submit"]}).json()
    reader = running.client.post("/v1/keys", json={"name": "reader", "scopes": ["read"]}).json()
    theirs = {"Authorization": f"Bearer {key['token']}"}
    assert running.client.get("/v1/webhooks", headers=theirs).json()["items"] == []
    assert running.client.get("/v1/webhooks/deliveries", headers=theirs).json()["items"] == []
    path = f"/v1/webhooks/{webhook['id']}"
    for method, address in [
        *(("GET", path), ("PATCH", path), ("DELETE", path), ("GET", f"{path}/secret"), ("POST", f"{path}/test")),
        *(("POST", f"{path}/secret/rotate"), ("GET", f"/v1/webhooks/deliveries/{sent}")),
        ("POST", f"/v1/webhooks/deliveries/{sent}/replay"),
    ]:
        body = {"json": {}} if method == "PATCH" else {}
        assert running.client.request(method, address, headers=theirs, **body).status_code == 404, address
    looking = {"Authorization": f"Bearer {reader['token']}"}
    assert running.client.get("/v1/webhooks", headers=looking).status_code == 200
    refused = running.client.post("/v1/webhooks", json={"url": "https://x.example.com/"}, headers=looking)
    assert problem(refused) == (403, "scope_missing")
    assert running.client.get(path).status_code == 200, "it is still there for its owner"


@pytest.fixture
def node(tmp_path: Path) -> Callable[[str, str], str]:
    """`node(script, text)` is what a script prints that may use the page's packages and reads the text."""
    packages = ROOT / "web" / "node_modules"
    if not (packages / "standardwebhooks").is_dir():
        message = "the page's packages are not installed (make setup)"
        missing(message)
    (tmp_path / "node_modules").symlink_to(packages)

    def run(script: str, text: str) -> str:
        (tmp_path / "script.mjs").write_text(script)
        done = subprocess.run(
            ["node", "script.mjs"], cwd=tmp_path, input=text, capture_output=True, text=True, timeout=60
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def test_the_public_library_in_javascript_accepts_it(
    running: Running, picture: bytes, receive: Receive, endpoint: Callable, node: Callable[[str, str], str]
) -> None:
    """Both secrets after a rotation; not another secret, nor another body."""
    receiver = receive()
    old = endpoint(receiver.url)
    new = running.client.post(f"/v1/webhooks/{old['id']}/secret/rotate").json()
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {
        "kind": "tiny",
        "inputs": {"image": file},
        "metadata": {"name": "Gälätea ✓ \ud83d\ude00"},
    }
    running.client.post("/v1/jobs", content=json.dumps(asked), headers={"Content-Type": "application/json"})
    until_called(receiver)
    call = receiver.calls[0]
    other = "whsec_" + "A" * 43 + "="
    text = json.dumps(
        {
            "secrets": [old["secret"], new["secret"], other],
            "headers": call.headers,
            "bodies": [call.body, call.body + " "],
        }
    )
    script = """
        import { readFileSync } from 'node:fs';
        import { Webhook } from 'standardwebhooks';
        const { secrets, headers, bodies } = JSON.parse(readFileSync(0, 'utf8'));
        const verdicts = secrets.map((secret) => bodies.map((body) => {
            try { return new Webhook(secret).verify(body, headers).type } catch (error) { return error.message }
        }));
        console.log(JSON.stringify(verdicts));
    """
    good, bad = "job.succeeded", "No matching signature found"
    assert json.loads(node(script, text)) == [[good, bad], [good, bad], [bad, bad]]


def test_a_worker_killed_in_mid_delivery_loses_nothing(
    start: Callable[..., Running], picture: bytes, receive: Receive
) -> None:
    """It dies after the message was sent and before that was recorded: the message comes again."""
    running = start(allowed_networks="127.0.0.0/8", webhook_seconds=2)

    def kill(request: BaseHTTPRequestHandler) -> None:
        receiver.answer = OK
        running.processes("shell.main worker")[0].kill()
        OK(request)

    receiver = receive(answer=kill)
    running.client.post("/v1/webhooks", json={"url": receiver.url}).raise_for_status()
    job = running.submit(picture)
    running.until(job["id"], "succeeded")
    until_called(receiver, 2)
    assert len({call.headers["webhook-id"] for call in receiver.calls}) == 1
    eventually(lambda: deliveries(running)[0]["status"] == "delivered", "it is recorded")


def test_what_was_to_be_told_is_told_after_everything_was_killed(
    start: Callable[..., Running], picture: bytes, receive: Receive
) -> None:
    receiver = receive(answer=status(500))
    running = start(allowed_networks="127.0.0.0/8", webhook_seconds=2)
    running.client.post("/v1/webhooks", json={"url": receiver.url}).raise_for_status()
    jobs = [running.submit(picture)["id"] for _ in range(3)]
    until_called(receiver)
    running.process.kill()
    running.process.wait()
    receiver.answer = OK
    running.client.close()
    running.start()
    for job in jobs:
        running.until(job, "succeeded")

    def told() -> set[str]:
        return {one["job_id"] for one in deliveries(running, status="delivered")}

    eventually(lambda: told() == set(jobs), "all were told")
    assert {call.json["data"]["id"] for call in receiver.calls} == set(jobs)


def test_how_late_webhooks_are_can_be_read(running: Running, receive: Receive, endpoint: Callable) -> None:
    def figures() -> str:
        return running.client.get("/metrics").text

    receiver = receive()
    webhook = endpoint(receiver.url)
    running.client.post(f"/v1/webhooks/{webhook['id']}/test").raise_for_status()
    counted = 'galatea_webhook_attempts_total{event="webhook.test",outcome="delivered"}'
    eventually(lambda: counted in figures(), "it was counted")
    for name in ("galatea_webhook_lag_seconds", "galatea_webhook_oldest_seconds", "galatea_webhooks_pending"):
        assert f"\n{name} " in figures()
    assert 'galatea_webhook_seconds_total{event="webhook.test"}' in figures()


def test_ids_that_never_were(running: Running) -> None:
    for path in (
        f"/v1/webhooks/{new_id()}",
        f"/v1/webhooks/deliveries/{new_id()}",
        "/v1/webhooks/x",
        "/v1/webhooks/%00",
    ):
        assert running.client.get(path).status_code == 404
