"""What was found in a kept file is what the job that inspected it has left, and no more."""

from __future__ import annotations

import json
from io import BytesIO
from typing import Any

import pytest
from pydantic import BaseModel

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.libraries.inspections import MAX_DOCUMENT_BYTES, Inspection, inspections_of
from service.libraries.library import MOTION_LIBRARY
from service.tables.artifacts import Artifact
from service.tables.jobs import Job
from service.tables.kept import Motion


class Found(BaseModel):
    """What a test's inspections write."""

    joints: int


def kept(context: Context, status: str | None, document: bytes | None = None, **more: Any) -> Motion:
    """A kept file whose inspection has come to this status, and left this document."""
    motion = Motion(owner="local", name="mine", file_id="file", inspection_job=None, created_at=now())
    if status is None:
        return motion
    motion.inspection_job = new_id()
    with context.database.write() as session:
        session.add(
            Job(
                **{"id": motion.inspection_job, "owner": "local", "kind": "motion", "status": status, "inputs": {}},
                **{
                    "sources": {},
                    "options": {},
                    "notes": {},
                    "progress": {},
                    "created_at": now(),
                    "enqueued_at": now(),
                },
                **more,
            )
        )
        session.flush()
        if document is not None:
            artifact = Artifact(
                **{
                    "id": new_id(),
                    "job_id": motion.inspection_job,
                    "name": MOTION_LIBRARY.document,
                    "sha256": "0" * 64,
                },
                **{"content_type": "application/json", "size": len(document), "created_at": now()},
            )
            session.add(artifact)
            session.flush()
            context.storage.put(artifact.key, BytesIO(document))
    return motion


def inspection(context: Context, motion: Motion) -> Inspection[Found]:
    return inspections_of(context, MOTION_LIBRARY, Found, [motion])["mine"]


@pytest.mark.parametrize(
    ("status", "expected"), [(None, "none"), ("queued", "pending"), ("running", "pending"), ("canceled", "failed")]
)
def test_its_status_is_that_of_the_job(context: Context, status: str | None, expected: str) -> None:
    assert inspection(context, kept(context, status)) == Inspection(expected)


def test_what_it_found_is_read_and_why_it_failed_is_told(context: Context) -> None:
    assert inspection(context, kept(context, "succeeded", b'{"joints": 31}')) == Inspection("ready", Found(joints=31))
    error = {"code": "motion_unreadable", "detail": "It cannot be read."}
    assert inspection(context, kept(context, "failed", error=error)) == Inspection("failed", error=error)


def test_when_the_job_was_erased_nothing_is_known(context: Context) -> None:
    motion = kept(context, "succeeded", b'{"joints": 31}')
    with context.database.write() as session:
        session.delete(session.get_one(Job, motion.inspection_job))
    assert inspection(context, motion) == Inspection("none")


@pytest.mark.parametrize(
    "document",
    [
        None,
        b"",
        b"\xff",
        b"[" * 100_000,
        b'{"joints": "many"}',
        json.dumps({"joints": 31, "more": "x" * MAX_DOCUMENT_BYTES}).encode(),
    ],
)
def test_a_document_that_cannot_be_believed_is_a_failed_inspection(context: Context, document: bytes | None) -> None:
    assert inspection(context, kept(context, "succeeded", document)) == Inspection("failed")
