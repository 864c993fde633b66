"""What clients can do with jobs: submit, cancel, delete."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Mapping, Sequence

from pydantic import ValidationError
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from engine.kind import Kind
from service.artifacts import repository as artifacts
from service.clock import now
from service.context import Context
from service.events import repository as events
from service.files import repository as files
from service.files.models import File
from service.ids import new_id
from service.jobs import leases, repository
from service.jobs.inputs import resolve
from service.jobs.models import IdempotencyKey, Job, JobFile, Status
from service.jobs.schemas import JobIn, JobOut
from service.problems import Problem, invalid

METADATA_BYTES = 16_000


def submit(context: Context, asked: JobIn, uploaded: Mapping[str, Sequence[File]], key: str | None) -> tuple[Job, bool]:
    """Accept a job. Returns it, and whether an earlier request with the same key had made it.

    `uploaded` are files that came with the request, by input name. Raises `Problem`.
    """
    kind, options = _checked(context, asked)
    fingerprint = _fingerprint(asked, uploaded)
    try:
        with context.database.write() as session:
            if key is not None and (earlier := _earlier(session, key, fingerprint)) is not None:
                return earlier, True
            job = _insert(session, kind, asked, options, uploaded)
            if key is not None:
                session.add(IdempotencyKey(key=key, fingerprint=fingerprint, job_id=job.id, created_at=now()))
    except IntegrityError:
        # On a database with several writers, the same key may have been taken in this very moment.
        with context.database.read() as session:
            if key is None or (earlier := _earlier(session, key, fingerprint)) is None:
                raise
            return earlier, True
    context.queue.send(job.id, job.kind)
    return job, False


def cancel(context: Context, job_id: str) -> None:
    """Cancel a job; its worker stops within two seconds. Raises a 409 problem if it has ended otherwise."""
    with context.database.write() as session:
        job = found(session, job_id)
        if not leases.cancel(session, job_id) and job.status != Status.CANCELED:
            raise Problem(409, "job_finished", f"The job has {job.status} already: there is nothing to cancel.")


def delete(context: Context, job_id: str) -> None:
    """Erase a job and its media; one that runs is stopped."""
    with context.database.write() as session:
        found(session, job_id)
        file_ids = repository.files_of(session, job_id)
        keys = [artifact.key for artifact in artifacts.of_jobs(session, [job_id])[job_id]]
        repository.erase(session, job_id)
        keys += files.erase_unused(session, file_ids)
    context.storage.delete(keys)
    erase_folder(context, job_id)


def erase_folder(context: Context, job_id: str) -> None:
    """Erase a job's stages and drafts."""
    shutil.rmtree(context.settings.job_folder(job_id), ignore_errors=True)


def found(session: Session, job_id: str) -> Job:
    """The job, or a 404 problem."""
    job = repository.get(session, job_id)
    if job is None:
        raise Problem(404, "job_not_found", "There is no such job: it was deleted, or it never was.")
    return job


def shown(context: Context, job_id: str) -> JobOut:
    """The job as the API shows it, or a 404 problem."""
    with context.database.read() as session:
        return JobOut.of(found(session, job_id), artifacts.of_jobs(session, [job_id])[job_id])


def _checked(context: Context, asked: JobIn) -> tuple[Kind, dict[str, object]]:
    kind = context.kinds.get(asked.kind)
    if kind is None:
        names = ", ".join(context.kinds)
        raise Problem(422, "unknown_kind", f"There is no job kind “{asked.kind[:80]}”: choose one of {names}.")
    if asked.webhook_url is not None:
        raise Problem(
            422, "webhooks_unsupported", "Webhooks are not offered: follow the job by its events, and leave this out."
        )
    if len(json.dumps(asked.metadata)) > METADATA_BYTES:
        raise Problem(422, "metadata_too_large", f"The metadata may take {METADATA_BYTES} bytes of JSON at most.")
    try:
        options = kind.options.model_validate(asked.options)
    except ValidationError as error:
        raise invalid(error, "invalid_options", "/options") from error
    return kind, options.model_dump(mode="json", exclude_unset=True)


def _insert(
    session: Session, kind: Kind, asked: JobIn, options: Mapping[str, object], uploaded: Mapping[str, Sequence[File]]
) -> Job:
    given: dict[str, str | list[str]] = dict(asked.inputs)
    given |= {name: [file.id for file in came] for name, came in uploaded.items()}
    resolved = resolve(session, kind, given)
    many = {item.name: item.many for item in kind.inputs}
    shown_inputs = {n: v[0] if isinstance(v, list) and not many[n] else v for n, v in given.items() if v != []}
    moment = now()
    job = Job(
        id=new_id(),
        kind=kind.name,
        status=Status.QUEUED,
        inputs=shown_inputs,
        sources=resolved.sources,
        options=dict(options),
        notes=asked.metadata,
        progress={},
        created_at=moment,
        enqueued_at=moment,
        lease_token=0,
        attempts=0,
        fruitless_attempts=0,
    )
    session.add(job)
    session.flush()
    session.add_all(JobFile(job_id=job.id, file_id=file_id) for file_id in resolved.file_ids)
    events.append(session, job.id, "status", {"status": Status.QUEUED})
    return job


def _earlier(session: Session, key: str, fingerprint: str) -> Job | None:
    record = repository.idempotency_key(session, key)
    if record is None:
        return None
    if record.fingerprint != fingerprint:
        raise Problem(
            422,
            "idempotency_key_reused",
            "This Idempotency-Key came with another request before: use a new key for a new job.",
        )
    return found(session, record.job_id)


def _fingerprint(asked: JobIn, uploaded: Mapping[str, Sequence[File]]) -> str:
    """What makes two requests the same: all that is asked, with uploaded files by their content."""
    document = asked.model_dump(mode="json")
    document["uploaded"] = {name: [file.sha256 for file in came] for name, came in sorted(uploaded.items())}
    return hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
