"""A new driver of one's own is searched for segments; a job can name one; they go with the driver."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from running import Running, eventually

from benchmarks.driver_segments import Stretch, Tally, join, judge
from engine.performances import PERFORMANCE_STATES
from engine.portrait.driver_segments.pipeline import DriverSegment

KINDS = "tiny_kind:KIND,engine.kinds:KINDS"


@pytest.fixture(scope="module")
def searching(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service with the engine's own kinds."""
    data = tmp_path_factory.mktemp("searching") / "data"
    service = Running(data, kinds=KINDS, worker_kinds="tiny,portrait,moments")
    yield service
    service.stop()


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, list[Stretch]]:
    """A driver that shows two things, and what it shows."""
    path = tmp_path_factory.mktemp("clip") / "me.mp4"
    truth = join(["surprise", "anger"], path)
    return path.read_bytes(), truth


def create(service: Running, name: str, video: bytes, **headers: str) -> dict[str, Any]:
    asked = {"data": {"name": name}, "files": {"file": ("me.mp4", video)}, "headers": headers}
    return service.client.post("/v1/drivers", **asked).raise_for_status().json()


def searched(service: Running, name: str) -> dict[str, Any]:
    """The driver once the search has ended."""

    def driver() -> dict[str, Any]:
        return service.client.get(f"/v1/drivers/{name}").raise_for_status().json()

    eventually(lambda: driver()["moments_status"] != "pending", "the search ends", 400)
    return driver()


@pytest.fixture
def mine(searching: Running, clip: tuple[bytes, list[Stretch]]) -> dict[str, Any]:
    """A driver that was searched. A test may have it searched again."""
    if searching.client.get("/v1/drivers/me").status_code == 404:
        created = create(searching, "me", clip[0])
        assert (created["moments_status"], created["moments"]) == ("pending", [])
    return searched(searching, "me")


def test_what_a_driver_shows_is_told_and_can_be_looked_at(
    searching: Running, mine: dict[str, Any], clip: tuple[bytes, list[Stretch]]
) -> None:
    assert mine["moments_status"] == "ready" and mine["seconds"] == pytest.approx(6.2, abs=0.1)
    fields = ("name", "state", "strength", "start", "end", "apex", "score")
    segments = [DriverSegment(**{field: one[field] for field in fields}) for one in mine["moments"]]
    assert judge({state: Tally() for state in PERFORMANCE_STATES}, segments, clip[1]) == []
    assert mine in searching.client.get("/v1/drivers").json()["items"]
    for one in mine["moments"]:
        assert one["url"] == f"/v1/drivers/me/video#t={one['start']:g},{one['end']:g}"
        assert one["seconds"] == pytest.approx(one["end"] - one["start"])
    for address in [mine["poster"], *(one["poster"] for one in mine["moments"])]:
        answer = searching.client.get(address)
        assert (answer.status_code, answer.headers["Content-Type"]) == (200, "image/jpeg")
        assert Image.open(BytesIO(answer.content)).size == (256, 256)
        assert searching.client.get(address, headers={"If-None-Match": answer.headers["ETag"]}).status_code == 304
    answer = searching.client.get("/v1/drivers/me/moments/happy/poster")
    assert (answer.status_code, answer.json()["code"]) == (404, "moment_not_found")


def test_a_job_is_driven_by_a_segment_alone(searching: Running, mine: dict[str, Any]) -> None:
    anger = next(one for one in mine["moments"] if one["name"] == "anger")
    portrait = searching.client.get("/v1/drivers/happy/poster").content
    file = searching.client.post("/v1/files", files={"file": ("face.jpg", portrait)}).json()["id"]
    asked = {"kind": "portrait", "inputs": {"image": file, "driver": "me/anger"}, "options": {"size": [256, 256]}}
    job = searching.client.post("/v1/jobs", json=asked).raise_for_status().json()
    assert job["inputs"]["driver"] == "me/anger"
    assert job["options"]["trim"] == [anger["start"], anger["end"]]
    job = searching.until(job["id"], "succeeded", "failed", seconds=180)
    assert job["status"] == "succeeded", job["error"]
    report = searching.client.get(job["artifacts"]["report.json"]["url"]).json()["inputs"]
    assert report["frames"] == pytest.approx(30 * anger["seconds"], abs=2)
    searching.client.delete(f"/v1/jobs/{job['id']}")


@pytest.mark.parametrize(
    ("driver", "options", "code"),
    [
        ("me/fear", {}, "unknown_moment"),
        ("me/", {}, "unknown_moment"),
        ("nobody/anger", {}, "unknown_driver"),
        ("happy/anger", {}, "unknown_driver"),
        ("me/anger", {"trim": [0, 1]}, "portion_and_trim"),
    ],
)
def test_what_cannot_be_named(
    searching: Running, mine: dict[str, Any], picture: bytes, driver: str, options: dict[str, Any], code: str
) -> None:
    file = searching.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "portrait", "inputs": {"image": file, "driver": driver}, "options": options}
    answer = searching.client.post("/v1/jobs", json=asked)
    assert (answer.status_code, answer.json()["code"]) == (422, code)
    assert answer.json()["errors"][0]["pointer"] == "/inputs/driver"


def test_what_was_found_goes_with_a_driver_to_its_new_name(
    searching: Running, mine: dict[str, Any], picture: bytes
) -> None:
    renamed = searching.client.patch("/v1/drivers/me", json={"name": "myself"}).raise_for_status().json()
    assert [one["name"] for one in renamed["moments"]] == [one["name"] for one in mine["moments"]]
    assert (renamed["moments_status"], renamed["moments_job"]) == ("ready", mine["moments_job"])
    assert searching.client.get(renamed["moments"][0]["poster"]).status_code == 200
    file = searching.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "portrait", "inputs": {"image": file, "driver": "myself/anger"}}
    job = searching.client.post("/v1/jobs", json=asked).raise_for_status().json()
    assert job["options"]["trim"][0] == next(one["start"] for one in mine["moments"] if one["name"] == "anger")
    searching.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()
    assert searching.client.patch("/v1/drivers/myself", json={"name": "me"}).json() == mine


def test_a_job_of_a_segment_is_the_same_when_it_is_sent_again_after_the_driver_was_erased(
    searching: Running, clip: tuple[bytes, list[Stretch]], picture: bytes
) -> None:
    create(searching, "brief", clip[0])
    searched(searching, "brief")
    file = searching.client.post("/v1/files", files={"file": picture}).json()["id"]
    asked = {"kind": "portrait", "inputs": {"image": file, "driver": "brief/surprise"}}
    headers = {"Idempotency-Key": "brief-1"}
    job = searching.client.post("/v1/jobs", json=asked, headers=headers).raise_for_status().json()
    searching.client.delete("/v1/drivers/brief").raise_for_status()
    again = searching.client.post("/v1/jobs", json=asked, headers=headers).raise_for_status()
    assert again.json()["id"] == job["id"] and again.headers["Idempotent-Replayed"] == "true"
    searching.client.delete(f"/v1/jobs/{job['id']}")


def test_all_that_was_found_goes_with_the_driver(searching: Running, clip: tuple[bytes, list[Stretch]]) -> None:
    def kept() -> set[Path]:
        folders = [searching.data_dir / name for name in ("storage", "cache", "jobs")]
        return {path for folder in folders for path in folder.rglob("*") if path.is_file()}

    before = kept()
    # other bytes, so that nothing of another driver is shared
    created = create(searching, "gone", clip[0] + bytes(8))
    assert searched(searching, "gone")["moments_status"] == "ready"
    assert any(path.parts[-4:-2] != () and "cache" in path.parts for path in kept() - before), "the analysis is kept"
    assert searching.client.delete("/v1/drivers/gone").status_code == 204
    assert searching.client.get(f"/v1/jobs/{created['moments_job']}").status_code == 404
    assert searching.client.get("/v1/drivers/gone/poster").status_code == 404
    assert searching.client.get("/v1/drivers/gone/moments/anger/poster").json()["code"] == "driver_not_found"
    assert kept() <= before


def test_a_search_can_be_asked_for_again(searching: Running, mine: dict[str, Any]) -> None:
    answer = searching.client.post("/v1/drivers/me/moments")
    assert answer.status_code == 202 and answer.json()["moments_status"] in ("pending", "ready")
    again = searched(searching, "me")
    assert again["moments_job"] != mine["moments_job"]
    assert [one["name"] for one in again["moments"]] == [one["name"] for one in mine["moments"]]
    assert searching.client.get(f"/v1/jobs/{mine['moments_job']}").status_code == 404
    answer = searching.client.post("/v1/drivers/happy/moments")
    assert (answer.status_code, answer.json()["code"]) == (409, "driver_built_in")
    assert searching.client.post("/v1/drivers/nobody/moments").json()["code"] == "driver_not_found"


def test_another_key_sees_nothing_of_it(searching: Running, mine: dict[str, Any], picture: bytes) -> None:
    token = searching.client.post("/v1/keys", json={"name": "other", "scopes": ["read", "submit"]}).json()["token"]
    headers = {"Authorization": f"Bearer {token}"}
    assert "me" not in [one["name"] for one in searching.client.get("/v1/drivers", headers=headers).json()["items"]]
    for method, path in (("GET", ""), ("GET", "/poster"), ("GET", "/moments/anger/poster"), ("POST", "/moments")):
        answer = searching.client.request(method, f"/v1/drivers/me{path}", headers=headers)
        assert (answer.status_code, answer.json()["code"]) == (404, "driver_not_found")
    file = searching.client.post("/v1/files", files={"file": picture}, headers=headers).json()["id"]
    asked = {"kind": "portrait", "inputs": {"image": file, "driver": "me/anger"}}
    assert searching.client.post("/v1/jobs", json=asked, headers=headers).json()["code"] == "unknown_driver"


def test_a_driver_is_kept_though_its_search_must_wait(
    searching: Running, clip: tuple[bytes, list[Stretch]], picture: bytes
) -> None:
    limits = {"name": "one", "scopes": ["read", "submit"], "jobs_at_once": 1}
    token = searching.client.post("/v1/keys", json=limits).raise_for_status().json()["token"]
    headers = {"Authorization": f"Bearer {token}"}
    file = searching.client.post("/v1/files", files={"file": picture}, headers=headers).json()["id"]
    job = {"kind": "tiny", "inputs": {"image": file}, "options": {"seconds": 60}}
    job = searching.client.post("/v1/jobs", json=job, headers=headers).raise_for_status().json()
    assert create(searching, "later", clip[0], **headers)["moments_status"] == "none"
    answer = searching.client.post("/v1/drivers/later/moments", headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (429, "too_many_jobs")
    searching.client.post(f"/v1/jobs/{job['id']}/cancel", headers=headers).raise_for_status()
    answer = searching.client.post("/v1/drivers/later/moments", headers=headers)
    assert (answer.status_code, answer.json()["moments_status"]) == (202, "pending")
    searching.client.delete("/v1/drivers/later", headers=headers).raise_for_status()
    assert searching.client.get("/v1/jobs?kind=moments", headers=headers).json()["items"] == [], "a search stops too"


def test_a_search_that_fails_says_so_and_the_driver_stays(searching: Running, video: bytes) -> None:
    create(searching, "broken", video)
    driver = searched(searching, "broken")
    assert (driver["moments_status"], driver["moments"], driver["poster"]) == ("failed", [], None)
    job = searching.job(driver["moments_job"])
    assert job["kind"] == "moments" and job["metadata"] == {"driver": "broken"} and job["error"]["code"]
    searching.client.delete(f"/v1/jobs/{job['id']}")
    driver = searching.client.get("/v1/drivers/broken").json()
    assert (driver["moments_status"], driver["moments_job"]) == ("none", None)
    searching.client.delete("/v1/drivers/broken").raise_for_status()
