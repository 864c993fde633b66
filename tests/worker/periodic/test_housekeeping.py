"""What is erased, and what is not."""

from __future__ import annotations

import os
import time
from datetime import timedelta
from io import BytesIO
from pathlib import Path

from sqlalchemy import select, update

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.tables.files import File
from service.tables.jobs import Job, JobFile
from service.tables.kept import Driver
from service.tables.uploads import Upload
from service.uploads import spool
from service.uploads.service import create
from worker.periodic.housekeeping import keep_house


def stored(context: Context, age: timedelta = timedelta(0), recorded: bool = True) -> File:
    file = File(
        id=new_id(), owner="local", name="a", content_type="image/png", size=3, sha256="0" * 64, created_at=now() - age
    )
    context.storage.put(file.key, BytesIO(b"abc"))
    made_old(context.storage.local(file.key), age)
    if recorded:
        with context.database.write() as session:
            session.add(file)
    return file


def made_old(path: Path, age: timedelta) -> None:
    moment = time.time() - age.total_seconds()
    os.utime(path, (moment, moment))


def job(context: Context, file: File | None = None) -> Job:
    made = Job(
        id=new_id(),
        owner="local",
        **{"kind": "tiny", "status": "succeeded", "inputs": {}, "sources": {}, "options": {}, "notes": {}},
        **{"progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with context.database.write() as session:
        session.add(made)
        session.flush()
        if file is not None:
            session.add(JobFile(job_id=made.id, file_id=file.id))
    return made


def test_uploads_that_nothing_uses_are_erased_after_a_day(context: Context) -> None:
    old, older = timedelta(hours=23), timedelta(hours=25)
    unused, young, of_job, of_driver = (stored(context, age) for age in (older, old, older, older))
    job(context, of_job)
    with context.database.write() as session:
        session.add(Driver(owner="local", name="mine", file_id=of_driver.id, created_at=now()))
    keep_house(context)
    assert not context.storage.local(unused.key).exists()
    for kept in (young, of_job, of_driver):
        assert context.storage.local(kept.key).exists()


def test_what_lies_there_without_a_record_is_erased_once_nobody_can_be_at_it(context: Context) -> None:
    data = context.settings.data_dir
    orphan, fresh = (stored(context, age, recorded=False) for age in (timedelta(hours=2), timedelta(0)))
    known = job(context)
    for name in (known.id, "00000000-0000-7000-8000-000000000000"):
        (data / "jobs" / name / "stages").mkdir(parents=True)
        made_old(data / "jobs" / name, timedelta(hours=2))
    of_upload = upload(context, timedelta(0))
    for name, hours in (("abandoned", 2), ("begun", 0), (of_upload.id, 2)):
        (data / "uploads" / name).write_bytes(b"x")
        made_old(data / "uploads" / name, timedelta(hours=hours))
    (data / "incoming").mkdir()
    for name, hours in (("left", 2), ("coming", 0)):
        (data / "incoming" / name).write_bytes(b"x")
        made_old(data / "incoming" / name, timedelta(hours=hours))
    keep_house(context)
    assert not context.storage.local(orphan.key).exists()
    assert context.storage.local(fresh.key).exists()
    assert [path.name for path in (data / "jobs").iterdir()] == [known.id]
    assert [path.name for path in (data / "incoming").iterdir()] == ["coming"]
    assert {path.name for path in (data / "uploads").iterdir()} == {"begun", of_upload.id}


def upload(context: Context, age: timedelta) -> Upload:
    begun = create(context, "local", 10_000, None)
    with context.database.write() as session:
        session.execute(update(Upload).where(Upload.id == begun.id).values(expires_at=begun.expires_at - age))
    return begun


def test_uploads_are_erased_when_they_expire_and_not_before(context: Context) -> None:
    expired, alive = (upload(context, timedelta(hours=hours)) for hours in (25, 23))
    file = stored(context)
    finished = upload(context, timedelta(hours=25))
    with context.database.write() as session:
        session.execute(update(Upload).where(Upload.id == finished.id).values(file_id=file.id))
    keep_house(context)
    with context.database.read() as session:
        assert set(session.scalars(select(Upload.id))) == {alive.id, finished.id}
    assert not spool.path(context.settings, expired.id).exists()
    assert spool.path(context.settings, alive.id).exists()
