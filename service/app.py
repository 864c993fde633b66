"""The application: all features under /v1, health beside them, the web page at the root."""

from __future__ import annotations

from fastapi import APIRouter, FastAPI
from fastapi.middleware.cors import CORSMiddleware

import engine
from service import openapi, problem_answers
from service.artifacts.endpoints import router as artifacts
from service.connections.body_timeout import BodyTimeout
from service.connections.stopping import Stopping
from service.context import Context
from service.drivers.endpoints import router as drivers
from service.events.endpoints import router as events
from service.events.watch import Watch
from service.files.endpoints import router as files
from service.health.endpoints import router as health
from service.http.encodings import Compressed
from service.http.guard import Guard
from service.http.page import Page
from service.jobs.endpoints import router as jobs
from service.keys.endpoints import router as keys
from service.kinds.endpoints import router as kinds
from service.links.endpoints import router as links
from service.live.endpoints import router as live
from service.live.process import StartLive
from service.live.sessions import LiveSessions
from service.motions.endpoints import router as motions
from service.traces.requests import Requests
from service.uploads.endpoints import router as uploads
from service.uploads.under_way import ActiveUploads
from service.webhooks.endpoints import router as webhooks


def make_app(context: Context, start_live: StartLive | None = None) -> FastAPI:
    """The application over an opened context; `start_live` starts the process of a live portrait, without it there are none."""
    app = FastAPI(
        title="Galatea",
        version=engine.__version__,
        description="Brings still pictures of people to life.",
        openapi_url="/v1/openapi.json",
        docs_url=None,  # it would load scripts from elsewhere
        redoc_url=None,
        # It would tell of addresses and messages that hold secrets; `service.traces` tells what may be told.
        telemetry={"tracing": False, "metrics": False, "logs": False, "auto_configure": False},
    )
    app.state.context = context
    app.state.uploads = ActiveUploads()
    app.state.stopping = Stopping()
    app.state.watch = Watch(context, app.state.stopping)
    app.state.live = LiveSessions(context, app.state.stopping, start_live)
    problem_answers.install(app)
    openapi.describe(app, context.settings.keys_required)
    v1 = APIRouter(prefix="/v1")
    for router in (files, uploads, jobs, events, artifacts, kinds, drivers, motions, keys, links, webhooks, live):
        v1.include_router(router)
    app.include_router(v1)
    app.include_router(health)
    app.router.default = Page(context.settings.web_dir)  # not mounted: a mount would hide which methods a route has
    settings = context.settings
    app.add_middleware(
        BodyTimeout, stopping=app.state.stopping, most=settings.body_seconds, rate=settings.body_bytes_per_second
    )
    app.add_middleware(Compressed)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=["*"],
            allow_headers=["*"],
            expose_headers=["*", "Authorization"],
        )
    app.add_middleware(
        Guard,
        trusted_proxies=settings.trusted_proxies,
        keys_required=settings.keys_required,
        origins=settings.cors_origins,
    )
    # Around the layer that answers errors of ours too, which `add_middleware` cannot reach.
    app.middleware_stack = Requests(app.build_middleware_stack(), context.traces.tracer)
    return app
