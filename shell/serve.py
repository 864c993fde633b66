"""`galatea serve`: everything in one command, and all of it gone when the command ends, however it ends."""

from __future__ import annotations

import fcntl
import signal
import socket
import time
from functools import partial
from pathlib import Path
from types import FrameType
from typing import IO

import redis
import structlog

from service.auth.repository import any_usable
from service.context import Context
from service.logs import configure
from service.pulse import BEAT_SECONDS, silent_seconds, worker_name
from service.redis_server import redis_command, socket_path
from service.settings import Settings
from shell.cli_error import CliError
from shell.opening import open_context
from shell.supervisor import Supervisor
from worker.programs.interpreter import module_command
from worker.programs.loading import loading

START_TIMEOUT_SECONDS = 10.0
REDIS_START_SECONDS = 2.0
"""How long the embedded Redis may take to say that it lives."""

WORKER_SECONDS = 3 * BEAT_SECONDS
"""How old a sign of life of the worker may be that counts as one of now."""


def serve(settings: Settings) -> None:
    """Serve until SIGINT or SIGTERM. Raises `CliError` where that cannot begin."""
    configure(settings)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    listening = _listen(settings)
    with listening, _lock(settings.data_dir) as lock:
        supervisor = Supervisor(settings.silent_seconds, [lock.fileno()])
        try:
            _serve(settings, supervisor, listening)
        finally:
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, signal.SIG_IGN)
            supervisor.stop()


def _serve(settings: Settings, supervisor: Supervisor, listening: socket.socket) -> None:
    if settings.redis_url is None:
        supervisor.keep("redis", redis_command(settings.data_dir), 5, partial(_redis_lives, _redis(settings)))
        _await_redis(settings)
    context = open_context(settings, "api")
    _require_a_key(context)
    if settings.worker:
        command = module_command("shell.main", "worker")
        supervisor.keep("worker", command, 10, partial(_worker_lives, settings.data_dir))
    with loading():
        from shell.web_server import answer_requests  # beside the worker, which starts meanwhile

    answer_requests(context, listening)


def _require_a_key(context: Context) -> None:
    with context.database.read() as session:
        if context.settings.keys_required and not any_usable(session):
            raise CliError(
                "Nobody could use the service: it asks for a key, and there is none. Make one first, with the same "
                "settings: galatea keys create NAME"
            )


def _listen(settings: Settings) -> socket.socket:
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    try:
        listening = socket.create_server((settings.host, settings.port), family=family, backlog=2048)
        # Inherited by each connection: an answer's last part would else wait 40 ms for word of the first (Nagle).
        listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return listening
    except OSError as error:
        raise CliError(f"{settings.host}:{settings.port} cannot be bound: {error.strerror or error}") from error


def _lock(data_dir: Path) -> IO[str]:
    """Take the data folder for this service alone, waiting a while for what an earlier one left to end.

    The programs inherit the lock: it is free only once the last of them is gone.
    """
    data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
    lock = (data_dir / "serve.lock").open("w")
    deadline = time.monotonic() + START_TIMEOUT_SECONDS
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise CliError(f"Another `galatea serve` uses {data_dir} (GALATEA_DATA_DIR).") from None
            time.sleep(0.1)
        else:
            return lock


def _await_redis(settings: Settings) -> None:
    client = _redis(settings)
    deadline = time.monotonic() + START_TIMEOUT_SECONDS
    while True:
        try:
            client.ping()
        except redis.RedisError as error:
            if time.monotonic() > deadline:
                folder = settings.data_dir / "redis"
                raise CliError(
                    f"The embedded Redis does not start: {error}. See {folder / 'redis.log'}; the folder may be "
                    "deleted, for it holds nothing but hints."
                ) from error
            structlog.get_logger().debug("redis_not_ready", reason=str(error))
            time.sleep(0.05)
        else:
            client.close()
            return


def _redis(settings: Settings) -> redis.Redis:
    return redis.Redis(unix_socket_path=str(socket_path(settings.data_dir)), socket_timeout=REDIS_START_SECONDS)


def _redis_lives(client: redis.Redis, process: int) -> bool:
    try:
        return bool(client.ping())
    except redis.BusyLoadingError:
        return True
    except redis.RedisError:
        return False


def _worker_lives(data_dir: Path, process: int) -> bool:
    return silent_seconds(data_dir, worker_name(socket.gethostname(), process)) < WORKER_SECONDS


def _interrupt(number: int, frame: FrameType | None) -> None:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise SystemExit(0)
