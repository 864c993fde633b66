"""Renewing a lease while its holder waits for something slow, such as the storage."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import copy_context

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.context import Context
from service.jobs import leases
from service.jobs.leases import Lease

BEATS_PER_LEASE = 4
"""How often a lease is renewed before it would end."""


@contextmanager
def renewing_lease(context: Context, lease: Lease) -> Iterator[None]:
    """Renew the lease from another thread as long as the block lasts, unless it is lost."""
    over = threading.Event()

    def beat() -> None:
        while not over.wait(lease.seconds / BEATS_PER_LEASE):
            try:
                with context.database.write() as session:
                    if not leases.update_job(session, lease):
                        return
            except SQLAlchemyError as error:
                structlog.get_logger().warning("lease_not_renewed", reason=str(error).splitlines()[0])

    threading.Thread(target=copy_context().run, args=(beat,), name="heartbeat", daemon=True).start()
    try:
        yield
    finally:
        over.set()  # a beat on its way does no harm: it renews the lease only while it stands
