"""The web page at the root."""

from __future__ import annotations

import gzip
import json
import socket

import pytest
from running import Running


def test_the_page_and_its_files(running: Running) -> None:
    assert running.client.get("/").text == "<title>The page</title>"
    script = running.client.get("/app.js")
    assert script.text == "start()" and "javascript" in script.headers["content-type"]


def test_addresses_that_nobody_knows_get_the_document_that_says_so(running: Running) -> None:
    response = running.client.get("/jobs/123")
    assert (response.status_code, response.text) == (404, "<title>The page</title>")
    for path in ("/missing.js", "/v1/jobs/x/nothing"):
        response = running.client.get(path)
        assert (response.status_code, response.json()["code"]) == (404, "not_found")
    assert running.client.post("/").status_code == 405


@pytest.mark.parametrize("path", ["/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "//../secret.txt"])
def test_nothing_outside_its_folder_is_sent(running: Running, path: str) -> None:
    address = (running.client.base_url.host, running.client.base_url.port)
    with socket.create_connection(address, timeout=10) as connection:  # a client library would tidy the path up
        connection.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        answer = b"".join(iter(lambda: connection.recv(65536), b""))
    assert answer.startswith(b"HTTP/1.1")
    assert b"not yours" not in answer


SCRIPT = "/assets/app-a1b2c3.js"


def plain(running: Running, path: str, **headers: str) -> tuple[dict[str, str], bytes]:
    """An answer as it came over the line."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    with running.client.stream("GET", path, headers={"Accept-Encoding": "identity"} | named) as response:
        assert response.status_code == 200
        return dict(response.headers), b"".join(response.iter_raw())


@pytest.mark.parametrize(
    ("taken", "coding"),
    [
        ("gzip, deflate, br, zstd", "br"),
        ("gzip", "gzip"),
        ("br;q=0, gzip;q=0.5", "gzip"),
        ("gzip;q=0.000", None),
        ("identity", None),
        ("xbr", None),
    ],
)
def test_a_file_comes_in_the_best_coding_that_is_taken(running: Running, taken: str, coding: str | None) -> None:
    headers, body = plain(running, SCRIPT, Accept_Encoding=taken)
    assert headers.get("content-encoding") == coding and headers["vary"] == "Accept-Encoding"
    assert "javascript" in headers["content-type"] and int(headers["content-length"]) == len(body)
    whole = b"go();" * 1000
    assert {"br": lambda: b"as brotli", "gzip": lambda: whole, None: lambda: whole}[coding]() == (
        gzip.decompress(body) if coding == "gzip" else body
    )


def test_files_that_never_change_are_kept_and_others_asked_for_again(running: Running) -> None:
    headers, _ = plain(running, SCRIPT)
    assert headers["cache-control"] == "public, max-age=31536000, immutable"
    for path in ("/", "/app.js"):
        headers, _ = plain(running, path)
        assert headers["cache-control"] == "no-cache"
        again = running.client.get(path, headers={"If-None-Match": headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        assert again.headers["vary"] == "Accept-Encoding" and again.headers["cache-control"] == "no-cache"
        policies = [answer["content-security-policy"] for answer in (headers, again.headers)]
        assert policies[0] == policies[1], "browsers put the headers of a 304 in place of those that they have"


def test_codings_of_a_file_have_tags_of_their_own(running: Running) -> None:
    tags = {plain(running, SCRIPT, Accept_Encoding=taken)[0]["etag"] for taken in ("br", "gzip", "identity")}
    assert len(tags) == 3


def test_the_page_runs_its_own_scripts_alone_and_in_nobodys_frame(running: Running) -> None:
    told = running.client.get("/").headers["content-security-policy"]
    assert running.client.get("/nothing/here").headers["content-security-policy"] == told, "the page says that, too"
    policy = dict(part.split(" ", 1) for part in told.split("; "))
    assert policy["default-src"] == "'self'" and policy["frame-ancestors"] == "'none'"
    assert policy["base-uri"] == policy["object-src"] == "'none'"
    assert "'unsafe-inline'" not in policy["script-src"] and "'unsafe-eval'" not in policy["script-src"]


@pytest.mark.parametrize("path", ["/healthz", "/v1/kinds", "/v1/jobs/nothing", "/nothing.js", "/\0", SCRIPT])
def test_all_else_is_no_page(running: Running, path: str) -> None:
    headers = running.client.get(path.replace("\0", "%00")).headers
    assert headers["content-security-policy"] == "default-src 'none'; frame-ancestors 'none'"
    assert headers["x-content-type-options"] == "nosniff" and headers["referrer-policy"] == "same-origin"
    assert "camera=(self)" in headers["permissions-policy"] and "geolocation=()" in headers["permissions-policy"]


def test_long_answers_of_the_api_are_compressed_for_those_who_take_it(running: Running) -> None:
    headers, whole = plain(running, "/v1/kinds")
    assert "content-encoding" not in headers and len(whole) > 1000 and headers["vary"] == "Accept-Encoding"
    headers, body = plain(running, "/v1/kinds", Accept_Encoding="gzip")
    assert headers["content-encoding"] == "gzip" and int(headers["content-length"]) == len(body) < len(whole)
    assert json.loads(gzip.decompress(body)) == json.loads(whole)
    headers, _ = plain(running, "/healthz", Accept_Encoding="gzip")
    assert "content-encoding" not in headers, "what is short is not worth it"


def test_events_and_media_are_sent_as_they_are(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=0)["id"]
    job = running.until(job, "succeeded")
    headers, body = plain(running, f"/v1/jobs/{job['id']}/events", Accept_Encoding="gzip")
    assert "content-encoding" not in headers and body.startswith(b"id: ")
    for artifact in job["artifacts"].values():
        headers, body = plain(running, artifact["url"], Accept_Encoding="gzip")
        assert "content-encoding" not in headers and len(body) == artifact["size"]
