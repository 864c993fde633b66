"""What clients can do with jobs: submit, cancel, delete."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import structlog
from pydantic import ValidationError
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from engine.kind import Kind
from service.auth.quotas import require_job
from service.clock import now
from service.context import Context
from service.events import repository as events
from service.files import repository as files
from service.files.service import forget
from service.ids import new_id
from service.job_records import artifacts, search
from service.job_records import jobs as repository
from service.job_records.owned import lock_own_job, own_job
from service.jobs import leases, stages
from service.jobs.driver_segments import choose_segments
from service.jobs.inputs import Value, named_options, resolve, split_corrections
from service.jobs.schemas import JobIn, RevisionIn
from service.problems import Problem, invalid
from service.tables.files import File
from service.tables.jobs import IdempotencyKey, Job, JobFile, Priority, Status
from service.traces.current import current_request
from service.webhooks.service import require_address

METADATA_BYTES = 16_000


def submit(
    context: Context, owner: str, requested: JobIn, uploaded: Mapping[str, Sequence[File]], key: str | None
) -> tuple[Job, bool]:
    """Accept a job. Returns it, and whether an earlier request with the same key had made it.

    `uploaded` are files that came with the request, by input name. Raises `Problem`.
    """
    kind = _kind(context, requested.kind)
    _check(context, requested)
    given: dict[str, Value] = dict(requested.inputs)
    with context.database.read() as session:
        built_in = named_options(session, owner, kind, given)
    options = _options(kind, {**requested.options, **built_in})
    given |= {name: [file.id for file in came] for name, came in uploaded.items()}
    segments = choose_segments(context, owner, kind, options, given)
    document = _document(requested)
    document["uploaded"] = {name: [file.sha256 for file in came] for name, came in sorted(uploaded.items())}

    def make(session: Session) -> Job:
        meant, trimmed = segments()
        job = _new_job(owner, kind, trimmed, requested.metadata)
        _be_told(job, requested.webhook_url, requested.webhook_events)
        job.priority = _priority(requested.priority)
        resolved = resolve(session, owner, kind, trimmed, meant, context.settings.allowed_networks)
        job.inputs, job.sources, job.title = _shown(kind, given), resolved.sources, requested.title
        _insert(session, job, kind, resolved.file_ids)
        return job

    return _accept(context, owner, key, document, make)


def revise(
    context: Context,
    owner: str,
    job_id: str,
    requested: RevisionIn,
    uploaded: Mapping[str, Sequence[File]],
    key: str | None,
) -> tuple[Job, bool]:
    """Accept a revision: a job with other options, or with other files in place of what the work found. It reuses the
    stages that these leave as they were; all else is the parent's.

    `uploaded` are files that came with the request, by the names of corrections. Returns the job, and whether an
    earlier request with the same key had made it. Raises `Problem`.
    """
    with context.database.read() as session:
        parent = own_job(session, owner, job_id)
        kind = _kind(context, parent.kind)
        _check(context, requested)
        came = {name: [file.id for file in files] for name, files in uploaded.items()}
        corrected, given = split_corrections(kind, {**requested.corrections, **came})
        corrected |= named_options(session, owner, kind, given)
    if not Status(parent.status).final:
        raise Problem(409, "job_not_finished", f"The job is {parent.status}: wait for its end, or cancel it first.")
    wanted = {**parent.options, **requested.options, **corrected}
    options = _options(kind, {name: value for name, value in wanted.items() if value is not None}, corrected)
    document = {"revision_of": job_id, **_document(requested)}
    if uploaded:
        document["uploaded"] = {name: [file.sha256 for file in files] for name, files in sorted(uploaded.items())}

    def make(session: Session) -> Job:
        parent = lock_own_job(session, owner, job_id)
        job = _new_job(owner, kind, options, parent.notes if requested.metadata is None else requested.metadata)
        _be_told(job, requested.webhook_url or parent.webhook_url, requested.webhook_events or parent.webhook_events)
        job.priority = _priority(requested.priority) if requested.priority is not None else parent.priority
        job.revision_of, job.tree, job.title = parent.id, parent.tree, parent.title
        resolved = resolve(session, owner, kind, options, given, context.settings.allowed_networks, parent.sources)
        job.inputs, job.sources = _shown(kind, {**parent.inputs, **given}), resolved.sources
        _insert(session, job, kind, resolved.file_ids)
        return job

    return _accept(context, owner, key, document, make)


def _accept(
    context: Context, owner: str, key: str | None, document: Mapping[str, object], make: Callable[[Session], Job]
) -> tuple[Job, bool]:
    """Make a job unless a request with the same key did, and send its message."""
    fingerprint = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    try:
        with context.database.write() as session:
            if key is not None and (earlier := _earlier(session, owner, key, fingerprint)) is not None:
                return earlier, True
            require_job(session, context.settings, owner)
            job = make(session)
            if key is not None:
                session.add(
                    IdempotencyKey(owner=owner, key=key, fingerprint=fingerprint, job_id=job.id, created_at=now())
                )
    except IntegrityError:
        # On a database with several writers, the same key may have been taken in this very moment.
        with context.database.read() as session:
            if key is None or (earlier := _earlier(session, owner, key, fingerprint)) is None:
                raise
            return earlier, True
    current_request().span.set_attribute("galatea.job", job.id)
    structlog.get_logger().info("job_accepted", job=job.id, kind=job.kind)
    context.queue.send(job.id, job.kind)
    return job, False


def retitle(context: Context, owner: str, job_id: str, title: str | None) -> None:
    """Give the work that a job is a version of another title, or none. Raises a 404 problem."""
    with context.database.write() as session:
        root = own_job(session, owner, job_id).tree
        repository.lock_tree(session, root)  # from now on nobody makes a revision, which would take the old title
        for job in repository.tree(session, root):
            search.retitle(job, title)


def cancel(context: Context, owner: str, job_id: str) -> None:
    """Cancel a job; its worker stops within two seconds. Raises a 409 problem if it has ended otherwise."""
    with context.database.write() as session:
        job = lock_own_job(session, owner, job_id)
        if not leases.cancel(session, job_id) and job.status != Status.CANCELED:
            raise Problem(409, "job_finished", f"The job has {job.status} already: there is nothing to cancel.")


def delete(context: Context, owner: str, job_id: str) -> None:
    """Erase a job and its media, and those that show the same person because they began with it; one that runs is stopped. What a
    revision of it still uses stays."""
    with context.database.write() as session:
        begun_with = _begun_with(session, context.kinds, own_job(session, owner, job_id))
        doomed = [lock_own_job(session, owner, job_id), *begun_with]
        ids = [job.id for job in doomed]
        file_ids = [file for one in ids for file in repository.files_of(session, one)]
        stored = [artifact.key for some in artifacts.of_jobs(session, ids).values() for artifact in some]
        folders = {*ids, *(job.tree for job in doomed)}
        for one in ids:
            repository.erase(session, one)
        erased = files.erase_unused(session, file_ids)
        unneeded = folders - repository.with_folder(session, sorted(folders))
    context.storage.delete(stored)
    forget(context, erased)
    for one in unneeded:
        stages.erase(context, one)


def _begun_with(session: Session, kinds: Mapping[str, Kind], job: Job) -> list[Job]:
    """The owner's jobs, locked, that took what this one has made by an input that is erased together with it, and those that took
    what they have made."""
    kind = kinds.get(job.kind)
    names = [item.name for item in kind.inputs if item.erased_together] if kind is not None else []
    if not names:
        return []
    others = repository.of_kind_locked(session, job.owner, job.kind)
    found, made = [], {job.id}
    for other in others:  # the oldest first: nothing begins with what is made later
        if any(isinstance(source := other.sources.get(name), dict) and source.get("job") in made for name in names):
            found.append(other)
            made.add(other.id)
    return found


def _shown(kind: Kind, given: Mapping[str, Value]) -> dict[str, str | list[str]]:
    """What is given to a job, as it shows it: one value where an input takes one, and nothing that is empty."""
    many = {item.name: item.many for item in kind.inputs}
    there = {name: value for name, value in given.items() if value is not None and value != []}
    return {name: one[0] if isinstance(one, list) and not many[name] else one for name, one in there.items()}


def _priority(name: str) -> int:
    return Priority[name.upper()]


def _document(requested: JobIn | RevisionIn) -> dict[str, Any]:
    """What a request asks for, by which it is known again. What was never said is left out, so that a request that
    came before an upgrade is the same after it."""
    return requested.model_dump(mode="json", exclude={"priority", "title"} - requested.model_fields_set)


def _kind(context: Context, name: str) -> Kind:
    kind = context.kinds.get(name)
    if kind is None:
        names = ", ".join(context.kinds)
        raise Problem(422, "unknown_kind", f"There is no job kind “{name[:80]}”: choose one of {names}.")
    return kind


def _check(context: Context, requested: JobIn | RevisionIn) -> None:
    if requested.webhook_url is not None:
        require_address(requested.webhook_url, context.settings.allowed_networks, "/webhook_url")
    try:
        json.dumps(requested.model_dump(), ensure_ascii=False).encode()
    except UnicodeEncodeError:
        raise Problem(422, "invalid_json", "The request holds half a character (a lone surrogate).") from None
    if len(json.dumps(requested.metadata)) > METADATA_BYTES:
        raise Problem(422, "metadata_too_large", f"The metadata may take {METADATA_BYTES} bytes of JSON at most.")


def _be_told(job: Job, url: str | None, types: Sequence[str] | None) -> None:
    """Have an address told of a new job."""
    if types is not None and url is None:
        raise Problem(422, "webhook_url_missing", "There are webhook_events but no webhook_url: give both, or neither.")
    job.webhook_url, job.webhook_events = url, list(types) if types is not None else None


def _options(kind: Kind, given: Mapping[str, object], corrected: Iterable[str] = ()) -> dict[str, object]:
    """The options as a job has them; those by the names `corrected` came as corrections, and are told of as such."""
    try:
        return kind.options.model_validate(given).model_dump(mode="json", exclude_unset=True)
    except ValidationError as error:
        came = dict.fromkeys(corrected, "/corrections")
        raise invalid(error, "invalid_options", "/options", kind.options, came) from error


def _new_job(owner: str, kind: Kind, options: dict[str, object], metadata: dict[str, Any]) -> Job:
    moment = now()
    request = current_request()
    return Job(
        id=new_id(),
        owner=owner,
        kind=kind.name,
        status=Status.QUEUED,
        options=options,
        notes=metadata,
        progress={},
        request=request.id,
        trace=request.traceparent,
        created_at=moment,
        enqueued_at=moment,
        lease_token=0,
        attempts=0,
        fruitless_attempts=0,
    )


def _insert(session: Session, job: Job, kind: Kind, file_ids: Iterable[str]) -> None:
    search.describe(session, job, kind)
    session.add(job)
    session.flush()
    session.add_all(JobFile(job_id=job.id, file_id=file_id) for file_id in file_ids)
    events.append_first(session, job)


def _earlier(session: Session, owner: str, key: str, fingerprint: str) -> Job | None:
    record = repository.idempotency_key(session, owner, key)
    if record is None:
        return None
    if record.fingerprint != fingerprint:
        raise Problem(
            422,
            "idempotency_key_reused",
            "This Idempotency-Key came with another request before: use a new key for a new job.",
        )
    return own_job(session, owner, record.job_id)
