"""Works have titles, all versions the same; jobs are found by words."""

from __future__ import annotations

from typing import Any

import pytest
from running import Running

from service.ids import new_id


def rename(running: Running, job_id: str, title: Any) -> Any:
    return running.client.patch(f"/v1/jobs/{job_id}", json={"title": title})


def found(running: Running, q: str, **more: Any) -> list[str]:
    answer = running.client.get("/v1/jobs", params={"q": q, **more}).raise_for_status().json()
    return [job["id"] for job in answer["items"]]


def submit(running: Running, picture: bytes, name: str, **asked: Any) -> dict[str, Any]:
    file = running.client.post("/v1/files", files={"file": (name, picture)}).raise_for_status().json()["id"]
    inputs = {"image": file, **asked.pop("inputs", {})}
    body = {"kind": "tiny", "inputs": inputs, "options": {"seconds": 0.1}, **asked}
    return running.client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"}).raise_for_status().json()


def test_a_title_belongs_to_all_versions_of_a_work(running: Running, picture: bytes) -> None:
    first = submit(running, picture, "a.png", title="Aunt Mary")
    assert first["title"] == "Aunt Mary"
    address = f"/v1/jobs/{first['id']}/revisions"
    second = running.client.post(address, json={}, headers={"Prefer": "wait=60"}).json()
    assert (second["title"], second["tree"]) == ("Aunt Mary", first["tree"])
    changed = rename(running, second["id"], "Great-aunt Mary")
    assert (changed.status_code, changed.json()["title"]) == (200, "Great-aunt Mary")
    assert running.job(first["id"])["title"] == "Great-aunt Mary"
    running.client.delete(f"/v1/jobs/{first['id']}").raise_for_status()
    third = running.client.post(f"/v1/jobs/{second['id']}/revisions", json={}).json()
    assert (third["title"], third["tree"]) == ("Great-aunt Mary", first["id"]), "the work outlives its first version"
    assert rename(running, third["id"], None).json()["title"] is None
    assert running.job(second["id"])["title"] is None
    assert submit(running, picture, "a.png")["title"] is None


@pytest.mark.parametrize(
    "body", [{}, {"title": ""}, {"title": "x" * 201}, {"title": "a\nb"}, {"title": 7}, {"kind": "x"}]
)
def test_what_is_no_title(running: Running, picture: bytes, body: dict[str, Any]) -> None:
    job = submit(running, picture, "a.png", title="stays")
    refused = running.client.patch(f"/v1/jobs/{job['id']}", json=body)
    assert (refused.status_code, refused.json()["code"]) == (422, "invalid_request")
    assert running.job(job["id"])["title"] == "stays"
    assert rename(running, new_id(), "x").json()["code"] == "job_not_found"


def test_a_form_may_carry_a_title_and_the_same_request_is_the_same(running: Running, picture: bytes) -> None:
    answers = [
        running.client.post(
            "/v1/jobs",
            data={"kind": "tiny", "title": title, "options": '{"seconds": 0}'},
            files={"image": ("p.png", picture)},
            headers={"Idempotency-Key": "titles-1"},
        )
        for title in ("One", "One", "Two")
    ]
    assert answers[0].json()["title"] == "One"
    assert answers[0].json()["id"] == answers[1].json()["id"]
    assert answers[2].json()["code"] == "idempotency_key_reused"


def test_jobs_are_found_by_words(running: Running, picture: bytes) -> None:
    sea = submit(running, picture, "Möwe_am_Meer.png", title="Straße 100%", inputs={"driver": "happy-strong"})
    land = submit(running, picture, "kuh.png", title="Möwe an Land")
    assert found(running, "MÖWE") == [land["id"], sea["id"]]
    assert found(running, "meer möwe") == [sea["id"]], "every word, in any order"
    assert found(running, "STRASSE") == [sea["id"]]
    assert found(running, "happy-str meer") == [sea["id"]]
    assert found(running, "100%") == [sea["id"]]
    assert found(running, "1%0") == [], "no pattern"
    assert found(running, "am_meer") == [sea["id"]] and found(running, "am?meer") == []
    assert found(running, "tiny kuh") == [land["id"]]
    assert found(running, "tiny kuh", status="failed") == []
    assert set(found(running, "", limit=200)) >= {sea["id"], land["id"]}
    page = running.client.get("/v1/jobs", params={"q": "möwe", "limit": 1})
    assert "q=m" in page.headers["Link"]
    assert found(running, "möwe", cursor=page.json()["next_cursor"]) == [sea["id"]]
    rename(running, land["id"], "Kuh")
    assert found(running, "möwe land") == [] and found(running, "kuh") == [land["id"]]
    rename(running, land["id"], None)
    assert found(running, "kuh.png") == [land["id"]], "the names stay"
    assert running.client.get("/v1/jobs", params={"q": "x" * 201}).status_code == 422


def test_of_each_work_one_version_is_listed(running: Running, picture: bytes) -> None:
    def revised(job: dict[str, Any], **body: Any) -> dict[str, Any]:
        address = f"/v1/jobs/{job['id']}/revisions"
        return running.client.post(address, json=body, headers={"Prefer": "wait=60"}).raise_for_status().json()

    old = submit(running, picture, "latest.png")
    other = submit(running, picture, "latest.png")
    alone = submit(running, picture, "latest.png")
    middle = revised(old)
    newest = revised(middle, options={"seconds": 0.2})
    second = revised(other)
    assert found(running, "latest.png", latest=True) == [second["id"], newest["id"], alone["id"]]
    first = running.client.get("/v1/jobs", params={"q": "latest.png", "latest": True, "limit": 2}).json()
    assert first["versions"] == {old["id"]: 3, other["id"]: 2}
    assert found(running, "latest.png", latest=True, cursor=first["next_cursor"]) == [alone["id"]]
    early = {"latest": True, "created_before": newest["created_at"]}
    assert found(running, "latest.png", **early)[1:] == [alone["id"], other["id"]], "the newest of what is let through"
    running.client.delete(f"/v1/jobs/{newest['id']}").raise_for_status()
    assert found(running, "latest.png", latest=True) == [second["id"], middle["id"], alone["id"]]
