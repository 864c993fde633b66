"""What services are forked from: a process that has imported the program, and has done nothing else.

The program's imports are two thirds of what a service computes until it answers, and they are the same for each of a hundred. This
process has one thread, reads no settings and opens no files. Who wants a service connects to its socket and says with which
arguments, environment and folder, and where its output goes (`warm_start`); what is forked takes these over and runs `shell.main`
from its first line. Its worker and its jobs' processes are started by it as ever.

`python -P warm_server.py SOCKET`; it ends with the process that started it.
"""

from __future__ import annotations

import json
import os
import runpy
import selectors
import signal
import socket
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
ORDER_BYTES = 1 << 20
BACKLOG = 100
IMPORTED = ("shell.settings", "shell.serve", "shell.opening", "shell.web_server")
"""What `galatea serve` imports, with all that these import."""


def fork_on_order(listening: socket.socket) -> tuple[dict[str, Any], int]:
    """Fork for each order, tell who gave it the number of the process, and, once that has ended, how. Returns in what was
    forked, with the order and its output."""
    woken, wake = socket.socketpair()
    wake.setblocking(False)
    signal.set_wakeup_fd(wake.fileno())
    signal.signal(signal.SIGCHLD, lambda *_: None)
    served: dict[int, socket.socket] = {}
    with selectors.DefaultSelector() as selector:
        selector.register(listening, selectors.EVENT_READ)
        selector.register(woken, selectors.EVENT_READ)
        while True:
            ready = {key.fileobj for key, _ in selector.select()}
            if woken in ready:
                woken.recv(1 << 12)
                _tell_ends(served)
            if listening in ready:
                connection, _ = listening.accept()
                data, (output,), *_ = socket.recv_fds(connection, ORDER_BYTES, 1)
                assert len(list(Path("/proc/self/task").iterdir())) == 1, "a process with threads must not be forked"
                if (process := os.fork()) == 0:
                    signal.set_wakeup_fd(-1)
                    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
                    for one in (listening, connection, woken, wake, *served.values()):
                        one.close()
                    return json.loads(data), output
                os.close(output)
                connection.send(str(process).encode())
                served[process] = connection


def _tell_ends(served: dict[int, socket.socket]) -> None:
    """Tell who waits for them of all that have ended."""
    while served:
        process, status = os.waitpid(-1, os.WNOHANG)
        if not process:
            return
        with served.pop(process) as connection, suppress(BrokenPipeError):  # nobody waits any more
            connection.send(str(os.waitstatus_to_exitcode(status)).encode())


def take_over(order: Mapping[str, Any], output: int, path: Sequence[str]) -> None:
    """Become what a command would have been started as; `path` is where Python itself looks for modules."""
    for descriptor in (1, 2):
        os.dup2(output, descriptor)
    os.close(output)
    os.chdir(order["cwd"])
    os.environ.clear()
    os.environ.update(order["environment"])
    named = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    sys.path[:] = [order["cwd"], *named, *path]  # as for `-m`
    sys.argv[1:] = order["arguments"]


def main() -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listening:
        listening.bind(sys.argv[1] + ".new")
        listening.listen(BACKLOG)
        Path(sys.argv[1] + ".new").rename(sys.argv[1])  # who sees it may connect
        path = [folder for folder in sys.path if folder != str(ROOT)]
        from worker.programs.loading import loading
        from worker.programs.parent_death import die_with_parent

        die_with_parent(os.getppid())
        with loading():
            for module in IMPORTED:
                import_module(module)
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # meant for the tests, with which this process ends
        order, output = fork_on_order(listening)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    take_over(order, output, path)
    runpy.run_module("shell.main", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
