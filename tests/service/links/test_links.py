"""Public links: what everybody may read who knows the address."""

from __future__ import annotations

import sqlite3
import time
from contextlib import closing
from datetime import datetime, timedelta
from typing import Any

import httpx
from running import Running

ELSEWHERE = {"Origin": "https://blog.example"}


def finished(running: Running, picture: bytes) -> str:
    return running.until(running.submit(picture)["id"], "succeeded")["id"]


def link(running: Running, job_id: str, **asked: Any) -> dict[str, Any]:
    return running.client.post(f"/v1/jobs/{job_id}/links", json=asked).raise_for_status().json()


def test_a_link_opens_what_it_names_to_pages_of_any_origin(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    made = link(running, job_id, artifacts=["preview.jpg"])
    shared = running.client.get(made["url"], headers=ELSEWHERE)
    assert shared.headers["Access-Control-Allow-Origin"] == "*"
    assert list(shared.json()["artifacts"]) == ["preview.jpg"]
    address = shared.json()["artifacts"]["preview.jpg"]["url"]
    part = running.client.get(address, headers={**ELSEWHERE, "Range": "bytes=4-9"})
    assert part.status_code == 206 and part.content == picture[4:10]
    assert part.headers["Access-Control-Allow-Origin"] == "*"
    assert running.client.head(address).headers["Content-Length"] == str(len(picture))
    assert running.client.get(f"{made['url']}/report.json").json()["code"] == "artifact_not_found"
    assert job_id not in shared.text


def test_a_link_opens_all_results_where_none_are_named(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    made = link(running, job_id)
    shared = running.client.get(made["url"]).json()
    assert set(shared["artifacts"]) == set(running.job(job_id)["artifacts"])
    lasting = link(running, job_id, expires_in_hours=None)
    assert running.client.get(lasting["url"]).json()["expires_at"] is None
    days = datetime.fromisoformat(shared["expires_at"]) - datetime.fromisoformat(made["created_at"])
    assert days == timedelta(days=30), "as the settings say where nothing else was said"


def test_a_link_tells_the_title_and_nothing_else_that_the_job_was_given(running: Running, picture: bytes) -> None:
    given = {"photo": "Aunt Mary at 12 Elm Street", "note": "for the lawyer"}
    inputs = {"image": running.submit(picture)["inputs"]["image"]}
    asked = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": inputs, "metadata": given})
    job_id = running.until(asked.raise_for_status().json()["id"], "succeeded")["id"]
    made = link(running, job_id, artifacts=["preview.jpg"])
    untitled = running.client.get(made["url"])
    assert untitled.json()["title"] is None
    running.client.patch(f"/v1/jobs/{job_id}", json={"title": "My aunt"}).raise_for_status()
    titled = running.client.get(made["url"])
    assert titled.json()["title"] == "My aunt"
    assert set(titled.json()) == {"kind", "title", "has_sound", "finished_at", "expires_at", "artifacts"}
    assert titled.json()["has_sound"] is None
    assert "Elm" not in untitled.text + titled.text and "lawyer" not in untitled.text + titled.text


def test_an_address_is_told_once_and_kept_nowhere(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    answer = running.client.post(f"/v1/jobs/{job_id}/links", json={})
    assert answer.headers["Cache-Control"] == "no-store"
    made = answer.json()
    (shown,) = listed(running, job_id)
    assert shown == {**made, "url": None, "page": None}
    token = made["url"].removeprefix("/v1/public/")
    assert token.startswith(shown["hint"]) and len(shown["hint"]) == 6
    with closing(sqlite3.connect(running.data_dir / "galatea.db")) as database:
        rows = "\n".join(database.iterdump())
    assert made["id"] in rows and token not in rows


def test_all_links_are_listed_page_by_page(running: Running, picture: bytes) -> None:
    jobs = [finished(running, picture) for _ in range(2)]
    made = [link(running, job_id)["id"] for job_id in jobs]
    first = running.client.get("/v1/links", params={"limit": 1}).json()
    assert [one["id"] for one in first["items"]] == [made[1]] and first["items"][0]["job_id"] == jobs[1]
    second = running.client.get("/v1/links", params={"limit": 1, "cursor": first["next_cursor"]}).json()
    assert [one["id"] for one in second["items"]] == [made[0]]
    assert running.client.get("/v1/links", params={"cursor": "x"}).json()["code"] == "invalid_cursor"


def test_a_revoked_link_opens_nothing(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    first, second = link(running, job_id), link(running, job_id)
    assert [one["id"] for one in listed(running, job_id)] == [first["id"], second["id"]]
    assert running.client.delete(f"/v1/links/{first['id']}").status_code == 204
    assert gone(running.client.get(first["url"]))
    assert gone(running.client.get(f"{first['url']}/preview.jpg"))
    assert gone(running.client.delete(f"/v1/links/{first['id']}"))
    assert running.client.get(second["url"]).status_code == 200


def test_a_link_ends_with_its_time_and_with_its_job(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    lasting, brief = link(running, job_id), link(running, job_id, expires_in_hours=0.5 / 3600)
    time.sleep(0.6)
    assert gone(running.client.get(brief["url"]))
    running.client.delete(f"/v1/jobs/{job_id}").raise_for_status()
    assert gone(running.client.get(lasting["url"]))
    assert gone(running.client.get("/v1/public/guessed"))


def test_nothing_else_is_open_to_pages_of_other_origins(running: Running, picture: bytes) -> None:
    job_id = finished(running, picture)
    for address in (f"/v1/jobs/{job_id}", f"/v1/jobs/{job_id}/links", "/v1/publicity"):
        assert running.client.get(address, headers=ELSEWHERE).json()["code"] == "origin_not_allowed"


def listed(running: Running, job_id: str) -> list[dict[str, Any]]:
    return running.client.get(f"/v1/jobs/{job_id}/links").raise_for_status().json()["items"]


def gone(answer: httpx.Response) -> bool:
    return (answer.status_code, answer.json()["code"]) == (404, "link_not_found")
