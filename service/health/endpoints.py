"""GET /healthz, /readyz and /metrics."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import JSONResponse, PlainTextResponse
from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, generate_latest
from sqlalchemy import text
from sqlalchemy.exc import SQLAlchemyError

from service.auth.caller import Admin
from service.context import Context
from service.disk import free_mb
from service.health.metrics import ServiceCollector
from service.pulse import least_silent_seconds
from service.request_context import InContext

router = APIRouter(tags=["health"])


@router.get("/healthz", operation_id="healthz")
async def healthz() -> dict[str, str]:  # `async`: what waits for nothing needs no thread
    """The process lives."""
    return {"status": "ok"}


@router.get("/readyz", operation_id="readyz", responses={503: {"description": "Something that it needs is missing"}})
def readyz(context: InContext) -> JSONResponse:
    """What the service needs is there."""
    checks = {
        "database": _database(context),
        "redis": context.queue.reachable(),
        "storage": context.storage.reachable(),
        "disk": free_mb(context.settings) >= context.settings.disk_reserve_mb,
    }
    if context.settings.worker:  # else others have them, and jobs are accepted before one is there
        checks["worker"] = least_silent_seconds(context.settings.data_dir) < context.settings.silent_seconds
    ready = all(checks.values())
    return JSONResponse({"status": "ok" if ready else "unavailable", "checks": checks}, 200 if ready else 503)


@router.get("/metrics", operation_id="metrics", response_class=PlainTextResponse)
def metrics(caller: Admin, context: InContext) -> PlainTextResponse:
    """Figures for Prometheus."""
    registry = CollectorRegistry()
    registry.register(ServiceCollector(context))
    return PlainTextResponse(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)


def _database(context: Context) -> bool:
    try:
        with context.database.read() as session:
            session.execute(text("SELECT 1"))
    except SQLAlchemyError:
        return False
    return True
