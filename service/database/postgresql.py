"""PostgreSQL, by pg8000: for several machines.

A reading transaction sees one moment (REPEATABLE READ, READ ONLY); a writing one runs under READ COMMITTED. Nothing
waits for ever: a machine that was cut off notices by the timeout of its socket, and the server ends what a machine
that was cut off had begun, so that its locks do not outlive it.
"""

from __future__ import annotations

import ssl
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Dialect, NullPool, create_engine, event, text
from sqlalchemy.engine import Connection, Engine, ExceptionContext, make_url
from sqlalchemy.exc import IntegrityError

URL_SCHEMES = ("postgresql://", "postgres://")
SOCKET_SECONDS = 10
"""How long an answer of the server may take."""

SERVER_SECONDS = 8
"""How long a statement, a wait for a lock, or a pause within a transaction may take. It is less than the socket's: the
server is the first to give up, and nothing is left undecided there."""

UPGRADE_LOCK = 0x67616C61746561
"""The advisory lock under which tables are changed ("galatea")."""

LEAVING_SECONDS = 3.0
"""How long the server may take to notice that a connection was closed."""

USE_LOCK = UPGRADE_LOCK + 1
"""The advisory lock that every connection shares with the others for as long as it is open."""

UNTRANSLATABLE_CODE = "22021"
"""The error code for a text that the server cannot keep."""

NO_ROOM = "53100"
"""The error code of a full disk."""

BUSY_CODES = ("40001", "40P01", "53300", "55P03", "57014")
"""Error codes of a server that has too much to do: conflicts, too many connections, timeouts."""

CONSTRAINT_CODES = "23"
"""The beginning of error codes that say that a constraint would be broken."""

LOST_CONNECTION_CODES = ("08", "57P01", "57P02", "57P03", "25P03")
"""The beginnings of error codes after which a connection is of no use: lost, server stopping, transaction ended."""


def is_postgresql_url(url: str) -> bool:
    """Whether an address means a PostgreSQL server."""
    return url.startswith(URL_SCHEMES)


def address(url: str) -> tuple[URL, dict[str, Any]]:
    """The address as SQLAlchemy takes it, and what else pg8000 is to know. Raises ValueError.

    Beside `postgresql://USER:PASSWORD@HOST:PORT/NAME` it may carry `?host=FOLDER` (the folder of a unix socket),
    `sslmode` (`prefer`, `disable`, `require`, `verify-full`) and `sslrootcert` (a file of certificates to trust).
    """
    given = make_url(url)
    extra = {name: value for name, value in given.query.items() if isinstance(value, str)}
    unknown = sorted(set(given.query) - {"host", "sslmode", "sslrootcert"})
    if unknown:
        raise ValueError(f"{unknown[0]} is not understood; only host, sslmode and sslrootcert are")
    if not given.database:
        raise ValueError("name the database: postgresql://USER:PASSWORD@HOST/NAME")
    arguments: dict[str, Any] = {"timeout": SOCKET_SECONDS, "application_name": "galatea"}
    if "host" in extra:
        folder = Path(extra["host"])
        arguments |= {"unix_sock": str(folder / f".s.PGSQL.{given.port or 5432}"), "ssl_context": False}
        given = given.set(host=None, port=None)
    else:
        arguments["ssl_context"] = _encryption(extra.get("sslmode", "prefer"), extra.get("sslrootcert"))
    return given.set(drivername="postgresql+pg8000", query={}), arguments


def _encryption(mode: str, certificates: str | None) -> ssl.SSLContext | bool | None:
    """pg8000's `ssl_context`: None encrypts where the server can."""
    match mode:
        case "prefer":
            return None
        case "disable":
            return False
        case "require":
            context = ssl.create_default_context()
            context.check_hostname = False
            context.verify_mode = ssl.CERT_NONE
            return context
        case "verify-full":
            return ssl.create_default_context(cafile=certificates)
    raise ValueError(f"sslmode={mode} is not understood; only prefer, disable, require and verify-full are")


def engine(url: str, connections: int) -> Engine:
    """A pool of at most so many connections, each tried before it is used again."""
    place, arguments = address(url)
    kept = min(5, connections)
    made = create_engine(
        place, connect_args=arguments, pool_pre_ping=True, pool_size=kept, max_overflow=connections - kept
    )

    @event.listens_for(made, "do_connect")
    def connect(dialect: Dialect, _: Any, positional: list[Any], named: dict[str, Any]) -> Any:
        from service.database.postgresql_connection import PostgresqlConnection  # whoever has SQLite does without

        return PostgresqlConnection(*positional, **named)

    @event.listens_for(made, "connect")
    def prepare(connection: Any, _: Any) -> None:
        connection.autocommit = True  # the transactions below are ours, not the driver's
        cursor = connection.cursor()
        for name in ("statement_timeout", "lock_timeout", "idle_in_transaction_session_timeout"):
            cursor.execute(f"SET {name} = '{SERVER_SECONDS}s'")
        cursor.execute(f"SELECT pg_advisory_lock_shared({USE_LOCK})")  # where tables are being changed: BUSY
        cursor.close()

    @event.listens_for(made, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("galatea_writes", False)
        connection.exec_driver_sql("BEGIN" if writes else "BEGIN ISOLATION LEVEL REPEATABLE READ, READ ONLY")

    @event.listens_for(made, "handle_error")
    def notice(context: ExceptionContext) -> None:
        error, code = context.original_exception, error_code(context.original_exception)
        if code.startswith(LOST_CONNECTION_CODES):
            context.is_disconnect = True
        if code.startswith(CONSTRAINT_CODES):  # pg8000 tells only of keys that are there twice by this class
            raise IntegrityError(context.statement, context.parameters, error) from error

    return made


def error_code(error: BaseException | None) -> str:
    """The server's code for an error (SQLSTATE); empty where it is none of the server's."""
    details = error.args[0] if error is not None and error.args else None
    return str(details.get("C", "")) if isinstance(details, dict) else ""


def message(error: BaseException | None) -> str:
    """What the server said of an error; empty where it is none of the server's."""
    details = error.args[0] if error is not None and error.args else None
    return str(details.get("M", "")) if isinstance(details, dict) else ""


def redacted_url(url: str) -> str:
    """An address for people to read, without user and password."""
    given = make_url(url)
    host = given.query.get("host") or f"{given.host or 'localhost'}:{given.port or 5432}"
    return f"{host}/{given.database}"


def writers() -> Callable[[], AbstractContextManager[None]]:
    """What a writing transaction is done within: nothing, many write at a time."""
    return nullcontext


@contextmanager
def alone(url: str) -> Iterator[Connection]:
    """A connection for changing the tables, without timeouts; others who ask for one wait."""
    place, arguments = address(url)
    # A server that is not there shows within the usual time: what follows has all the time in the world.
    with _once(place, arguments).connect():
        pass
    opened = _once(place, arguments | {"timeout": None})
    with opened.connect() as connection:
        connection.execute(text(f"SELECT pg_advisory_lock({UPGRADE_LOCK})"))
        connection.commit()  # the lock is the session's and ends with the connection
        yield connection
    opened.dispose()


@contextmanager
def unused(url: str, connection: Connection) -> Iterator[bool]:
    """Whether nobody has the database open but by `alone`; until `connection` is closed, nobody opens it then."""
    deadline = time.monotonic() + LEAVING_SECONDS
    while not (free := bool(connection.scalar(text(f"SELECT pg_try_advisory_lock({USE_LOCK})")))):
        if time.monotonic() > deadline:
            break
        time.sleep(0.1)
    connection.commit()
    yield free


def _once(place: URL, arguments: dict[str, Any]) -> Engine:
    """Connections that are closed after use."""
    return create_engine(place, connect_args=arguments, poolclass=NullPool)


def tidy(connection: Connection) -> None:
    """Nothing to do: the server's autovacuum makes room of what was erased, in its own time."""
