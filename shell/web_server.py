"""What answers requests within `galatea serve`: the application under uvicorn, until the process is told to end."""

from __future__ import annotations

import asyncio
import socket
import sys

import click
import uvicorn
from fastapi import FastAPI

from service.app import make_app
from service.connections.connection_limit import ConnectionLimit, most_connections, raise_file_limit
from service.connections.protocol import Config
from service.connections.stopping import Stopping
from service.context import Context
from service.http.page import NOT_BUILT, is_built
from service.settings import Settings
from worker.live.processes import starter
from worker.programs.loading import loading

REQUESTS_STOP_SECONDS = 3
"""How long requests may take to end once the service is to end; `Stopping` has told them."""

SWITCH_SECONDS = 0.0005
"""How long one thread may keep Python to itself: a request passes from thread to thread several times, and would wait
so long each time."""


def answer_requests(context: Context, listening: socket.socket) -> None:
    """Answer what comes over a socket that listens, until SIGINT or SIGTERM."""
    sys.setswitchinterval(SWITCH_SECONDS)
    with loading():
        app = make_app(context, starter(context.settings))
    if not is_built(context.settings.web_dir):
        click.echo(NOT_BUILT, err=True)
    Server(_config(context.settings, app), app.state.stopping).run(sockets=[listening])


class Server(uvicorn.Server):
    """Says where it is once it answers, and tells all requests when it is to end."""

    def __init__(self, config: Config, stopping: Stopping):
        super().__init__(config)
        self._stopping = stopping

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        for listening in sockets or []:
            host, port = listening.getsockname()[:2]
            shown = f"[{host}]" if ":" in host else host
            print(f"Galatea serves at http://{shown}:{port}/", flush=True)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._stopping.begin()
        await super().shutdown(sockets)
        if self.server_state.tasks:  # those that were cut short still say so
            await asyncio.wait(self.server_state.tasks, timeout=1)


def _config(settings: Settings, app: FastAPI) -> Config:
    return Config(
        app,
        ConnectionLimit(most_connections(settings.connections, raise_file_limit())),
        settings.head_seconds,
        settings.send_seconds,
        timeout_keep_alive=settings.idle_seconds,
        loop="uvloop",
        log_config=None,
        access_log=settings.log_level == "DEBUG",
        proxy_headers=False,
        server_header=False,
        timeout_graceful_shutdown=REQUESTS_STOP_SECONDS,
        lifespan="off",
    )
