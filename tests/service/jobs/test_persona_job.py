"""Personas as jobs: an archive of photos uploaded, a puppet filmed behind walls by a job that was killed on the way, and driven
again by the job's id."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from running import Running, eventually

from engine.persona.sample import write_sample_photos

OPTIONS = {"size": [160, 200], "trim": [0.5, 0.8], "fps": 10, "texture_width": 97}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("personas") / "data"
    with Running(folder, kinds="engine.kinds:KINDS", worker_kinds="persona") as running:
        yield running


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("photos")
    with zipfile.ZipFile(folder / "album.zip", "w") as packed:
        for photo in write_sample_photos(folder):
            packed.write(photo, f"album/{photo.name}")
    return folder / "album.zip"


def ended(service: Running, job: str) -> dict[str, Any]:
    eventually(lambda: service.job(job)["finished_at"], "the job is over", seconds=300)
    return service.job(job)


def ordered(service: Running, options: dict[str, Any], **inputs: Any) -> str:
    order = {"kind": "persona", "options": options, "inputs": inputs}
    return str(service.client.post("/v1/jobs", json=order).raise_for_status().json()["id"])


@dataclass(frozen=True)
class Interrupted:
    """A job whose process was killed in mid learning: what it came to, how often it began, the folders of what was stored before
    with their index nodes and times, and again after."""

    job: dict[str, Any]
    runs: int
    before: dict[Path, tuple[int, int]]
    after: dict[Path, tuple[int, int]]


@pytest.fixture(scope="module")
def interrupted(service: Running, archive: Path) -> Interrupted:
    upload = {"file": ("album.zip", archive.read_bytes(), "application/zip")}
    file = service.client.post("/v1/files", files=upload).raise_for_status().json()
    assert file["content_type"] == "application/zip"
    job = ordered(service, OPTIONS, photos=[file["id"]], driver="happy")
    eventually(lambda: service.job(job)["progress"]["stage"] == "learn_persona", "its faces are found", seconds=300)
    folder = service.data_dir / "jobs" / job / "stages"
    before = {found: (found.stat().st_ino, found.stat().st_mtime_ns) for found in folder.glob("[!.]*")}
    processes = service.processes("worker.job_process.child")
    ready = {process.pid for process in processes}
    for process in processes:
        if process.ppid() in ready:
            process.kill()
    done = ended(service, job)
    with service.client.stream("GET", f"/v1/jobs/{job}/events") as events:
        runs = events.read().decode().count('{"status": "running"}')
    return Interrupted(done, runs, before, {one: (one.stat().st_ino, one.stat().st_mtime_ns) for one in before})


@pytest.fixture(scope="module")
def made(interrupted: Interrupted) -> dict[str, Any]:
    return interrupted.job


def test_an_archive_becomes_a_persona_and_a_film(made: dict[str, Any]) -> None:
    assert made["status"] == "succeeded", made["error"]
    left = set(made["artifacts"])
    assert left >= {"persona.npz", "average.png", "faces.json", "faces.jpg", "animation.mp4", "report.json"}


def test_another_performance_names_the_job_and_needs_no_photos(service: Running, made: dict[str, Any]) -> None:
    again = ended(service, ordered(service, OPTIONS, persona=made["id"], driver="surprise"))
    assert again["status"] == "succeeded", again["error"]
    assert "animation.mp4" in again["artifacts"]


def test_left_out_faces_are_a_correction(service: Running, made: dict[str, Any]) -> None:
    change = {"corrections": {"leave_out": [0, 1]}}
    revision = service.client.post(f"/v1/jobs/{made['id']}/revisions", json=change).raise_for_status().json()
    revised = ended(service, revision["id"])
    assert revised["status"] == "succeeded", revised["error"]
    faces = service.client.get(f"/v1/jobs/{revised['id']}/artifacts/faces.json").raise_for_status().json()["faces"]
    assert [face["reason"] for face in faces[:2]] == ["left_out", "left_out"]


def test_too_few_are_refused_and_the_faces_are_there_to_see(service: Running, archive: Path) -> None:
    with zipfile.ZipFile(archive) as packed:
        photos = [packed.read(name) for name in packed.namelist()[:4]]
    files = [("photos", (f"{k}.jpg", photo, "image/jpeg")) for k, photo in enumerate(photos)]
    order = {"kind": "persona", "options": json.dumps(OPTIONS), "driver": "happy"}
    job = service.client.post("/v1/jobs", data=order, files=files).raise_for_status().json()["id"]
    failed = ended(service, job)
    assert (failed["status"], failed["error"]["code"]) == ("failed", "too_few_photos")
    assert {"faces.json", "faces.jpg"} <= set(failed["artifacts"])


def test_a_persona_of_something_else_is_refused(service: Running, archive: Path) -> None:
    files = {"persona": ("album.zip", archive.read_bytes(), "application/zip")}
    order = {"kind": "persona", "options": json.dumps(OPTIONS), "driver": "happy"}
    job = service.client.post("/v1/jobs", data=order, files=files).raise_for_status().json()["id"]
    assert ended(service, job)["error"]["code"] == "persona_unreadable"


def test_a_killed_job_goes_on_from_the_stage_that_is_stored(interrupted: Interrupted) -> None:
    assert interrupted.job["status"] == "succeeded", interrupted.job["error"]
    assert interrupted.runs == 2
    assert len(interrupted.before) >= 2, "the photographs, and the faces in them"
    for found, (node, time) in interrupted.before.items():
        now, used = interrupted.after[found]  # a store marks what it gives away, and makes anew what it cannot read
        assert now == node and used > time, "taken from what was stored"


def test_erasing_a_persona_erases_all_that_was_made_of_the_photos(service: Running, made: dict[str, Any]) -> None:
    film = ended(service, ordered(service, OPTIONS, persona=made["id"], driver="happy"))
    photos = made["inputs"]["photos"]
    versions = service.client.get(f"/v1/jobs/{made['id']}/revisions").raise_for_status().json()["items"]
    for version in versions:
        service.client.delete(f"/v1/jobs/{version['id']}").raise_for_status()
    assert service.client.get(f"/v1/jobs/{film['id']}").status_code == 404
    assert [service.client.get(f"/v1/files/{one}").status_code for one in photos] == [404]
    assert not any((service.data_dir / "jobs" / job["id"]).exists() for job in (*versions, film))
