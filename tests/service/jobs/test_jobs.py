"""Jobs through the API of a running service."""

from __future__ import annotations

import json
import threading
from typing import Any
from uuid import uuid4

import httpx
import pytest
from running import Running, eventually

from worker.attempts import attempt


def wait(running: Running, job: dict[str, Any], **more: Any) -> dict[str, Any]:
    response = running.client.post("/v1/jobs", json=job, headers={"Prefer": "wait=30"}, **more)
    assert response.status_code == 202, response.text
    return response.json()


def code(response: httpx.Response) -> tuple[int, str]:
    assert response.headers["content-type"] == "application/problem+json"
    assert response.json()["status"] == response.status_code
    return response.status_code, response.json()["code"]


def test_a_job_runs_and_its_document_is_as_agreed(running: Running, picture: bytes) -> None:
    submitted = running.submit(picture, seconds=0.5)
    assert submitted["status"] == "queued"
    job = running.until(submitted["id"], "succeeded")
    assert set(submitted) == set(job)
    assert set(job) == {
        *("id", "kind", "status", "progress", "inputs", "options", "artifacts", "error", "metadata"),
        *("created_at", "started_at", "finished_at", "revision_of", "tree", "priority", "title", "queue_position"),
    }
    stages = ["measure", "rest", "write"]
    assert job["progress"] == {"stage": None, "fraction": 1.0, "message": "", "eta_seconds": None, "stages": stages}
    assert job["options"] == {"seconds": 0.5}
    assert job["error"] is None
    assert set(job["artifacts"]) == {"preview.jpg", "spectrum.json", "animation.mp4", "report.json"}
    assert set(job["artifacts"]["report.json"]) == {"url", "signed_url", "size", "sha256", "content_type"}
    assert job["created_at"] <= job["started_at"] <= job["finished_at"]
    report = running.client.get(job["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"] == {"bytes": len(picture), "driver": None}


def test_a_job_that_waits_shows_its_place_in_the_queue(running: Running, picture: bytes) -> None:
    at_work = running.rest(picture)
    waiting = [running.submit(picture) for _ in range(2)]
    assert [job["queue_position"] for job in waiting] == [1, 2]
    assert [running.job(job)["queue_position"] for job in (at_work, waiting[1]["id"])] == [None, 2]
    running.client.post(f"/v1/jobs/{waiting[0]['id']}/cancel").raise_for_status()
    assert running.job(waiting[1]["id"])["queue_position"] == 1
    running.client.post(f"/v1/jobs/{at_work}/cancel").raise_for_status()
    assert running.until(waiting[1]["id"], "succeeded")["queue_position"] is None


def test_progress_shows_stage_fraction_and_time_left(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=60)
    shown: dict[str, Any] = {}

    def estimated() -> bool:
        shown.update(running.job(job["id"]))
        return shown["progress"]["eta_seconds"] is not None

    eventually(estimated, "there is an estimate")
    assert shown["status"] == "running"
    assert shown["progress"]["stage"] == "rest"
    assert 0.2 <= shown["progress"]["fraction"] < 0.9
    assert shown["progress"]["eta_seconds"] > 0
    assert list(shown["artifacts"]) == ["preview.jpg"], "an early artifact is there while the job runs"
    assert running.client.get(shown["artifacts"]["preview.jpg"]["url"]).content == picture


def test_a_form_carries_the_files_themselves(running: Running, picture: bytes) -> None:
    response = running.client.post(
        "/v1/jobs",
        data={"kind": "tiny", "options": '{"seconds": 0}', "metadata": '{"mine": 1}'},
        files={"image": ("picture.png", picture, "image/png")},
        headers={"Prefer": "respond-async, wait=30"},
    )
    assert response.headers["location"] == f"/v1/jobs/{response.json()['id']}"
    assert response.json()["status"] == "succeeded"
    assert response.json()["metadata"] == {"mine": 1}
    file = running.client.get(f"/v1/files/{response.json()['inputs']['image']}").json()
    assert file["size"] == len(picture)


def test_waiting_ends_when_asked(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()
    asked = {"kind": "tiny", "inputs": {"image": file["id"]}, "options": {"seconds": 3000}}
    response = running.client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=1"})
    assert response.json()["status"] in ("queued", "running")
    assert response.headers["preference-applied"] == "wait=1"


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"kind": "nothing"}, "unknown_kind"),
        ({"inputs": {}}, "missing_input"),
        ({"inputs": {"image": "00000000-0000-7000-8000-000000000000"}}, "unknown_file"),
        ({"inputs": {"image": "../../etc/passwd"}}, "unknown_file"),
        ({"inputs": {"image": "https://10.0.0.1/a.jpg"}}, "input_url_refused"),
        ({"inputs": {"image": "FILE", "driver": "nobody"}}, "unknown_driver"),
        ({"inputs": {"image": "FILE", "driver": "FILE"}}, "input_wrong_media"),
        ({"inputs": {"image": ["FILE", "FILE"]}}, "too_many_files"),
        ({"inputs": {"image": "FILE", "other": "FILE"}}, "unknown_input"),
        ({"options": {"seconds": -1}}, "invalid_options"),
        ({"options": {"secnods": 1}}, "invalid_options"),
        ({"metadata": {"long": "x" * 20_000}}, "metadata_too_large"),
        ({"metadata": {"half": "\ud800"}}, "invalid_json"),
        ({"options": {"\udfff": 1}}, "invalid_json"),
        ({"surprise": 1}, "invalid_request"),
    ],
)
def test_what_cannot_be_accepted_is_refused_with_a_code(
    running: Running, picture: bytes, change: dict[str, Any], expected: str
) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]

    def fill(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: fill(one) for name, one in value.items()}
        return [file] * len(value) if isinstance(value, list) else (file if value == "FILE" else value)

    asked = {"kind": "tiny", "inputs": {"image": file}, "options": {}} | fill(change)
    body = json.dumps(asked).encode()
    response = running.client.post("/v1/jobs", content=body, headers={"content-type": "application/json"})
    assert code(response) == (422, expected)


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[1]", b'{"kind": NaN}', b"[" * 100_000, b'{"kind": "tiny", "inputs": 3}']
)
def test_malformed_bodies_are_refused(running: Running, body: bytes) -> None:
    response = running.client.post("/v1/jobs", content=body, headers={"content-type": "application/json"})
    assert code(response)[0] == 422


def test_an_input_error_fails_the_job_with_its_code(running: Running, picture: bytes) -> None:
    job = running.until(running.submit(picture, crash="refuse")["id"], "failed")
    assert job["error"] == {
        "code": "no_face",
        "detail": "No face was found: choose another picture.",
        "correctable": ["landmarks"],
        "found": {"faces": []},
    }


@pytest.mark.parametrize(
    ("crash", "expected"),
    [
        ("memory", "out_of_memory"),
        ("file", "file_limit"),
        ("bug", "internal_error"),
        ("hostile_name", "internal_error"),
        ("link", "not_permitted"),
    ],
)
def test_limits_and_faults_fail_the_job_and_only_it(
    running: Running, picture: bytes, crash: str, expected: str
) -> None:
    job = running.until(running.submit(picture, crash=crash)["id"], "failed")
    assert job["error"]["code"] == expected
    assert list(job["artifacts"]) == ["preview.jpg"]
    assert running.until(running.submit(picture)["id"], "succeeded")


@pytest.mark.parametrize("polls", [True, False])
def test_cancel_takes_effect_whether_the_job_looks_for_it_or_not(running: Running, picture: bytes, polls: bool) -> None:
    job = running.rest(picture, polls=polls)
    folder = running.data_dir / "jobs" / job
    assert list(folder.glob("attempt-*"))
    assert running.client.post(f"/v1/jobs/{job}/cancel").json()["status"] == "canceled"
    eventually(lambda: not list(folder.glob("attempt-*")), "the attempt is over")
    assert running.job(job)["status"] == "canceled"
    assert running.client.post(f"/v1/jobs/{job}/cancel").status_code == 200, "canceling twice is no error"


def test_a_canceled_job_is_over_within_two_seconds() -> None:
    """As the documents say: it is looked for an order so often, and the process may take so long to stop by itself."""
    assert attempt.ATTEMPT_POLL_SECONDS + attempt.GRACE_SECONDS + 2 * attempt.TICK_SECONDS < 2


def test_a_job_that_waits_is_canceled_without_a_worker(running: Running, picture: bytes) -> None:
    first, second = running.rest(picture), running.submit(picture)
    running.client.post(f"/v1/jobs/{second['id']}/cancel").raise_for_status()
    running.client.post(f"/v1/jobs/{first}/cancel").raise_for_status()
    third = running.until(running.submit(picture)["id"], "succeeded")
    assert running.job(second["id"])["started_at"] is None
    assert code(running.client.post(f"/v1/jobs/{third['id']}/cancel")) == (409, "job_finished")


def test_deleting_a_job_erases_its_media(running: Running, picture: bytes) -> None:
    job = running.until(running.submit(picture)["id"], "succeeded")
    file = job["inputs"]["image"]
    shared = running.until(
        running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": file}}).json()["id"], "succeeded"
    )
    assert (running.data_dir / "jobs" / job["id"] / "stages").is_dir()
    assert running.client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert code(running.client.get(f"/v1/jobs/{job['id']}")) == (404, "job_not_found")
    assert running.client.get(job["artifacts"]["report.json"]["url"]).status_code == 404
    assert not (running.data_dir / "jobs" / job["id"]).exists()
    assert running.client.get(f"/v1/files/{file}").status_code == 200, "another job still uses the file"
    assert (running.data_dir / "storage" / "files" / file).exists()
    assert running.client.delete(f"/v1/jobs/{shared['id']}").status_code == 204
    assert running.client.get(f"/v1/files/{file}").status_code == 404
    assert not (running.data_dir / "storage" / "files" / file).exists()
    assert code(running.client.delete(f"/v1/jobs/{job['id']}")) == (404, "job_not_found")


def test_deleting_a_running_job_stops_it(running: Running, picture: bytes) -> None:
    job = running.rest(picture, polls=False)
    assert running.client.delete(f"/v1/jobs/{job}").status_code == 204
    eventually(lambda: not (running.data_dir / "jobs" / job).exists(), "its folder is gone")
    assert running.until(running.submit(picture)["id"], "succeeded")


def test_the_list_is_newest_first_filtered_and_paged(running: Running, picture: bytes) -> None:
    made = [running.submit(picture)["id"] for _ in range(5)]
    for job in made:
        running.until(job, "succeeded")
    first = running.client.get("/v1/jobs", params={"limit": 2, "status": "succeeded"})
    second = running.client.get(first.links["next"]["url"])
    seen = [job["id"] for page in (first, second) for job in page.json()["items"]]
    assert seen == made[:0:-1]
    assert first.json()["next_cursor"] == seen[1]
    assert running.client.get("/v1/jobs", params={"kind": "nothing"}).json()["items"] == []
    recent = running.client.get("/v1/jobs", params={"created_after": running.job(made[3])["created_at"]}).json()
    assert [job["id"] for job in recent["items"]] == [made[4]]
    assert code(running.client.get("/v1/jobs", params={"status": "lost"}))[0] == 422
    assert code(running.client.get("/v1/jobs", params={"cursor": "'; DROP TABLE jobs"})) == (422, "invalid_cursor")


def test_one_key_makes_one_job(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file}, "options": {"seconds": 0.2}}
    headers = {"Idempotency-Key": str(uuid4())}
    first = running.client.post("/v1/jobs", json=asked, headers=headers)
    again = running.client.post("/v1/jobs", json=asked, headers=headers)
    assert first.status_code == again.status_code == 202
    assert first.json()["id"] == again.json()["id"]
    assert "idempotent-replayed" not in first.headers
    assert again.headers["idempotent-replayed"] == "true"
    other = running.client.post("/v1/jobs", json=asked | {"options": {}}, headers=headers)
    assert code(other) == (422, "idempotency_key_reused")


@pytest.mark.parametrize("form", [False, True])
def test_identical_posts_at_the_same_moment_make_one_job(running: Running, picture: bytes, form: bool) -> None:
    newest = running.submit(picture)
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    headers = {"Idempotency-Key": str(uuid4())}
    body: dict[str, Any] = (
        {"data": {"kind": "tiny"}, "files": {"image": ("a.png", picture)}}
        if form
        else {"json": {"kind": "tiny", "inputs": {"image": file}}}
    )
    answers: list[httpx.Response] = []
    barrier = threading.Barrier(6)

    def post() -> None:
        barrier.wait()
        answers.append(httpx.post(f"{running.client.base_url}/v1/jobs", headers=headers, timeout=30, **body))

    threads = [threading.Thread(target=post) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [answer.status_code for answer in answers] == [202] * 6
    assert len({answer.json()["id"] for answer in answers}) == 1
    made = running.client.get("/v1/jobs", params={"created_after": newest["created_at"]}).json()["items"]
    assert [job["id"] for job in made] == [answers[0].json()["id"]]
    running.until(answers[0].json()["id"], "succeeded")
    stored = list((running.data_dir / "storage" / "files").iterdir())
    shown = [one.name for one in stored if running.client.get(f"/v1/files/{one.name}").status_code != 200]
    assert shown == [], "the copies that came with the other posts are erased"
