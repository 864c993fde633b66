"""The receivers in the guide to webhooks do what it says, as they stand there."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import httpx
import pytest
from missing import missing
from running import ROOT, Running, eventually
from servers import free_port

COMMANDS = {"python": ([sys.executable], "receiver.py"), "javascript": (["node"], "receiver.mjs")}


@pytest.mark.parametrize("language", COMMANDS)
def test_the_receiver_of_the_guide_verifies_what_comes(
    running: Running, picture: bytes, tmp_path: Path, language: str
) -> None:
    packages = ROOT / "web" / "node_modules"
    if language == "javascript" and not (packages / "standardwebhooks").is_dir():
        message = "the page's packages are not installed (make setup)"
        missing(message)
    (tmp_path / "node_modules").symlink_to(packages)
    blocks = re.findall(rf"```{language}\n(.*?)```", (ROOT / "docs" / "webhooks.md").read_text(), re.DOTALL)
    assert len(blocks) == 1
    command, name = COMMANDS[language]
    (tmp_path / name).write_text(blocks[0])
    port = free_port()
    url = f"http://127.0.0.1:{port}/galatea"
    webhook = running.client.post("/v1/webhooks", json={"url": url}).raise_for_status().json()
    environment = {**os.environ, "WEBHOOK_SECRET": webhook["secret"], "PORT": str(port)}
    printed = tmp_path / "printed"
    with printed.open("wb") as output:
        receiver = subprocess.Popen([*command, name], cwd=tmp_path, env=environment, stdout=output, stderr=output)
    try:
        eventually(lambda: answers(url), f"it listens: {printed.read_text()}")
        job = running.until(running.submit(picture)["id"], "succeeded")
        eventually(lambda: f"job.succeeded {job['id']}\n" in printed.read_text(), "it prints the job")
        forged = {"webhook-id": "x", "webhook-timestamp": "1", "webhook-signature": "v1,AAAA"}
        assert httpx.post(url, content="{}", headers=forged).status_code == 400
        wanted = {"job": job["id"], "status": "delivered"}
        listed = lambda: running.client.get("/v1/webhooks/deliveries", params=wanted).json()["items"]  # noqa: E731
        eventually(lambda: len(listed()) == 1, "it is recorded")
        assert listed()[0]["last_attempt"]["response_status"] == 204
    finally:
        receiver.kill()
        receiver.wait()
        running.client.delete(f"/v1/webhooks/{webhook['id']}").raise_for_status()


def answers(url: str) -> bool:
    try:
        return httpx.post(url, content="{}").status_code == 400
    except httpx.ConnectError:
        return False
