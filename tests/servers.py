"""Real servers that tests start for themselves and stop again: PostgreSQL, and one that speaks S3.

PostgreSQL refuses to run as root: started by root, it runs as the user `postgres` (or `nobody`) in a folder of its
own under /tmp, for that user cannot look into the tests' folders.
"""

from __future__ import annotations

import os
import pwd
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import botocore.config
import botocore.session
import pg8000.native

PASSWORD = "a password of the tests'"
Reach = Callable[[Callable[[], Any]], Any]


def free_port() -> int:
    """A port at which nobody listens, of those that the system gives to nobody who asks for any: tests that run beside
    this one do not get it before it is used."""
    for port in random.SystemRandom().sample(range(20_000, 32_768), 100):
        with socket.socket() as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise AssertionError("no port is free")


def postgres_folder() -> Path | None:
    """Where PostgreSQL's programs are; None where it is not installed."""
    found = shutil.which("initdb")
    if found:
        return Path(found).parent
    folders = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
    return folders[-1].parent if folders else None


class PostgresServer:
    """A PostgreSQL of its own. `wrapper` is put before its command (to run it in another network namespace)."""

    def __init__(self, host: str = "127.0.0.1", wrapper: Sequence[str] = ()):
        programs = postgres_folder()
        assert programs is not None, "PostgreSQL is not installed"
        self._programs = programs
        self._wrapper = wrapper
        self.host, self.port = host, free_port()
        self._folder = Path(tempfile.mkdtemp(prefix="galatea-postgres-"))
        self._user = _unprivileged()
        if self._user is not None:
            os.chown(self._folder, self._user.pw_uid, self._user.pw_gid)
        password = self._folder / "password"
        password.write_text(PASSWORD)
        password.chmod(0o644)
        command = [str(programs / "initdb"), "-D", str(self._folder / "data"), "-U", "galatea", "-E", "UTF8"]
        command += ["--locale=C.UTF-8", "-A", "scram-sha-256", f"--pwfile={password}", "--no-sync"]
        subprocess.run(self._as_user(command), check=True, capture_output=True, cwd=self._folder)
        with (self._folder / "data" / "pg_hba.conf").open("a") as access:
            access.write("host all all samenet scram-sha-256\n")  # the other hosts of a test's network
        self._databases = 0
        self.start()

    def start(self) -> None:
        settings = {
            "listen_addresses": self.host,
            "port": self.port,
            "unix_socket_directories": self._folder,
            "max_connections": 200,
            "full_page_writes": "off",
            "fsync": "off",  # the machine does not lose power during a test
            "log_min_error_statement": "fatal",
        }
        options = [part for name, value in settings.items() for part in ("-c", f"{name}={value}")]
        command = [str(self._programs / "postgres"), "-D", str(self._folder / "data"), *options]
        with (self._folder / "log").open("ab") as log:
            self._process = subprocess.Popen(
                [*self._wrapper, *self._as_user(command)], stdout=log, stderr=log, cwd=self._folder
            )
        await_(lambda: self.run("SELECT 1") == [[1]], "PostgreSQL answers", self._process)

    def stop(self) -> None:
        """Stop it as an operator would: connections are ended at once, what was committed is kept."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait(90)

    def remove(self) -> None:
        """Stop it for good, without leaving anything in order."""
        self._process.send_signal(signal.SIGQUIT)
        self._process.wait(90)
        shutil.rmtree(self._folder, ignore_errors=True)

    def new_database(self, like: str = "template1") -> str:
        """The address of a fresh, empty database; or of a copy of another, named, to which nobody is connected."""
        self._databases += 1
        name = f"galatea{self._databases}"
        self.run(f"CREATE DATABASE {name} TEMPLATE {like}")
        return f"postgresql://galatea:{PASSWORD.replace(' ', '%20')}@{self.host}:{self.port}/{name}"

    def run(self, statement: str, database: str = "postgres") -> list[list[object]]:
        """The rows of a statement, asked over the server's unix socket: it reaches into every network namespace."""
        socket_path = str(self._folder / f".s.PGSQL.{self.port}")
        connection = pg8000.native.Connection(
            "galatea", unix_sock=socket_path, database=database, password=PASSWORD, ssl_context=False
        )
        try:
            return connection.run(statement)
        finally:
            connection.close()

    def _as_user(self, command: Sequence[str]) -> list[str]:
        """The command as an unprivileged user, ended with this process."""
        given = ["setpriv", "--pdeathsig", "INT"]
        if self._user is not None:
            given += ["--reuid", str(self._user.pw_uid), "--regid", str(self._user.pw_gid), "--clear-groups"]
        return [*given, *command]


def _unprivileged() -> pwd.struct_passwd | None:
    if os.geteuid() != 0:
        return None
    names = {entry.pw_name: entry for entry in pwd.getpwall()}
    return names.get("postgres") or names["nobody"]


class S3Server(ABC):
    """A server that speaks S3."""

    access_key, secret_key = "tests", "a-secret-of-the-tests"

    def __init__(self, host: str = "127.0.0.1", wrapper: Sequence[str] = (), reach: Reach = lambda ask: ask()):
        """`wrapper` is put before its commands, `reach` asks where the server can be reached."""
        self.host, self.port = host, free_port()
        self._wrapper, self._reach = wrapper, reach
        self._buckets = 0
        self._log = tempfile.NamedTemporaryFile(prefix="galatea-s3-", suffix=".log")  # noqa: SIM115

    @property
    def address(self) -> str:
        return f"http://{self.host}:{self.port}"

    @abstractmethod
    def start(self) -> None:
        """Start it, and wait until it answers."""

    @abstractmethod
    def stop(self) -> None:
        """Kill it."""

    def remove(self) -> None:
        """Kill it for good."""
        self.stop()

    def settings(self, bucket: str) -> dict[str, str]:
        """The settings of a service that stores in a bucket."""
        return {
            "storage_url": f"s3://{bucket}/galatea",
            "storage_endpoint": self.address,
            "storage_access_key": self.access_key,
            "storage_secret_key": self.secret_key,
        }

    def new_bucket(self) -> dict[str, str]:
        """A fresh, empty bucket: the settings of a service that stores in it."""
        self._buckets += 1
        bucket = f"bucket-{self._buckets}"
        self._reach(lambda: self.client().create_bucket(Bucket=bucket))
        return self.settings(bucket)

    def client(self) -> Any:
        """A client of the server that is not the service's."""
        keys = {"aws_access_key_id": self.access_key, "aws_secret_access_key": self.secret_key}
        config = botocore.config.Config(s3={"addressing_style": "path"}, read_timeout=60, retries={"max_attempts": 3})
        session = botocore.session.Session()
        return session.create_client("s3", region_name="us-east-1", endpoint_url=self.address, config=config, **keys)

    def _run(self, command: Sequence[str], **environment: str) -> subprocess.Popen[bytes]:
        """A process that ends with this one, at the latest."""
        ending = ["setpriv", "--pdeathsig", "KILL"]
        return subprocess.Popen(
            [*self._wrapper, *ending, *command], stdout=self._log, stderr=self._log, env=os.environ | environment
        )


class Moto(S3Server):
    """moto's server: it keeps everything in its memory, and takes any credentials."""

    def __init__(self, host: str = "127.0.0.1", wrapper: Sequence[str] = (), reach: Reach = lambda ask: ask()):
        super().__init__(host, wrapper, reach)
        self.start()

    def start(self) -> None:
        serve = [sys.executable, "-m", "moto.server", "-H", self.host, "-p", str(self.port)]
        self._process = self._run(serve, MOTO_S3_DEFAULT_MAX_KEYS="50")  # lists come in pages
        answers = lambda: urlopen(f"{self.address}/moto-api/", timeout=5).status == 200  # noqa: E731
        await_(lambda: self._reach(answers), "the S3 server answers", self._process)

    def stop(self) -> None:
        self._process.kill()
        self._process.wait(90)


class Gate:
    """A way to a server that can be shut: whoever is on it is cut off."""

    def __init__(self, host: str, port: int):
        self._behind = (host, port)
        self._ways: list[socket.socket] = []
        self.port = free_port()
        self.open()

    def open(self) -> None:
        self._door = socket.create_server(("127.0.0.1", self.port))
        threading.Thread(target=self._let_in, args=[self._door], daemon=True).start()

    def shut(self) -> None:
        self._door.shutdown(socket.SHUT_RDWR)
        self._door.close()
        for way in self._ways:
            with suppress(OSError):
                way.shutdown(socket.SHUT_RDWR)
        self._ways.clear()

    def _let_in(self, door: socket.socket) -> None:
        with suppress(OSError):
            while True:
                near, _ = door.accept()
                try:
                    far = socket.create_connection(self._behind)
                except OSError:  # nobody is at home: whoever comes is sent away
                    near.close()
                    continue
                self._ways += [near, far]
                for source, target in ((near, far), (far, near)):
                    threading.Thread(target=self._pass_on, args=[source, target], daemon=True).start()

    @staticmethod
    def _pass_on(source: socket.socket, target: socket.socket) -> None:
        with suppress(OSError):
            while data := source.recv(1 << 16):
                target.sendall(data)
        for end in (source, target):
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)


def await_(true: Callable[[], bool], what: str, process: subprocess.Popen[bytes], seconds: float = 180) -> None:
    """Wait until it is true; what cannot be asked yet is not true yet."""
    deadline = time.monotonic() + seconds
    while True:
        assert process.poll() is None, f"the process ended: {what} never"
        try:
            if true():
                return
        except Exception as error:
            problem = error
        else:
            problem = None
        assert time.monotonic() < deadline, f"not within {seconds} s: {what} ({problem})"
        time.sleep(0.05)
