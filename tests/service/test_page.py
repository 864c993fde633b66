"""The web page at the root."""

from __future__ import annotations

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
