"""Public links: what everybody may read who knows the address."""

from __future__ import annotations

import time
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
    assert shared["expires_at"] is None


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
