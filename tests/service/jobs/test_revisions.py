"""Revisions: a job again, with corrections; only what depends on them is worked out anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import httpx
import pytest
from running import Running, eventually

from service.ids import new_id


def revise(running: Running, job_id: str, body: dict[str, Any], **headers: str) -> httpx.Response:
    return running.client.post(f"/v1/jobs/{job_id}/revisions", json=body, headers={"Prefer": "wait=30", **headers})


def report(running: Running, job: dict[str, Any]) -> dict[str, Any]:
    return running.client.get(job["artifacts"]["report.json"]["url"]).json()


def problem(response: httpx.Response) -> tuple[int, str]:
    return response.status_code, response.json()["code"]


@pytest.fixture
def done(running: Running, picture: bytes) -> dict[str, Any]:
    """A job that has succeeded."""
    return running.until(running.submit(picture, seconds=0.1)["id"], "succeeded")


def test_a_revision_reuses_stored_stages_and_says_whose_it_is(running: Running, done: dict[str, Any]) -> None:
    response = revise(running, done["id"], {"corrections": {"level": 5.0}})
    assert response.status_code == 202
    revised = response.json()
    assert response.headers["location"] == f"/v1/jobs/{revised['id']}"
    assert revised["status"] == "succeeded"
    assert (revised["revision_of"], revised["tree"]) == (done["id"], done["id"])
    assert revised["inputs"] == done["inputs"]
    assert revised["options"] == {"seconds": 0.1, "level": 5.0}
    before, after = report(running, done)["quality"], report(running, revised)["quality"]
    assert before["reused"] == 0 and after["reused"] == 1
    assert after["mean"] == before["mean"] + 5


def test_options_change_one_by_one_and_null_takes_one_back(running: Running, done: dict[str, Any]) -> None:
    second = revise(running, done["id"], {"options": {"seconds": 0.2, "polls": False}}).json()
    third = revise(running, second["id"], {"options": {"polls": None}}).json()
    assert second["options"] == {"seconds": 0.2, "polls": False}
    assert third["options"] == {"seconds": 0.2}
    assert third["revision_of"] == second["id"] and third["tree"] == done["id"]
    for job in (done, second, third):
        shown = running.client.get(f"/v1/jobs/{job['id']}/revisions").json()["items"]
        assert [(one["id"], one["revision_of"]) for one in shown] == [
            (done["id"], None),
            (second["id"], done["id"]),
            (third["id"], second["id"]),
        ]


def test_a_failed_job_takes_a_revision(running: Running, picture: bytes) -> None:
    failed = running.until(running.submit(picture, crash="refuse")["id"], "failed")
    assert failed["error"]["correctable"] == ["landmarks"]
    mended = revise(running, failed["id"], {"options": {"crash": None}}).json()
    assert mended["status"] == "succeeded"
    assert report(running, mended)["quality"]["reused"] == 1, "the stage that had succeeded was kept"


def test_metadata_is_the_job_s_own_unless_given(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()
    asked = {"kind": "tiny", "inputs": {"image": file["id"]}, "metadata": {"order": 7}}
    job = running.client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=30"}).json()
    assert revise(running, job["id"], {}).json()["metadata"] == {"order": 7}
    assert revise(running, job["id"], {"metadata": {}}).json()["metadata"] == {}


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({"corrections": {"seconds": 1}}, 422, "unknown_correction"),
        ({"corrections": {"level": "high"}}, 422, "invalid_options"),
        ({"options": {"nonsense": 1}}, 422, "invalid_options"),
        ({"inputs": {}}, 422, "invalid_request"),
        ({"metadata": {"much": "x" * 20_000}}, 422, "metadata_too_large"),
    ],
)
def test_what_cannot_be_revised_so(running: Running, done: dict[str, Any], body: dict, status: int, code: str) -> None:
    assert problem(revise(running, done["id"], body)) == (status, code)


@pytest.mark.parametrize(
    ("body", "pointers"),
    [
        ({"corrections": {"level": "high"}}, ["/corrections/level"]),
        ({"options": {"level": "high"}}, ["/options/level"]),
        ({"options": {"polls": "maybe"}, "corrections": {"level": "high"}}, ["/options/polls", "/corrections/level"]),
        (
            {"options": {"level": 1, "nonsense": 1}, "corrections": {"level": []}},
            ["/corrections/level", "/options/nonsense"],
        ),
    ],
)
def test_what_is_wrong_is_shown_where_the_request_has_it(
    running: Running, done: dict[str, Any], body: dict, pointers: list[str]
) -> None:
    answer = revise(running, done["id"], body).json()
    assert [error["pointer"] for error in answer["errors"]] == pointers
    assert answer["detail"].startswith(pointers[0])


def test_a_correction_may_be_a_file(running: Running, picture: bytes) -> None:
    """It is an input of the new job, stays with its revisions until it is taken back, and lives as long as they do."""
    job = running.until(running.submit(picture)["id"], "succeeded")
    mask = running.client.post("/v1/files", files={"file": picture + bytes(3)}).json()["id"]
    second = revise(running, job["id"], {"corrections": {"mask": mask, "level": 5.0}}).json()
    assert second["inputs"] == {**job["inputs"], "mask": mask} and second["options"] == {"level": 5.0}
    assert report(running, second)["inputs"]["mask"] == len(picture) + 3
    third = revise(running, second["id"], {"corrections": {"level": 6.0}}).json()
    assert third["inputs"] == second["inputs"]
    fourth = revise(running, third["id"], {"corrections": {"mask": None}}).json()
    assert fourth["inputs"] == job["inputs"] and "mask" not in report(running, fourth)["inputs"]
    running.client.delete(f"/v1/jobs/{second['id']}").raise_for_status()
    assert running.client.get(f"/v1/files/{mask}").status_code == 200
    running.client.delete(f"/v1/jobs/{third['id']}").raise_for_status()
    assert running.client.get(f"/v1/files/{mask}").status_code == 404, "the fourth does not use it"
    assert running.client.get(f"/v1/files/{job['inputs']['image']}").status_code == 200


def test_a_form_carries_the_file_of_a_correction(running: Running, done: dict[str, Any], picture: bytes) -> None:
    def send(mask: bytes, **headers: str) -> httpx.Response:
        parts = {"corrections": '{"level": 3}', "metadata": '{"order": 8}'}
        sent = {"data": parts, "files": {"mask": ("m.png", mask)}, "headers": {"Prefer": "wait=30", **headers}}
        return running.client.post(f"/v1/jobs/{done['id']}/revisions", **sent)

    key = {"Idempotency-Key": new_id()}
    first = send(picture, **key).json()
    assert set(first["inputs"]) == {"image", "mask"} and first["metadata"] == {"order": 8}
    after = report(running, first)
    assert (after["inputs"]["mask"], after["quality"]["reused"]) == (len(picture), 1)
    assert send(picture, **key).json()["id"] == first["id"]
    assert problem(send(picture + b"0", **key)) == (422, "idempotency_key_reused")
    text = running.client.post(
        f"/v1/jobs/{done['id']}/revisions", files={"mask": (None, first["inputs"]["mask"])}
    ).json()
    assert text["inputs"] == first["inputs"]


def test_a_correction_may_be_an_address(running: Running, done: dict[str, Any]) -> None:
    asked = {"corrections": {"mask": "http://127.0.0.1:9/mask.png"}}
    failed = revise(running, done["id"], asked).json()
    assert failed["inputs"]["mask"] == asked["corrections"]["mask"]
    assert (failed["status"], failed["error"]["code"]) == ("failed", "input_url_unreachable")
    assert problem(revise(running, done["id"], {"corrections": {"mask": "http://10.0.0.1/m.png"}})) == (
        422,
        "input_url_refused",
    )


def test_files_that_are_no_correction(running: Running, done: dict[str, Any], video: bytes) -> None:
    film = running.client.post("/v1/files", files={"file": ("v.mp4", video)}).json()["id"]
    key = running.client.post("/v1/keys", json={"name": "other", "scopes": ["submit"]}).json()["token"]
    theirs = {"Authorization": f"Bearer {key}"}
    other = running.client.post("/v1/files", files={"file": ("v.mp4", video)}, headers=theirs).json()["id"]
    for value, code in (
        (film, "input_wrong_media"),
        (other, "unknown_file"),
        ("mask.png", "unknown_file"),
        (7, "invalid_request"),
        ([film, film], "too_many_files"),
    ):
        answer = revise(running, done["id"], {"corrections": {"mask": value}})
        assert problem(answer) == (422, code)
        assert answer.json()["errors"][0]["pointer"] == "/corrections/mask"
    assert problem(revise(running, done["id"], {"corrections": {"image": film}})) == (422, "unknown_correction")


def test_a_job_that_is_not_there_or_not_done_takes_none(running: Running, picture: bytes) -> None:
    assert problem(revise(running, new_id(), {})) == (404, "job_not_found")
    assert running.client.get(f"/v1/jobs/{new_id()}/revisions").status_code == 404
    job = running.submit(picture, seconds=3000)
    assert problem(revise(running, job["id"], {})) == (409, "job_not_finished")
    running.client.post(f"/v1/jobs/{job['id']}/cancel").raise_for_status()
    assert revise(running, job["id"], {"options": {"seconds": 0}}).json()["status"] == "succeeded"


def test_one_key_makes_one_revision(running: Running, done: dict[str, Any]) -> None:
    key = {"Idempotency-Key": new_id()}
    first = revise(running, done["id"], {"corrections": {"level": 1}}, **key)
    again = revise(running, done["id"], {"corrections": {"level": 1}}, **key)
    assert first.json()["id"] == again.json()["id"]
    assert again.headers["idempotent-replayed"] == "true"
    assert problem(revise(running, done["id"], {"corrections": {"level": 2}}, **key)) == (422, "idempotency_key_reused")


def test_what_a_revision_still_uses_outlives_the_job(start: Callable[..., Running], picture: bytes) -> None:
    """Files and stages go with the last of the tree, and then nothing is left."""
    running = start()
    job = running.until(running.submit(picture)["id"], "succeeded")
    child = revise(running, job["id"], {"corrections": {"level": 1}}).json()
    folder, file = running.data_dir / "jobs" / job["id"], job["inputs"]["image"]
    assert running.client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert (folder / "stages").is_dir()
    assert running.client.get(f"/v1/files/{file}").status_code == 200
    shown = running.client.get(f"/v1/jobs/{child['id']}/revisions").json()["items"]
    assert [one["id"] for one in shown] == [child["id"]]
    third = revise(running, child["id"], {"corrections": {"level": 2}}).json()
    assert report(running, third)["quality"]["reused"] == 1
    for one in (child, third):
        assert running.client.delete(f"/v1/jobs/{one['id']}").status_code == 204
    assert running.client.get(f"/v1/files/{file}").status_code == 404
    eventually(lambda: not list((running.data_dir / "jobs").iterdir()), "the folders are gone")
    assert not [path for path in (running.data_dir / "storage").rglob("*") if path.is_file()]
