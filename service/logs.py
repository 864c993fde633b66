"""Logging: our events and those of the libraries, in one form."""

from __future__ import annotations

import logging
import sys

import structlog
from structlog.typing import Processor

from service.settings import Settings


def configure(settings: Settings) -> None:
    """Send all logging of this process to its standard error, for people or as JSON lines."""
    shared: list[Processor] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        structlog.processors.TimeStamper(fmt="iso", utc=True),
    ]
    structlog.configure(
        processors=[*shared, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        logger_factory=structlog.stdlib.LoggerFactory(),
        wrapper_class=structlog.stdlib.BoundLogger,
    )
    # Tracebacks without the values of variables: among those are secrets, and drawing them takes seconds.
    plain = structlog.tracebacks.ExceptionDictTransformer(show_locals=False)
    console = structlog.dev.ConsoleRenderer(
        colors=sys.stderr.isatty(), exception_formatter=structlog.dev.plain_traceback
    )
    last: list[Processor] = (
        [structlog.processors.ExceptionRenderer(plain), structlog.processors.JSONRenderer()]
        if settings.log_format == "json"
        else [console]
    )
    handler = logging.StreamHandler()
    handler.setFormatter(
        structlog.stdlib.ProcessorFormatter(
            foreign_pre_chain=shared,
            processors=[structlog.stdlib.ProcessorFormatter.remove_processors_meta, *last],
        )
    )
    root = logging.getLogger()
    root.handlers = [handler]
    root.setLevel(settings.log_level)
    detailed = settings.log_level == "DEBUG"
    # It tells of each connection that an outage broke; whoever needed one says so in words of its own.
    logging.getLogger("sqlalchemy.pool").setLevel("DEBUG" if detailed else "CRITICAL")
    # Of a collector that is away it tells each try; that a batch was lost is enough.
    logging.getLogger("opentelemetry").setLevel("DEBUG" if detailed else "ERROR")
    # Whole addresses, in which there may be secrets, are among what httpx tells.
    logging.getLogger("httpx").setLevel("WARNING")
    for noisy in ("uvicorn.access", "uvicorn.error", "celery", "kombu", "amqp", "alembic", "asyncio"):
        logging.getLogger(noisy).setLevel("DEBUG" if detailed else "WARNING")
