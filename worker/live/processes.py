"""Starting the processes of live portraits, and talking to them, from the service's event loop. They do not give way as jobs
do: somebody looks on."""

from __future__ import annotations

import asyncio
import json
import os
import socket
from contextlib import suppress
from dataclasses import asdict, replace
from signal import SIGKILL
from typing import Any

from service.live.process import LiveOrder, StartLive
from service.settings import Settings
from worker.job_process.children import engine_environment, process_limits
from worker.live.wire import MESSAGE_HEAD_BYTES, head, packed
from worker.programs.interpreter import module_command
from worker.sandbox.privileges import user_id

UNTAKEN_BYTES = 1 << 16
"""Bytes that the process has not taken yet, beyond which no frame more is given to it."""
CPU_SHARE = 2.0
"""Seconds of computing, all cores together, for each second that it may last; preparing takes some more."""
PREPARING_CPU_SECONDS = 120


class Process:
    """A process at work: a `service.live.process.LiveProcess`."""

    def __init__(self, process: asyncio.subprocess.Process, reader: asyncio.StreamReader, writer: asyncio.StreamWriter):
        self._process, self._reader, self._writer = process, reader, writer
        self._killed = False

    def send(self, kind: bytes, data: bytes) -> bool:
        """As `LiveProcess.send`."""
        if self._writer.transport.get_write_buffer_size() > UNTAKEN_BYTES or self._writer.is_closing():
            return False
        self._writer.write(packed(kind, data))
        return True

    async def receive(self) -> tuple[bytes, bytes] | None:
        """As `LiveProcess.receive`."""
        try:
            kind, length = head(await self._reader.readexactly(MESSAGE_HEAD_BYTES))
            return kind, await self._reader.readexactly(length)
        except (asyncio.IncompleteReadError, OSError, ValueError):
            return None

    def kill(self) -> None:
        """As `LiveProcess.kill`."""
        if self._killed:
            return
        self._killed = True
        self._writer.close()
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, SIGKILL)
        with suppress(ProcessLookupError):
            self._process.kill()


def starter(settings: Settings) -> StartLive:
    """What starts a process under these settings, from the thread that they end with."""
    user = user_id(settings.job_user)
    limits = process_limits(settings, user)
    cpu = int(settings.live_seconds * CPU_SHARE) + PREPARING_CPU_SECONDS
    limits = replace(limits, cpu_seconds=cpu)

    async def start(order: LiveOrder) -> Process:
        ours, theirs = socket.socketpair()
        try:
            given: dict[str, Any] = {
                "image": str(order.image),
                "options": order.options,
                "frame_pixels": order.frame_pixels,
                "limits": asdict(settings.limits),
                "process_limits": asdict(limits),
                "mark_synthetic": settings.mark_synthetic,
                "cores": settings.job_cores,
            }
            process = await asyncio.create_subprocess_exec(
                *module_command("worker.live.child", str(os.getpid()), str(theirs.fileno()), json.dumps(given)),
                stdin=asyncio.subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                env=engine_environment(settings),
                start_new_session=True,
            )
            reader, writer = await asyncio.open_connection(sock=ours)
        except BaseException:
            ours.close()
            raise
        finally:
            theirs.close()
        return Process(process, reader, writer)

    return start
