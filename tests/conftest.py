"""What every test may ask for: real media, kept outside the project, real servers, started when first asked for, and
receivers of calls."""

from __future__ import annotations

import os
import signal
import socket
import sys
from collections.abc import Callable, Generator, Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from missing import missing
from receiver import OK, Answer, Receiver
from servers import PostgresServer, S3Server, postgres_folder
from swift import s3_server

from worker.programs.loading import loading

ROOT = Path(__file__).parent.parent

sys.path.insert(0, str(ROOT / "tests" / "live_service"))  # what several folders of tests need to run a service

pytest_plugins = ("real_faces", "live_services", "opened_context")

settings.register_profile("untimed", settings(), deadline=None)  # how long an example takes is no truth
settings.load_profile("untimed")

signal.signal(signal.SIGINT, signal.default_int_handler)  # run in the background, it would be ignored in every child


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """Several processes (`--dist loadfile`) are given folders that share fixtures as a whole."""
    from by_folder import ByFolder  # where there are several processes

    return ByFolder(config, log) if config.getvalue("dist") == "loadfile" else None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What the tests import stays as long as they run: Python need not look through it for rubbish, again and again."""
    with loading():
        return (yield)


@pytest.fixture(scope="session", autouse=True)
def networks() -> Iterator[None]:
    """Each network is loaded once."""
    from engine.perception.solutions import kept_networks  # not for who looks at no picture

    with kept_networks():
        yield


@pytest.fixture(scope="session")
def media() -> Callable[[str], Path]:
    """`media("portraits/photo_woman_white.png")` is that file of the shared test media.

    Skips where the media are absent (a user's machine); fails where they must be there (`CI=true`).
    """
    folder = Path(os.environ.get("GALATEA_TEST_DATA", ROOT.parent / "shared" / "data"))

    def find(name: str) -> Path:
        path = folder / name
        if not path.exists():
            message = f"test media not found: {path} (set GALATEA_TEST_DATA to the folder that holds them)"
            missing(message)
        return path

    return find


@pytest.fixture(scope="session")
def postgres_installed() -> None:
    """Skips where PostgreSQL is not installed, fails where it must be (`CI=true`)."""
    if postgres_folder() is None:
        message = "PostgreSQL is not installed (make test installs it: scripts/setup.sh --for-tests)"
        missing(message)


@pytest.fixture(scope="session")
def postgres(postgres_installed: None) -> Iterator[PostgresServer]:
    """A PostgreSQL server."""
    server = PostgresServer()
    yield server
    server.remove()


@pytest.fixture(scope="session")
def opengl() -> None:
    """Skips where there is no OpenGL without a screen, fails where there must be (`CI=true`)."""
    from template_character import template_character  # slow to import, and few tests need it

    from engine.errors import InputError
    from engine.export.lit_preview import LitPreview

    try:
        with LitPreview(template_character(texture_size=8), (8, 8)):
            pass
    except InputError as error:
        assert error.code == "gl_unavailable"
        missing(f"{error.detail} (make test installs Mesa's EGL: scripts/setup.sh --for-tests)")


@pytest.fixture(scope="session")
def s3() -> Iterator[S3Server]:
    """A server that speaks S3."""
    server = s3_server()
    yield server
    server.remove()


@pytest.fixture(scope="session")
def newest_on_postgres(postgres: PostgresServer) -> str:
    """The name of a database on the server that has the newest tables, to be copied."""
    from newest_tables import make_tables

    make_tables(url := postgres.new_database())
    return url.rpartition("/")[2]


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a database of either kind, with the newest tables and nothing in them."""
    if request.param == "sqlite":
        from newest_tables import write_newest_tables

        write_newest_tables(tmp_path / "galatea.db")
        return f"sqlite:///{tmp_path / 'galatea.db'}"
    server: PostgresServer = request.getfixturevalue("postgres")
    return server.new_database(like=request.getfixturevalue("newest_on_postgres"))


@pytest.fixture(params=["sqlite", "postgresql"])
def bare_database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a database of either kind, without any tables."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path / 'galatea.db'}"
    server: PostgresServer = request.getfixturevalue("postgres")
    return server.new_database()


@pytest.fixture
def receive() -> Iterator[Callable[..., Receiver]]:
    """`receive(address, answer)` is a receiver of calls that listens until the test ends."""
    started: list[Receiver] = []

    def begin(address: str = "127.0.0.1", answer: Answer = OK) -> Receiver:
        started.append(Receiver(address, answer))
        return started[-1]

    yield begin
    for receiver in started:
        receiver.close()


@pytest.fixture
def names(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[list[str]]]:
    """Names of the test's own for the system's resolver: for each, one list of addresses for each time that it is
    asked, the last of them for ever."""
    known: dict[str, list[list[str]]] = {}
    real = socket.getaddrinfo

    def getaddrinfo(host: str, port: int, *rest: object, **more: object) -> list:
        if host not in known:
            return real(host, port, *rest, **more)  # type: ignore[arg-type]
        answers = known[host]
        found = answers.pop(0) if len(answers) > 1 else answers[0]
        return [answer for address in found for answer in real(address, port, type=socket.SOCK_STREAM)]

    monkeypatch.setattr(socket, "getaddrinfo", getaddrinfo)
    return known
