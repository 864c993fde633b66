"""Inputs by address: a job fetches them before it works, keeps them like uploads, and says why when it cannot."""

from __future__ import annotations

import hashlib
import ssl
import subprocess
import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from running import Running, eventually


class Host(ThreadingHTTPServer):
    """Gives a picture under every path, slowly under /slow, for ever under /endless, and nothing under /missing."""

    daemon_threads = True

    def __init__(self, picture: bytes):
        self.asked: list[str] = []
        host = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                host.asked.append(self.path)
                self.send_response(404 if self.path == "/missing" else 200)
                if self.path not in ("/slow", "/endless"):
                    self.send_header("Content-Length", str(len(picture)))
                self.end_headers()
                self.wfile.write(picture)
                while self.path == "/endless" or (self.path == "/slow" and host.slow):
                    self.wfile.write(bytes(1000))
                    time.sleep(0.05)

            def log_message(self, *_: object) -> None:
                """Not to the tests' output."""

        super().__init__(("127.0.0.1", 0), Handler)
        self.slow = True
        self.scheme = "http"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def url(self, path: str, name: str = "127.0.0.1") -> str:
        return f"{self.scheme}://{name}:{self.server_address[1]}{path}"


@pytest.fixture(scope="module")
def host(picture: bytes) -> Iterator[Host]:
    started = Host(picture)
    yield started
    started.shutdown()
    started.server_close()


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a certificate for `localhost`, and its key."""
    folder = tmp_path_factory.mktemp("certificate")
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost"]
    command += ["-addext", "subjectAltName=DNS:localhost", "-keyout", "key.pem", "-out", "certificate.pem"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, certificate: Path) -> Iterator[Running]:
    """A service that may fetch from this machine, and trusts the certificate."""
    settings: dict[str, Any] = {"lease_seconds": 3, "sweep_seconds": 0.5, "fetch_seconds": 10}
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("SSL_CERT_FILE", str(certificate / "certificate.pem"))
        data = tmp_path_factory.mktemp("urls") / "data"
        started = Running(data, allowed_networks="127.0.0.0/8,::1/128", **settings)
    yield started
    started.stop()


def submit(running: Running, url: str, **options: Any) -> dict[str, Any]:
    job = {"kind": "tiny", "inputs": {"image": url}, "options": options}
    response = running.client.post("/v1/jobs", json=job)
    assert response.status_code == 202, response.text
    return response.json()


def test_a_job_fetches_its_input_and_keeps_it(service: Running, host: Host, picture: bytes) -> None:
    url = host.url("/holiday.png?token=1")
    files = service.data_dir / "storage" / "files"
    before = set(files.glob("*"))
    job = submit(service, url)
    assert job["inputs"] == {"image": url}
    done = service.until(job["id"], "succeeded")
    assert done["inputs"] == {"image": url}
    report = service.client.get(done["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"]["bytes"] == len(picture)
    with service.client.stream("GET", f"/v1/jobs/{job['id']}/events") as events:
        told = events.read().decode()
    fractions = [float(part.split(",")[0]) for part in told.split('"fraction": ')[1:]]
    assert '"stage": "fetch"' in told and "MB from 127.0.0.1" in told
    assert fractions == sorted(fractions), "progress never goes back"
    asked = len(host.asked)
    revision = service.client.post(f"/v1/jobs/{job['id']}/revisions", json={"options": {"level": 1}}).json()
    service.until(revision["id"], "succeeded")
    assert len(host.asked) == asked, "a revision has the file already"
    contents = {hashlib.sha256(path.read_bytes()).hexdigest() for path in set(files.iterdir()) - before}
    assert hashlib.sha256(picture).hexdigest() in contents
    for one in (job, revision):
        service.client.delete(f"/v1/jobs/{one['id']}").raise_for_status()
    assert set(files.iterdir()) == before


@pytest.mark.parametrize(("path", "code"), [("/missing", "input_url_unreachable"), ("/endless", "input_url_timeout")])
def test_an_input_that_cannot_be_had_ends_the_job(service: Running, host: Host, path: str, code: str) -> None:
    failed = service.until(submit(service, host.url(path))["id"], "failed")
    assert failed["error"]["code"] == code
    assert failed["error"]["detail"].endswith(".")


def test_a_wrong_input_ends_the_job(service: Running, host: Host) -> None:
    job = {"kind": "tiny", "inputs": {"image": host.url("/a.png"), "driver": host.url("/b.png")}}
    failed = service.until(service.client.post("/v1/jobs", json=job).json()["id"], "failed")
    assert failed["error"]["code"] == "input_wrong_media"
    assert "driver" in failed["error"]["detail"]


def test_one_address_for_two_inputs_is_fetched_once(service: Running, host: Host) -> None:
    before = len(host.asked)
    job = {"kind": "tiny", "inputs": {"image": host.url("/one.png"), "driver": host.url("/one.png")}}
    failed = service.until(service.client.post("/v1/jobs", json=job).json()["id"], "failed")
    assert failed["error"]["code"] == "input_wrong_media"
    assert len(host.asked) == before + 1


def test_a_job_is_canceled_while_it_fetches(service: Running, host: Host) -> None:
    job = submit(service, host.url("/slow"))
    eventually(lambda: service.job(job["id"])["progress"]["stage"] == "fetch", "it fetches")
    service.client.post(f"/v1/jobs/{job['id']}/cancel").raise_for_status()
    folder = service.data_dir / "jobs" / job["id"]
    eventually(lambda: not list(folder.glob("attempt-*")), "what had come is erased")
    children = service.processes("worker.job_process.child")
    service.until(submit(service, host.url("/after.png"))["id"], "succeeded")
    assert service.processes("worker.job_process.child") == children, "the process that was ready is still good"


def test_a_killed_worker_leaves_the_fetching_to_the_next_attempt(service: Running, host: Host) -> None:
    job = submit(service, host.url("/slow"))
    eventually(lambda: service.job(job["id"])["progress"]["stage"] == "fetch", "it fetches")
    (worker,) = service.processes("shell.main worker")
    host.slow = False
    worker.kill()
    try:
        assert service.until(job["id"], "succeeded")
    finally:
        host.slow = True


def test_what_an_earlier_attempt_fetched_is_not_fetched_again(service: Running, host: Host) -> None:
    before = host.asked.count("/kept.png")
    job = submit(service, host.url("/kept.png"), crash="segv", crash_once=True)
    service.until(job["id"], "succeeded")
    assert host.asked.count("/kept.png") == before + 1


@pytest.mark.parametrize(
    "url",
    [
        *("https://10.0.0.1/", "https://169.254.169.254/latest", "https://[fd00::1]/", "http://8.8.8.8/a.png"),
        *("https://u:p@example.com/a.png", "ftp://a.example/", "file:///etc/passwd", "https://", "gopher://x/"),
        "https://example.com/" + "x" * 3000,
    ],
)
def test_addresses_that_lead_nowhere_are_refused_at_once(service: Running, url: str) -> None:
    response = service.client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": url}})
    assert (response.status_code, response.json()["code"]) == (422, "input_url_refused")
    assert response.json()["errors"][0]["pointer"] == "/inputs/image"


def test_by_tls(service: Running, picture: bytes, certificate: Path) -> None:
    host = Host(picture)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(certificate / "certificate.pem", certificate / "key.pem")
    host.socket = context.wrap_socket(host.socket, server_side=True)
    host.scheme = "https"
    service.until(submit(service, host.url("/a.png", "localhost"))["id"], "succeeded")
    failed = service.until(submit(service, host.url("/a.png", "127.0.0.1"))["id"], "failed")
    assert failed["error"]["code"] == "input_url_unreachable", "the certificate is for another name"
    host.shutdown()
    host.server_close()
