"""The user's own drivers, and the built-in ones beside them."""

from __future__ import annotations

import pytest
from running import Running

from service.drivers.service import LIBRARY
from service.kinds import library


def test_a_driver_is_kept_named_and_erased(running: Running, picture: bytes, video: bytes) -> None:
    created = running.client.post("/v1/drivers", data={"name": "my-wink"}, files={"file": ("w.mp4", video)})
    assert created.status_code == 201
    assert created.json()["source"] == "own"
    assert created.json() in running.client.get("/v1/drivers").json()["items"]
    assert running.client.get(created.json()["url"]).content == video
    again = running.client.post("/v1/drivers", data={"name": "my-wink"}, files={"file": ("w.mp4", video)})
    assert (again.status_code, again.json()["code"]) == (409, "name_taken")

    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file, "driver": "my-wink"}}
    job = running.until(running.client.post("/v1/jobs", json=asked).json()["id"], "succeeded")
    assert job["inputs"] == {"image": file, "driver": "my-wink"}

    stored = running.data_dir / "storage" / "files"
    before = len(list(stored.iterdir()))
    assert running.client.delete("/v1/drivers/my-wink").status_code == 204
    assert running.client.get(created.json()["url"]).status_code == 404
    assert len(list(stored.iterdir())) == before, "the job keeps the video until it is deleted"
    running.client.delete(f"/v1/jobs/{job['id']}")
    assert len(list(stored.iterdir())) == before - 2
    assert running.client.delete("/v1/drivers/my-wink").json()["code"] == "driver_not_found"


@pytest.mark.parametrize(
    "name", ["", "UPPER", "a/b", "..", "a" * 64, "ü", "-a", "00000000-0000-7000-8000-000000000000"]
)
def test_names_that_no_driver_can_have(running: Running, video: bytes, name: str) -> None:
    response = running.client.post("/v1/drivers", data={"name": name}, files={"file": ("w.mp4", video)})
    assert (response.status_code, response.json()["code"]) == (422, "invalid_name")


def test_a_driver_is_a_video(running: Running, picture: bytes) -> None:
    response = running.client.post("/v1/drivers", data={"name": "still"}, files={"file": ("w.png", picture)})
    assert (response.status_code, response.json()["code"]) == (415, "input_wrong_media")


def test_built_in_names_are_taken(running: Running, video: bytes) -> None:
    for name in (*library.names(LIBRARY), "auto"):
        response = running.client.post("/v1/drivers", data={"name": name}, files={"file": ("w.mp4", video)})
        assert response.json()["code"] == "name_taken"
    for name in library.names(LIBRARY):
        assert running.client.delete(f"/v1/drivers/{name}").json()["code"] == "driver_built_in"


def test_built_in_performances_are_listed_first_and_can_be_watched(running: Running) -> None:
    items = running.client.get("/v1/drivers").json()["items"]
    assert [item["name"] for item in items[:3]] == ["idle", "happy", "surprise"]
    assert all(item["source"] == "built-in" and item["title"] and item["seconds"] > 1 for item in items[:3])
    assert items[0]["loops"] is True
    video = running.client.get(items[1]["url"], headers={"Range": "bytes=4-7"})
    assert (video.status_code, video.content) == (206, b"ftyp")


def test_a_job_can_name_a_built_in_performance(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file, "driver": "happy"}}
    job = running.until(running.client.post("/v1/jobs", json=asked).json()["id"], "succeeded", "failed")
    assert job["status"] == "succeeded", job["error"]
    report = running.client.get(job["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"]["driver"] == "happy.mp4"
