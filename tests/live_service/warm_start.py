"""`galatea ARGUMENTS` as a process of its own that need not import the program first: it is forked by `warm_server`.

The tests of the shell and of the wheel start the command itself.

`python warm_start.py SOCKET ARGUMENT...` stands for such a process: it has its output, ends it when it is told to end, and ends as
it does.
"""

from __future__ import annotations

import atexit
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
ANSWER_BYTES = 100


class WarmProcess:
    """A forked process, told of as `subprocess.Popen` does."""

    def __init__(self, server: Path, arguments: Sequence[str], environment: Mapping[str, str], cwd: Path, output: int):
        """`server` is the socket to order it at, `output` the file descriptor of what it prints and complains."""
        self._connection = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._connection.connect(str(server))
        order = {"arguments": list(arguments), "environment": dict(environment), "cwd": str(cwd)}
        socket.send_fds(self._connection, [json.dumps(order).encode()], [output])
        self.pid = self._answer()
        self.returncode: int | None = None

    def poll(self) -> int | None:
        try:
            return self.wait(0)
        except subprocess.TimeoutExpired:
            return None

    def wait(self, timeout: float | None = None) -> int:
        if self.returncode is None:
            if not select.select([self._connection], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("galatea", timeout or 0.0)
            self.returncode = self._answer()
            self._connection.close()
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def _answer(self) -> int:
        answer = self._connection.recv(ANSWER_BYTES)
        assert answer, "what services are forked from has ended"
        return int(answer)


@cache
def warm_server() -> Path:
    """The socket of a server that ends with this process, whose child it is."""
    folder = tempfile.mkdtemp(prefix="galatea-warm-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    socket_path = Path(folder) / "socket"
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "OPENBLAS_NUM_THREADS": "1",
    }  # whose threads could not be forked
    command = [sys.executable, "-P", str(Path(__file__).with_name("warm_server.py")), str(socket_path)]
    server = subprocess.Popen(command, env=environment)
    while not socket_path.exists():
        assert server.poll() is None, "what services are forked from did not start"
        time.sleep(0.01)
    return socket_path


def main() -> None:
    process = WarmProcess(Path(sys.argv[1]), sys.argv[2:], os.environ, Path.cwd(), 1)
    signal.signal(signal.SIGTERM, lambda number, _: os.kill(process.pid, number))
    sys.exit(process.wait())


if __name__ == "__main__":
    main()
