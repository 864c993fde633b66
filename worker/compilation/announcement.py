"""Who waits while the engine is compiled is told so: the job's progress says it, and takes it back afterwards.

Any number of workers may do so at once: each change is guarded, and a word too many is taken back by whoever is last.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.context import Context
from service.job_records import jobs as repository
from service.jobs import leases
from service.tables.jobs import Job, Status

PREPARING_STAGE = "prepare_engine"
PREPARING_MESSAGE = "The engine is getting ready: this happens once and takes a few minutes."
WAITING_POLL_SECONDS = 1.0
"""How often is looked for jobs that wait; a worker that is ready takes one sooner."""


@contextmanager
def announcing(context: Context, waiting: Sequence[str]) -> Iterator[None]:
    """Tell the jobs that wait of the kinds that do, from another thread, as long as the block lasts. Kinds may be taken from
    `waiting` meanwhile: they are ready."""
    over = threading.Event()
    kinds = list(waiting)

    def keep_telling() -> None:
        while not over.wait(WAITING_POLL_SECONDS):
            announce(context, list(waiting))
            take_back(context, [kind for kind in kinds if kind not in waiting])
        take_back(context, kinds)

    thread = threading.Thread(target=keep_telling, name="announcement", daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def announce(context: Context, kinds: Sequence[str]) -> None:
    """Tell those that wait and do not know. Where a job of their kind runs, somebody is ready: they wait for their turn."""
    _try(_announce, context, kinds)


def _announce(context: Context, kinds: Sequence[str]) -> None:
    with context.database.read() as session:
        counts = repository.count_by_kind_and_status(session)
        idle = [kind for kind in kinds if not counts.get((kind, Status.RUNNING))]
        untold = [
            job for kind in idle for job in repository.queued(session, kind, WAITING_POLL_SECONDS) if not _told(job)
        ]
    _note(context, untold, PREPARING_STAGE, PREPARING_MESSAGE)


def take_back(context: Context, kinds: Sequence[str]) -> None:
    """From now on, jobs of these kinds that were told wait for their turn like others."""
    _try(_take_back, context, kinds)


def _take_back(context: Context, kinds: Sequence[str]) -> None:
    with context.database.read() as session:
        told = [job for kind in kinds for job in repository.queued(session, kind, 0.0) if _told(job)]
    _note(context, told, None, "")


def _try(change: Callable[[Context, Sequence[str]], None], context: Context, kinds: Sequence[str]) -> None:
    """A word that cannot be said now is no reason to stop."""
    try:
        change(context, kinds)
    except SQLAlchemyError as error:
        structlog.get_logger().warning("announcement_put_off", reason=str(error).splitlines()[0])


def _told(job: Job) -> bool:
    return job.progress.get("stage") == PREPARING_STAGE


def _note(context: Context, jobs: Sequence[Job], stage: str | None, message: str) -> None:
    for job in jobs:
        progress = job.progress | {"stage": stage, "fraction": job.progress.get("fraction", 0.0), "message": message}
        with context.database.write() as session:
            leases.note_waiting(session, job.id, progress | {"eta_seconds": None})
