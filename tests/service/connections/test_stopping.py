"""SIGTERM comes in the middle of everything: whoever asked is answered, and nothing that was accepted is lost."""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from raw_http import connect, problem, request, until_closed
from raw_upload import PIECE, Media, create, standing
from running import Running, eventually

UPLOAD = Media(4_000_000)
SENT = 1_500_000
LARGE = Media(60_000_000)
"""More than the buffers on the way hold."""


@dataclass
class Stopped:
    """A service that was told to end, what it answered, and the same one begun anew."""

    running: Running
    answers: dict[str, bytes]
    status: int
    log: str
    upload: str
    large: str


@pytest.fixture(scope="module")
def stopped(tmp_path_factory: pytest.TempPathFactory, picture: bytes) -> Iterator[Stopped]:
    """No worker takes the jobs: they wait."""
    with Running(tmp_path_factory.mktemp("stopping") / "data", worker="false") as running:
        yield _stopped(running, picture)


def _stopped(running: Running, picture: bytes) -> Stopped:
    image = running.client.post("/v1/files", files={"file": ("a.png", picture)}).raise_for_status().json()["id"]
    order = json.dumps({"kind": "tiny", "inputs": {"image": image}}).encode()
    ended = running.submit(picture)["id"]
    running.client.post(f"/v1/jobs/{ended}/cancel").raise_for_status()
    large = running.client.post("/v1/files", files={"file": ("large.mp4", LARGE.bytes())}).raise_for_status()
    content = f"/v1/files/{large.json()['id']}/content"
    upload = create(running, UPLOAD.size)

    json_type = {"Content_Type": "application/json"}
    form = {"Content_Type": "multipart/form-data; boundary=b", "Content_Length": "2000000"}
    part = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.png"\r\n\r\n' + picture + bytes(800_000)
    piece = {name.replace("-", "_"): value for name, value in PIECE.items()}
    piece |= {"Upload_Offset": "0", "Content_Length": str(UPLOAD.size)}
    revise = f"/v1/jobs/{ended}/revisions"
    waiting = {
        "job": request("POST", "/v1/jobs", order, Prefer="wait=60", **json_type),
        "revision": request("POST", revise, b'{"options": {"level": 1.0}}', Prefer="wait=60", **json_type),
    }
    lines = {name: connect(running, sent) for name, sent in waiting.items()}
    eventually(lambda: len(_queued(running)) == 2, "both jobs are accepted")
    others = {
        "events": request("GET", f"/v1/jobs/{_queued(running)[0]}/events"),
        "piece": request("PATCH", upload, UPLOAD.bytes(0, SENT), **piece),
        "form": request("POST", "/v1/files", part, **form),
        "order with files": request("POST", "/v1/jobs", part, **form),
        "body": request("POST", "/v1/jobs", order[:20], Content_Length="1000", **json_type),
        "body read for us": request("POST", "/v1/webhooks", b'{"url"', Content_Length="1000", **json_type),
        "head": b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nX-Slow: ",
        "download": request("GET", content),
        "silent": b"",
    }
    lines |= {name: connect(running, sent) for name, sent in others.items()}
    first = {name: lines[name].recv(1000) for name in ("events", "download")}
    spool = running.data_dir / "uploads" / upload.rsplit("/", 1)[-1]
    eventually(lambda: spool.stat().st_size > 0, "the piece comes in")
    eventually(lambda: len(list((running.data_dir / "incoming").iterdir())) == 2, "the forms come in")
    running.process.send_signal(signal.SIGTERM)
    download = lines.pop("download")
    answers = {name: first.get(name, b"") + until_closed(line) for name, line in lines.items()}
    status, log = running.process.wait(60), running.output.read_text()
    answers["download"] = first["download"] + until_closed(download)  # now: whoever reads on may get all of it in time
    running.start()
    return Stopped(running, answers, status, log, upload, content)


def _queued(running: Running) -> list[str]:
    return [job["id"] for job in running.client.get("/v1/jobs?status=queued").json()["items"]]


@pytest.mark.parametrize("name", ["job", "revision"])
def test_who_waits_for_a_job_that_was_accepted_gets_the_job(stopped: Stopped, name: str) -> None:
    head, _, body = stopped.answers[name].partition(b"\r\n\r\n")
    job = json.loads(body)
    assert head.startswith(b"HTTP/1.1 202") and job["status"] == "queued"
    assert f"location: /v1/jobs/{job['id']}" in head.decode().lower()
    assert stopped.running.job(job["id"])["status"] == "queued", "and it is there when the service is back"


def test_streams_of_events_come_to_an_end(stopped: Stopped) -> None:
    """The last chunk is there: a client can tell it from a line that broke."""
    assert stopped.answers["events"].startswith(b"HTTP/1.1 200")
    assert stopped.answers["events"].endswith(b"\r\n0\r\n\r\n")


def test_an_upload_keeps_what_has_come(stopped: Stopped) -> None:
    answer = stopped.answers["piece"]
    assert problem(answer) == (503, "service_stopping") and b"tus-resumable: 1.0.0" in answer.lower()
    offset = standing(stopped.running, stopped.upload)
    assert 1 << 20 <= offset <= SENT
    rest = PIECE | {"Upload-Offset": str(offset)}
    assert stopped.running.client.patch(stopped.upload, content=UPLOAD.bytes(offset), headers=rest).status_code == 204


@pytest.mark.parametrize("name", ["form", "order with files", "body", "body read for us", "head"])
def test_what_has_not_come_whole_is_refused_for_now(stopped: Stopped, name: str) -> None:
    assert problem(stopped.answers[name]) == (503, "service_stopping")
    assert b"retry-after: 5" in stopped.answers[name].lower()


def test_forms_that_were_refused_leave_nothing(stopped: Stopped) -> None:
    assert list((stopped.running.data_dir / "incoming").iterdir()) == []


def test_a_download_that_is_cut_short_can_be_taken_up(stopped: Stopped) -> None:
    head, _, came = stopped.answers["download"].partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 200") and f"content-length: {LARGE.size}" in head.decode().lower()
    assert len(came) < LARGE.size
    rest = stopped.running.client.get(stopped.large, headers={"Range": f"bytes={len(came)}-"})
    assert rest.status_code == 206 and came + rest.content == LARGE.bytes()


def test_the_end_is_an_orderly_one(stopped: Stopped) -> None:
    assert stopped.status == 0
    assert stopped.answers["silent"] == b""
    assert "Traceback" not in stopped.log and "internal_error" not in stopped.log
