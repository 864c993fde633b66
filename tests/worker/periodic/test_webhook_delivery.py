"""The delivery of webhooks in simulated time, to receivers that behave well and badly."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from datetime import UTC, datetime, timedelta
from email.utils import format_datetime
from http.server import BaseHTTPRequestHandler
from ipaddress import ip_network
from pathlib import Path
from random import Random
from typing import Any

import pytest
import standardwebhooks
from newest_tables import lay_out_data_folder
from receiver import OK, Receiver, status
from servers import PostgresServer
from sqlalchemy import func, select

from service.clock import now
from service.context import Context
from service.events import repository as events
from service.ids import new_id
from service.job_records import jobs as repository
from service.jobs import leases
from service.jobs.leases import Lease
from service.problems import Problem
from service.settings import Settings
from service.tables.artifacts import Artifact
from service.tables.jobs import Job
from service.tables.keys import LOCAL_KEY_ID, Key
from service.tables.webhooks import Delivery, DeliveryAttempt, EventType, Webhook
from service.webhooks import delivery_lease, outbox, service
from service.webhooks import repository as webhooks
from service.webhooks.schedule import RETRY_DELAYS, retry_delay
from service.webhooks.schemas import WebhookIn
from worker.periodic.housekeeping import forget_old_deliveries
from worker.periodic.webhook_sender import WebhookSender

Receive = Callable[..., Receiver]
LOOPBACK = [ip_network("127.0.0.0/8")]
SECOND, HOUR, DAY = timedelta(seconds=1), timedelta(hours=1), timedelta(days=1)


ON_ANY = pytest.mark.parametrize("context", ["sqlite", "postgresql"], indirect=True)


@pytest.fixture
def context(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Context]:
    """A context that may call receivers on loopback, and gives them two seconds."""
    url = None
    if getattr(request, "param", "sqlite") == "postgresql":
        server: PostgresServer = request.getfixturevalue("postgres")
        url = server.new_database(like=request.getfixturevalue("newest_on_postgres"))
    else:
        lay_out_data_folder(tmp_path / "data")
    settings = Settings(
        **{
            "data_dir": tmp_path / "data",
            "database_url": url,
            "kinds": [],
            "disk_reserve_mb": 0,
            "allowed_networks": LOOPBACK,
        },
        **{"webhook_seconds": 2, "webhook_concurrency": 4, "public_url": "https://galatea.example/"},
    )
    opened = Context.open(settings)
    yield opened
    opened.close()


@pytest.fixture
def sender(context: Context) -> Iterator[WebhookSender]:
    made = WebhookSender(context)
    yield made
    made.close()


def endpoint(context: Context, url: str, *types: EventType) -> Webhook:
    asked = WebhookIn(url=url, **({"events": list(types)} if types else {}))
    with context.database.write() as session:
        return service.create(session, LOCAL_KEY_ID, asked, LOOPBACK)


def begun(context: Context, **more: Any) -> Lease:
    """A job that runs."""
    job = Job(
        id=new_id(),
        owner=LOCAL_KEY_ID,
        **{"kind": "tiny", "status": "queued", "inputs": {}, "sources": {}, "options": {}, "notes": {"order": 7}},
        **{"progress": {}, "created_at": now(), "enqueued_at": now(), **more},
    )
    with context.database.write() as session:
        session.add(job)
        session.flush()
        lease = leases.claim(session, job.id, "somebody", 30)
    assert lease is not None
    return lease


def succeeded(context: Context, **more: Any) -> str:
    """A job that has succeeded with one artifact; its id."""
    lease = begun(context, **more)
    artifact = {"content_type": "image/jpeg", "size": 3, "sha256": "0" * 64, "created_at": now()}
    with context.database.write() as session:
        session.add(Artifact(id=new_id(), job_id=lease.job_id, name="poster.jpg", **artifact))
        assert leases.succeed(session, lease)
    return lease.job_id


def deliver(sender: WebhookSender, moment: datetime | None = None) -> None:
    """Make the attempts that are due now, or at a moment, all of them."""
    while attempts := sender.look(moment):
        wait(attempts)


def deliveries(context: Context) -> list[Delivery]:
    """All deliveries, oldest first."""
    with context.database.read() as session:
        return list(session.scalars(select(Delivery).order_by(Delivery.id)))


def attempts(context: Context, delivery: Delivery) -> list[DeliveryAttempt]:
    with context.database.read() as session:
        return webhooks.attempts(session, [delivery.id])[delivery.id]


def reload(context: Context, webhook: Webhook) -> Webhook:
    with context.database.read() as session:
        return session.get_one(Webhook, webhook.id)


def through_all_tries(context: Context, sender: WebhookSender, moment: datetime) -> datetime:
    """Go from attempt to attempt until nothing is to be tried any more; the moment of the last."""
    while True:
        deliver(sender, moment)
        following = [delivery.next_attempt_at for delivery in deliveries(context) if delivery.next_attempt_at]
        if not following:
            return moment
        moment = max(min(following), moment)


@ON_ANY
def test_a_job_s_end_is_told_signed(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive()
    webhook = endpoint(context, receiver.url)
    job_id = succeeded(context)
    deliver(sender, now())
    (call,) = receiver.calls
    told = standardwebhooks.Webhook(webhook.secret.reveal()).verify(call.body, call.headers)
    assert call.headers["content-type"] == "application/json"
    assert call.headers["user-agent"].startswith("Galatea/")
    assert told["type"] == "job.succeeded"
    data = told["data"]
    assert (data["id"], data["status"], data["metadata"]) == (job_id, "succeeded", {"order": 7})
    with context.database.read() as session:
        assert told["timestamp"][:19] == repository.get(session, job_id).finished_at.isoformat()[:19]
        last = events.events_after(session, job_id, 0)[-1]
    assert told["sequence"] == last.id
    poster = data["artifacts"]["poster.jpg"]
    assert poster["url"] == f"https://galatea.example/v1/jobs/{job_id}/artifacts/poster.jpg"
    assert poster["signed_url"].startswith(poster["url"] + "?expires=")
    (delivery,) = deliveries(context)
    assert (delivery.id, delivery.status, delivery.next_attempt_at) == (call.headers["webhook-id"], "delivered", None)
    (attempt,) = attempts(context, delivery)
    assert (attempt.response_status, attempt.response_excerpt, attempt.error_code) == (200, "ok", None)
    with pytest.raises(standardwebhooks.WebhookVerificationError):
        standardwebhooks.Webhook(webhook.secret.reveal()).verify(call.body.replace("succeeded", "failed"), call.headers)


def test_every_way_to_end_is_told_and_no_other_event(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive()
    endpoint(context, receiver.url)
    succeeded(context)
    failed, canceled, exhausted = begun(context), begun(context), begun(context, fruitless_attempts=2)
    with context.database.write() as session:
        leases.report_progress(session, failed, {"stage": "x", "fraction": 0.5})
        leases.fail(session, failed, "no_face", "No face.")
        leases.cancel(session, canceled.job_id)
        leases.give_back(session, exhausted, "it died")
    deliver(sender, now())
    told = {(call.json["type"], (call.json["data"]["error"] or {}).get("code")) for call in receiver.calls}
    assert told == {
        ("job.succeeded", None),
        ("job.failed", "no_face"),
        ("job.canceled", None),
        ("job.failed", "attempts_exhausted"),
    }
    assert len(receiver.calls) == 4


def test_only_what_became_true_is_told(context: Context, receive: Receive) -> None:
    endpoint(context, receive().url)
    lease = begun(context)
    with pytest.raises(ZeroDivisionError), context.database.write() as session:
        leases.succeed(session, lease)
        _ = 1 / 0
    assert deliveries(context) == []


def test_a_receiver_that_fails_for_an_hour_gets_it_afterwards(
    context: Context, sender: WebhookSender, receive: Receive
) -> None:
    receiver = receive(answer=status(500, b"down"))
    endpoint(context, receiver.url)
    succeeded(context)
    start = moment = now()
    times = []
    while (delivery := deliveries(context)[0]).status == "pending":
        assert delivery.next_attempt_at is not None
        moment = max(moment, delivery.next_attempt_at)
        if moment - start > HOUR:
            receiver.answer = OK
        deliver(sender, moment)
        times.append((moment - start).total_seconds())
    assert delivery.status == "delivered"
    expected = [0, 5, 305, 2105, 9305]
    assert all(planned <= t <= planned * 1.1 + 1 for t, planned in zip(times, expected, strict=True)), times
    ids, stamps = ([call.headers[name] for call in receiver.calls] for name in ("webhook-id", "webhook-timestamp"))
    assert len(set(ids)) == 1
    assert [int(stamp) for stamp in stamps] == sorted(int(stamp) for stamp in stamps) and len(set(stamps)) == 5
    statuses = [attempt.response_status for attempt in attempts(context, delivery)]
    assert statuses == [500, 500, 500, 500, 200]
    assert attempts(context, delivery)[0].error_detail == "It answered 500."


@ON_ANY
def test_an_endpoint_that_fails_for_days_is_disabled(context: Context, sender: WebhookSender, receive: Receive) -> None:
    """Three messages given up are not enough within five days, nor five days of one message."""
    receiver = receive(answer=status(503))
    webhook = endpoint(context, receiver.url)
    for _ in range(3):
        succeeded(context)
    start = now()
    end = through_all_tries(context, sender, start)
    assert sum(RETRY_DELAYS, timedelta(0)) <= end - start < 4 * DAY
    assert [(delivery.status, len(attempts(context, delivery))) for delivery in deliveries(context)] == [
        ("failed", 10)
    ] * 3
    after = reload(context, webhook)
    assert after.enabled and after.given_up == 3 and after.failing_since is not None
    succeeded(context)
    deliver(sender, start + 5 * DAY - HOUR)
    assert reload(context, webhook).enabled
    deliver(sender, start + 5 * DAY + HOUR)
    after = reload(context, webhook)
    assert (after.enabled, after.disabled_code) == (False, "failing")
    held = deliveries(context)[-1]
    assert held.status == "pending"
    receiver.answer = OK
    deliver(sender, start + 9 * DAY)
    assert deliveries(context)[-1].status == "pending", "a disabled endpoint is left alone"
    with context.database.write() as session:
        service.change(session, LOCAL_KEY_ID, webhook.id, service.WebhookChange(enabled=True), LOOPBACK)
    deliver(sender, start + 9 * DAY)
    assert deliveries(context)[-1].status == "delivered"


def test_one_success_ends_the_count(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive(answer=status(500))
    webhook = endpoint(context, receiver.url)
    succeeded(context)
    deliver(sender, now())
    assert reload(context, webhook).failing_since is not None
    receiver.answer = OK
    succeeded(context)
    deliver(sender, now())
    after = reload(context, webhook)
    assert (after.failing_since, after.given_up) == (None, 0)


def test_410_disables_at_once(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive(answer=status(410, b"bye"))
    webhook = endpoint(context, receiver.url)
    succeeded(context)
    deliver(sender, now())
    after = reload(context, webhook)
    assert (after.enabled, after.disabled_code) == (False, "gone")
    (delivery,) = deliveries(context)
    assert (delivery.status, delivery.next_attempt_at) == ("failed", None)
    succeeded(context)
    assert len(deliveries(context)) == 1, "nothing more is written for it"


@ON_ANY
def test_410_ends_all_for_an_address_of_a_job(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive(answer=status(500))
    lease = begun(context, webhook_url=receiver.url, webhook_events=["job.progress", "job.succeeded"])
    moment = now()
    with context.database.write() as session:
        leases.report_progress(session, lease, {"stage": "x", "fraction": 0.5})
    deliver(sender, moment)
    assert [delivery.status for delivery in deliveries(context)] == ["pending"], "it is to be tried again"
    receiver.answer = status(410)
    with context.database.write() as session:
        leases.succeed(session, lease)
    deliver(sender, moment)
    assert [delivery.status for delivery in deliveries(context)] == ["failed", "failed"]
    deliver(sender, moment + DAY)
    assert len(receiver.calls) == 2, "what waited is not told any more"


def test_the_address_of_a_job_is_signed_with_the_key_s_secret(
    context: Context, sender: WebhookSender, receive: Receive
) -> None:
    receiver = receive()
    succeeded(context, webhook_url=receiver.url)
    deliver(sender, now())
    with context.database.read() as session:
        secret = session.get_one(Key, LOCAL_KEY_ID).signing_secret.reveal()
    (call,) = receiver.calls
    assert standardwebhooks.Webhook(secret).verify(call.body, call.headers)["type"] == "job.succeeded"
    assert deliveries(context)[0].webhook_id is None


def test_two_secrets_sign_until_the_old_one_expires(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive()
    webhook = endpoint(context, receiver.url)
    with context.database.write() as session:
        rotated = service.rotate(session, LOCAL_KEY_ID, webhook.id, HOUR)
    assert rotated.secret != webhook.secret
    succeeded(context)
    deliver(sender, now())
    call = receiver.calls[-1]
    assert len(call.headers["webhook-signature"].split(" ")) == 2
    for secret in (webhook.secret, rotated.secret):
        assert standardwebhooks.Webhook(secret.reveal()).verify(call.body, call.headers)
    succeeded(context)
    deliver(sender, now() + 2 * HOUR)
    assert len(receiver.calls[-1].headers["webhook-signature"].split(" ")) == 1


def silent(request: BaseHTTPRequestHandler) -> None:
    time.sleep(20)


def hanging_up(request: BaseHTTPRequestHandler) -> None:
    request.connection.close()


def endless(request: BaseHTTPRequestHandler) -> None:
    request.send_response(200)
    request.end_headers()
    while True:
        request.wfile.write(b"x" * 100_000)


def dripping(request: BaseHTTPRequestHandler) -> None:
    request.send_response(200)
    request.end_headers()
    for _ in range(100):
        request.wfile.write(b"x")
        time.sleep(0.2)


@pytest.mark.parametrize(
    ("answer", "code", "response_status", "detail"),
    [
        (status(404, b"what?"), "refused", 404, "It answered 404."),
        (status(302, Location="http://127.0.0.1:9/"), "redirect", 302, "redirects are not followed"),
        (silent, "timeout", None, "did not answer in time"),
        (hanging_up, "unreachable", None, "ended the connection"),
        (endless, None, 200, None),
        (dripping, None, 200, None),
        (status(204), None, 204, None),
        (status(200, b"\xff\0" + "ü".encode() * 1000), None, 200, None),
    ],
    ids=["404", "redirect", "silent", "hanging_up", "endless", "dripping", "204", "binary"],
)
def test_what_a_receiver_did_can_be_read(
    context: Context,
    sender: WebhookSender,
    receive: Receive,
    answer: Callable,
    code: str | None,
    response_status: int | None,
    detail: str | None,
) -> None:
    receiver = receive(answer=answer)
    endpoint(context, receiver.url)
    succeeded(context)
    wait(sender.look(now()))
    (delivery,) = deliveries(context)
    (attempt,) = attempts(context, delivery)
    assert delivery.status == ("delivered" if code is None else "pending")
    assert (attempt.error_code, attempt.response_status) == (code, response_status)
    assert detail is None or detail in (attempt.error_detail or "")
    assert len(attempt.response_excerpt) <= 1024
    assert len(receiver.calls) == 1


def test_nobody_there(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive()
    receiver.close()
    endpoint(context, receiver.url)
    succeeded(context)
    wait(sender.look(now()))
    assert attempts(context, deliveries(context)[0])[0].error_code == "unreachable"


@pytest.mark.parametrize(
    ("header", "least", "most"),
    [("120", 120, 122), ("1", 5, 7), ("99999999999", 86_400, 86_402), ("soon", 5, 7), ("DATE", 598, 602)],
)
def test_what_the_receiver_asks_for_makes_the_pause_longer(
    context: Context, sender: WebhookSender, receive: Receive, header: str, least: float, most: float
) -> None:
    moment = now()
    if header == "DATE":
        header = format_datetime((moment + 600 * SECOND).astimezone(UTC), usegmt=True)
    receiver = receive(answer=status(429, Retry_After=header))
    endpoint(context, receiver.url)
    succeeded(context)
    wait(sender.look(now()))
    following = deliveries(context)[0].next_attempt_at
    assert following is not None
    assert least - 1 <= (following - moment).total_seconds() <= most + 2


def test_pauses_grow_and_end() -> None:
    chance = Random(1)
    pauses = [retry_delay("job.failed", tries, None, chance) for tries in range(1, 11)]
    assert pauses[-1] is None
    for found, planned in zip(pauses, RETRY_DELAYS, strict=False):
        assert found is not None and planned <= found <= planned * 1.1
    assert [retry_delay("job.progress", tries, None, chance) is None for tries in (1, 2, 3)] == [False, False, True]


def test_a_private_address_is_not_called(tmp_path: Path, receive: Receive, names: dict[str, list[list[str]]]) -> None:
    """Also where the name led elsewhere when it was last looked up, and where an earlier setting had allowed it."""
    receiver = receive()
    context = Context.open(Settings(data_dir=tmp_path, kinds=[], disk_reserve_mb=0, webhook_seconds=2))
    names["hooks.example"] = [["127.0.0.1"], ["10.0.0.1", "169.254.169.254"]]
    for url in (receiver.url, f"https://hooks.example:{receiver.port}/", "https://hooks.example/"):
        endpoint(context, url)
    succeeded(context)
    deliver(WebhookSender(context), now())
    for delivery in deliveries(context):
        (attempt,) = attempts(context, delivery)
        assert attempt.error_code == "address_refused"
        assert "GALATEA_ALLOWED_NETWORKS" in (attempt.error_detail or "")
    assert receiver.calls == []
    context.close()


@ON_ANY
def test_many_workers_send_each_message_once(context: Context, receive: Receive) -> None:
    receiver = receive()
    endpoint(context, receiver.url)
    for _ in range(30):
        succeeded(context)
    senders = [WebhookSender(context) for _ in range(3)]
    with ThreadPoolExecutor(3) as pool:
        list(pool.map(deliver, senders))
    while any(delivery.status == "pending" for delivery in deliveries(context)):
        deliver(senders[0])
    ids = [call.headers["webhook-id"] for call in receiver.calls]
    assert len(ids) == len(set(ids)) == 30


@ON_ANY
def test_what_a_dead_worker_had_claimed_is_sent_by_another(
    context: Context, sender: WebhookSender, receive: Receive
) -> None:
    receiver = receive()
    endpoint(context, receiver.url)
    succeeded(context)
    moment = now()
    with context.database.write() as session:
        dead = delivery_lease.claim(session, context.settings, moment)
        assert dead is not None
        assert delivery_lease.claim(session, context.settings, moment) is None, "not twice at the same time"
    lease = 2 * context.settings.webhook_seconds * SECOND
    deliver(sender, moment + lease - SECOND)
    assert receiver.calls == []
    deliver(sender, moment + lease)
    assert len(receiver.calls) == 1
    with context.database.write() as session:
        late = delivery_lease.Outcome(1.0, code="refused", detail="too late")
        assert not delivery_lease.settle(session, dead, late, moment + HOUR, Random(1))
    assert deliveries(context)[0].status == "delivered"
    assert len(attempts(context, deliveries(context)[0])) == 1


def test_a_clock_that_is_set_back_delays_nothing(context: Context, sender: WebhookSender, receive: Receive) -> None:
    """It was two days ahead for a while: then something was written, something failed, something was claimed."""
    receiver = receive(answer=status(500))
    endpoint(context, receiver.url)
    ahead = now() + 2 * DAY
    succeeded(context)
    wait(sender.look(ahead))
    succeeded(context)
    with context.database.write() as session:
        assert delivery_lease.claim(session, context.settings, ahead) is not None
    succeeded(context)
    with context.database.write() as session:
        session.get_one(Delivery, deliveries(context)[-1].id).next_attempt_at = ahead
    receiver.answer = OK
    deliver(sender, now())
    assert [delivery.status for delivery in deliveries(context)] == ["delivered"] * 3


def test_there_are_not_endlessly_many_endpoints(context: Context) -> None:
    for number in range(service.MAX_ENDPOINTS):
        endpoint(context, f"https://h{number}.example.com/")
    with pytest.raises(Problem, match="too_many_webhooks"):
        endpoint(context, "https://one-too-many.example.com/")


def test_a_slow_receiver_holds_up_nobody_else(context: Context, sender: WebhookSender, receive: Receive) -> None:
    go_on = threading.Event()
    slow, quick = receive("127.0.0.1", lambda request: (go_on.wait(60), OK(request))), receive("127.0.0.2")
    endpoint(context, slow.url)
    for _ in range(10):
        succeeded(context)
    endpoint(context, quick.url)
    job_id = succeeded(context)
    going_on = sender.look(now())
    assert len(going_on) == 3, "half of the places for the one, a place for the other"
    deadline = time.monotonic() + 60
    while not quick.calls and time.monotonic() < deadline:
        time.sleep(0.01)
    assert [call.json["data"]["id"] for call in quick.calls] == [job_id]
    assert all(delivery.status == "pending" for delivery in deliveries(context) if delivery.host == "127.0.0.1")
    go_on.set()
    deliver(sender, now())
    assert len(slow.calls) == 11


@ON_ANY
def test_progress_is_told_on_request_and_not_too_often(
    context: Context, sender: WebhookSender, receive: Receive
) -> None:
    plain, keen = receive(), receive()
    endpoint(context, plain.url)
    endpoint(context, keen.url, EventType.PROGRESS)
    lease = begun(context)

    def report(fraction: float, moment: datetime) -> None:
        with context.database.write() as session:
            progress = {"stage": "render", "fraction": fraction, "message": "", "eta_seconds": None}
            assert leases.update_job(session, lease, progress=progress)
            event = events.Event(job_id=lease.job_id, type="progress", data=progress, created_at=moment)
            session.add(event)
            session.flush()
            outbox.write(session, event)

    start = now()
    for number in range(13):  # six seconds of a busy job
        report(number / 100, start + number * 0.5 * SECOND)
        deliver(sender, start + number * 0.5 * SECOND)
    assert [call.json["data"]["progress"]["fraction"] for call in keen.calls] == [0.0, 0.1]
    keen.answer = status(500)
    for number in range(1, 21):
        report(0.99, start + number * 10 * SECOND)
        if number % 5 == 0:
            deliver(sender, start + number * 10 * SECOND)
    told = [delivery for delivery in deliveries(context) if delivery.event == "job.progress"]
    assert len(told) <= 5, "while one is on its way, no other is written"
    assert plain.calls == []


@ON_ANY
def test_deliveries_go_with_their_job_and_after_their_time(
    context: Context, sender: WebhookSender, receive: Receive
) -> None:
    endpoint(context, receive().url)
    first, second = succeeded(context), succeeded(context)
    deliver(sender, now())
    with context.database.write() as session:
        repository.erase(session, first)
    assert [delivery.job_id for delivery in deliveries(context)] == [second]
    with context.database.write() as session:
        session.get_one(Delivery, deliveries(context)[0].id).created_at -= 29 * DAY
    forget_old_deliveries(context)
    assert len(deliveries(context)) == 1
    with context.database.write() as session:
        session.get_one(Delivery, deliveries(context)[0].id).created_at -= 2 * DAY
    forget_old_deliveries(context)
    assert deliveries(context) == []
    with context.database.read() as session:
        assert session.scalar(select(func.count()).select_from(DeliveryAttempt)) == 0


def test_sent_again_it_keeps_its_id(context: Context, sender: WebhookSender, receive: Receive) -> None:
    receiver = receive(answer=status(400))
    endpoint(context, receiver.url)
    succeeded(context)
    through_all_tries(context, sender, now())
    (delivery,) = deliveries(context)
    receiver.answer = OK
    with context.database.write() as session:
        service.replay(session, LOCAL_KEY_ID, delivery.id)
    deliver(sender, now())
    assert {call.headers["webhook-id"] for call in receiver.calls} == {delivery.id}
    assert (deliveries(context)[0].status, len(receiver.calls)) == ("delivered", 11)
