"""The user's own drivers, and the built-in ones beside them."""

from __future__ import annotations

import pytest
from running import Running

from engine.performances import PERFORMANCE_STATES
from service.catalogue import built_in
from service.libraries.library import DRIVER_LIBRARY


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


def test_a_driver_takes_another_name(running: Running, picture: bytes, video: bytes) -> None:
    for name in ("first", "other"):
        running.client.post("/v1/drivers", data={"name": name}, files={"file": ("w.mp4", video)}).raise_for_status()
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file, "driver": "first"}}
    job = running.until(running.client.post("/v1/jobs", json=asked).json()["id"], "succeeded")

    def rename(name: str, new: object) -> tuple[int, str | None]:
        answer = running.client.patch(f"/v1/drivers/{name}", json={"name": new})
        return answer.status_code, answer.json().get("code")

    assert rename("first", "other") == (409, "name_taken")
    assert rename("first", "happy") == (409, "name_taken")
    assert rename("first", "auto") == (409, "name_taken")
    assert rename("first", "Not a name") == (422, "invalid_name")
    assert rename("first", None) == (422, "invalid_request")
    assert rename("happy", "glad") == (409, "driver_built_in")
    assert rename("nobody", "somebody") == (404, "driver_not_found")
    assert rename("first", "first") == (200, None)
    renamed = running.client.patch("/v1/drivers/first", json={"name": "second"}).raise_for_status().json()
    assert (renamed["name"], renamed["url"]) == ("second", "/v1/drivers/second/video")
    assert running.client.get(renamed["url"]).content == video
    assert running.client.get("/v1/drivers/first").json()["code"] == "driver_not_found"
    assert renamed == running.client.get("/v1/drivers/second").json()

    assert running.job(job["id"]) == job, "a job shows the name that it was given"
    revised = running.client.post(
        f"/v1/jobs/{job['id']}/revisions", json={"corrections": {"level": 2}}, headers={"Prefer": "wait=60"}
    )
    assert revised.json()["status"] == "succeeded", "and can be revised"
    asked["inputs"]["driver"] = "first"
    assert running.client.post("/v1/jobs", json=asked).json()["code"] == "unknown_driver"
    asked["inputs"]["driver"] = "second"
    assert running.client.post("/v1/jobs", json=asked).status_code == 202
    for name in ("second", "other"):
        running.client.delete(f"/v1/drivers/{name}").raise_for_status()


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
    for name in (*DRIVER_LIBRARY.built_in, "auto"):
        response = running.client.post("/v1/drivers", data={"name": name}, files={"file": ("w.mp4", video)})
        assert response.json()["code"] == "name_taken"
    for name in DRIVER_LIBRARY.built_in:
        assert running.client.delete(f"/v1/drivers/{name}").json()["code"] == "driver_built_in"


def test_built_in_performances_are_listed_first_and_can_be_watched(running: Running) -> None:
    items = running.client.get("/v1/drivers").json()["items"]
    names = list(DRIVER_LIBRARY.built_in)
    assert [item["name"] for item in items[: len(names)]] == names
    assert {"idle", "happy", "surprise"} <= set(names)
    for item in items[: len(names)]:
        assert item["source"] == "built-in" and item["title"] and item["seconds"] > 1
        assert item == running.client.get(f"/v1/drivers/{item['name']}").json()
    assert items[0]["loops"] is True
    assert {(item["state"], item["strength"]) for item in items[: len(names)]} == {
        (state, strength) for state in PERFORMANCE_STATES for strength in ("normal", "strong")
    }
    video = running.client.get(items[1]["url"], headers={"Range": "bytes=4-7"})
    assert (video.status_code, video.content) == (206, b"ftyp")


def test_a_small_picture_shows_each_built_in_performance(running: Running) -> None:
    for name in DRIVER_LIBRARY.built_in:
        address = running.client.get(f"/v1/drivers/{name}").json()["poster"]
        answer = running.client.get(address)
        assert (answer.status_code, answer.headers["Content-Type"]) == (200, "image/jpeg")
        assert answer.content.startswith(b"\xff\xd8\xff") and len(answer.content) < 40_000
        again = running.client.get(address, headers={"If-None-Match": answer.headers["ETag"]})
        assert again.status_code == 304


def test_own_drivers_have_no_picture_and_unknown_ones_nothing(running: Running, video: bytes) -> None:
    running.client.post("/v1/drivers", data={"name": "mine"}, files={"file": ("w.mp4", video)})
    assert running.client.get("/v1/drivers/mine").json()["poster"] is None
    assert running.client.get("/v1/drivers/mine/poster").json()["code"] == "poster_not_found"
    running.client.delete("/v1/drivers/mine")
    for path in ("", "/poster", "/video"):
        answer = running.client.get(f"/v1/drivers/mine{path}")
        assert (answer.status_code, answer.json()["code"]) == (404, "driver_not_found")


def test_a_job_can_name_a_built_in_performance(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file, "driver": "happy"}}
    job = running.until(running.client.post("/v1/jobs", json=asked).json()["id"], "succeeded", "failed")
    assert job["status"] == "succeeded", job["error"]
    report = running.client.get(job["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"]["driver"] == "happy.mp4"


def test_auto_offers_the_library_and_ones_own_drivers_to_the_job(
    running: Running, picture: bytes, video: bytes
) -> None:
    running.client.post("/v1/drivers", data={"name": "own"}, files={"file": ("w.mp4", video)})
    file = running.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "tiny", "inputs": {"image": file, "driver": "auto"}}
    job = running.until(running.client.post("/v1/jobs", json=asked).json()["id"], "succeeded", "failed")
    assert job["status"] == "succeeded", job["error"]
    assert job["inputs"]["driver"] == "auto"
    report = running.client.get(job["artifacts"]["report.json"]["url"]).json()
    installed = {name: built_in.item(DRIVER_LIBRARY.name, name).stat().st_size for name in DRIVER_LIBRARY.built_in}
    assert report["inputs"]["candidates"] == {**installed, "own": len(video)}

    # a revision chooses from the same files, the driver's deletion notwithstanding
    running.client.delete("/v1/drivers/own")
    again = running.client.post(f"/v1/jobs/{job['id']}/revisions", json={"corrections": {"level": 1.0}}).json()
    again = running.until(again["id"], "succeeded", "failed")
    report = running.client.get(again["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"]["candidates"]["own"] == len(video)
