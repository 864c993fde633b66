"""The application: all features under /v1, health beside them, the web page at the root."""

from __future__ import annotations

from fastapi import APIRouter, FastAPI

import engine
from service import openapi, problems
from service.artifacts.endpoints import router as artifacts
from service.context import Context
from service.drivers.endpoints import router as drivers
from service.events.endpoints import router as events
from service.files.endpoints import router as files
from service.guard import LoopbackGuard
from service.health.endpoints import router as health
from service.jobs.endpoints import router as jobs
from service.kinds.endpoints import router as kinds
from service.page import Page


def make_app(context: Context) -> FastAPI:
    """The application over an opened context."""
    app = FastAPI(
        title="Galatea",
        version=engine.__version__,
        description="Brings still pictures of people to life.",
        openapi_url="/v1/openapi.json",
        docs_url=None,  # it would load scripts from elsewhere
        redoc_url=None,
    )
    app.state.context = context
    problems.install(app)
    openapi.describe(app)
    v1 = APIRouter(prefix="/v1")
    for router in (files, jobs, events, artifacts, kinds, drivers):
        v1.include_router(router)
    app.include_router(v1)
    app.include_router(health)
    app.router.default = Page(context.settings.web_dir)  # not mounted: a mount would hide which methods a route has
    app.add_middleware(LoopbackGuard, trusted_proxies=context.settings.trusted_proxies)
    return app
