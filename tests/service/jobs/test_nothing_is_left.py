"""What was made of a person goes when it is to go: clips once their job has succeeded, where the operator wants that, and all of it
with the job."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
import pytest
from raw_upload import add, create
from running import Running, eventually

MARK = b"nobody else has these bytes: 7f3b09"
NAME = "anna-of-nowhere"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("persons") / "data"
    with Running(folder, kinds="tiny_kind:PERSON", erase_sources="true") as running:
        yield running


def uploaded(service: Running, picture: bytes) -> str:
    """The id of a file that came by a resumable upload."""
    address = create(service, len(picture), **{"Upload-Metadata": "filename YW5uYS1vZi1ub3doZXJlLnBuZw=="})
    half = len(picture) // 2
    add(service, address, 0, picture[:half]).raise_for_status()
    add(service, address, half, picture[half:]).raise_for_status()
    return address.rsplit("/", 1)[-1]


def submit(service: Running, image: str, **options: Any) -> dict[str, Any]:
    asked = {"kind": "person", "inputs": {"image": image}, "options": options, "title": NAME, "metadata": {"who": NAME}}
    sent = {"Prefer": "wait=30", "Idempotency-Key": f"{NAME} {options}"}
    return dict(service.client.post("/v1/jobs", json=asked, headers=sent).raise_for_status().json())


def revise(service: Running, job: dict[str, Any], **asked: Any) -> dict[str, Any]:
    answer = service.client.post(f"/v1/jobs/{job['id']}/revisions", json=asked, headers={"Prefer": "wait=30"})
    return dict(answer.raise_for_status().json())


def rows(data: Path) -> dict[str, list[str]]:
    """All that the database says, by its tables."""
    with sqlite3.connect(f"file:{data / 'galatea.db'}?mode=ro", uri=True) as database:
        tables = [name for (name,) in database.execute("select name from sqlite_master where type = 'table'")]
        return {table: [repr(row) for row in database.execute(f'select * from "{table}"')] for table in tables}


def tables_that_name(data: Path, *words: str) -> set[str]:
    return {table for table, found in rows(data).items() if any(word in row for row in found for word in words)}


def files_that_hold(data: Path, content: bytes) -> list[str]:
    """Files, the database aside, in which these bytes are."""
    found = []
    for path in data.rglob("*"):
        with suppress(FileNotFoundError):  # moved or erased meanwhile
            if path.is_file() and not path.name.startswith("galatea.db") and content in path.read_bytes():
                found.append(str(path.relative_to(data)))
    return found


def folders_of(data: Path, *ids: str) -> list[str]:
    return [str(path.relative_to(data)) for path in data.rglob("*") if any(one in path.name for one in ids)]


def test_a_picture_is_erased_once_its_job_has_succeeded(service: Running, picture: bytes) -> None:
    image = uploaded(service, picture + MARK)
    assert files_that_hold(service.data_dir, MARK) == [f"storage/files/{image}"]
    job = submit(service, image)
    assert job["status"] == "succeeded" and job["inputs"] == {"image": image}
    eventually(lambda: not files_that_hold(service.data_dir, MARK), "the picture is erased")
    assert service.client.get(f"/v1/files/{image}").status_code == 404
    assert not {"files", "uploads", "job_files"} & tables_that_name(service.data_dir, image)


def test_a_revision_lives_on_what_was_found(service: Running, picture: bytes) -> None:
    job = submit(service, uploaded(service, picture), seconds=1.0)
    again = revise(service, job, options={"seconds": 2.0})
    assert again["status"] == "succeeded"
    report = service.client.get(again["artifacts"]["report.json"]["url"]).json()
    assert report["quality"]["reused"] == 1
    third = revise(service, again, options={"seconds": 3.0})
    assert third["status"] == "succeeded"


def test_what_has_to_be_measured_anew_says_why_it_cannot(service: Running, picture: bytes) -> None:
    job = submit(service, uploaded(service, picture), seconds=4.0)
    again = revise(service, job, corrections={"level": 2.0})
    assert (again["status"], again["error"]["code"]) == ("failed", "source_erased")
    assert revise(service, again, corrections={"level": None})["status"] == "succeeded"


def test_a_job_that_failed_keeps_its_picture_until_a_revision_succeeds(service: Running, picture: bytes) -> None:
    image = uploaded(service, picture)
    failed = submit(service, image, crash="refuse")
    assert failed["status"] == "failed"
    assert service.client.get(f"/v1/files/{image}").status_code == 200
    assert revise(service, failed, options={"crash": None})["status"] == "succeeded"
    eventually(lambda: service.client.get(f"/v1/files/{image}").status_code == 404, "the picture is erased")


def test_a_picture_that_another_job_uses_stays_for_it(service: Running, picture: bytes) -> None:
    image = uploaded(service, picture)
    failed = submit(service, image, crash="refuse", level=9.0)
    assert submit(service, image, level=9.0)["status"] == "succeeded"
    assert service.client.get(f"/v1/files/{image}").status_code == 200
    service.client.delete(f"/v1/jobs/{failed['id']}").raise_for_status()
    assert service.client.get(f"/v1/files/{image}").status_code == 404


@pytest.mark.parametrize("erases", ["at its end", "with the job"])
def test_nothing_of_a_person_is_left_when_the_job_is_erased(
    erases: str, service: Running, running: Running, picture: bytes
) -> None:
    if erases == "at its end":
        there, image = service, uploaded(service, picture + MARK)
        jobs = [submit(there, image, seconds=5.0)]
        jobs.append(revise(there, jobs[0], options={"seconds": 6.0}))
    else:  # where the picture itself is published, too
        there, image = running, uploaded(running, picture + MARK)
        asked = {"kind": "tiny", "inputs": {"image": image}, "title": NAME}
        jobs = [there.client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=30"}).raise_for_status().json()]
        jobs.append(revise(there, jobs[0], corrections={"level": 1.0}))
        assert len(files_that_hold(there.data_dir, MARK)) > 1
    ids = [job["id"] for job in jobs]
    assert tables_that_name(there.data_dir, NAME, *ids) >= {"jobs", "artifacts", "events"}
    there.client.post(f"/v1/jobs/{ids[0]}/links", json={}).raise_for_status()
    for one in ids:
        there.client.delete(f"/v1/jobs/{one}").raise_for_status()
    eventually(lambda: folders_of(there.data_dir, *ids, image) == [], "stages, files and artifacts are erased")
    assert files_that_hold(there.data_dir, MARK) == []
    assert tables_that_name(there.data_dir, image, *ids) == set()
    answer: httpx.Response = there.client.get(f"/v1/uploads/{image}")
    assert answer.status_code == 404
