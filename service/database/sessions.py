"""The database: sessions that read, sessions that write, and the bringing up to date of its tables.

SQLite and PostgreSQL are spoken to as the files beside this one say. On SQLite one transaction writes at a time. On
PostgreSQL many do, each under READ COMMITTED: a row that a decision rests on is locked first, or the decision stands in
the WHERE of the change itself.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

import structlog
from sqlalchemy import (
    ColumnClause,
    MetaData,
    String,
    TableClause,
    inspect,
    select,
    text,
    update,
)
from sqlalchemy.engine import Connection
from sqlalchemy.exc import DBAPIError, InterfaceError, TimeoutError
from sqlalchemy.orm import Session

from engine.package_data import package_folder
from service.database import postgresql, sqlite
from service.tables import Base
from service.tables.base import Sealed
from service.vault import Vault


class DatabaseInUse(Exception):
    """A service or a worker works with these tables: they cannot be changed under it."""


class DowngradeLosesData(Exception):
    """Going down to an older version erases what that has no room for; the message says what."""


class UnknownVersion(Exception):
    """The tables are of a version that this release does not know."""


class Database:
    """An open database."""

    def __init__(self, url: str, connections: int = 20, vault: Vault | None = None):
        """`connections` are the most that this process opens to a PostgreSQL server; without a `vault`, secrets are
        kept in clear."""
        self._vault = vault or Vault()
        self.url = url
        self._kind = postgresql if postgresql.is_postgresql_url(url) else sqlite
        self._engine = self._kind.engine(url, connections)
        self._engine.dialect.galatea_vault = self._vault
        self._writing = self._engine.execution_options(galatea_writes=True)
        self._writers = self._kind.writers()

    @contextmanager
    def read(self) -> Iterator[Session]:
        """A session that sees one moment and writes nothing."""
        with Session(self._engine, expire_on_commit=False) as session:
            yield session

    @contextmanager
    def write(self) -> Iterator[Session]:
        """A session whose changes become true together when the block ends, or not at all."""
        with self._writers(), Session(self._writing, expire_on_commit=False) as session, session.begin():
            yield session

    def upgrade(self) -> None:
        """Bring the tables to the newest version, and secrets under the first key of the vault.

        Safe when several processes start at once. An older release that is still running beside it goes on, but for what
        was renamed since (public links) and what a key has encrypted. Raises `UnknownVersion`.
        """
        with self._kind.alone(self.url) as connection:
            here = _version(connection)
            connection.rollback()
            if here != newest_version():
                from service.database import steps  # slow to import, and mostly there is nothing to do

                try:
                    steps.move(connection, "head", False, self._vault)
                except steps.UNKNOWN_VERSION_ERRORS as error:
                    raise UnknownVersion(str(error)) from error
        self._seal_anew()

    def _seal_anew(self) -> None:
        """Encrypt with the first key what is in clear or under an older one."""
        sealed = lost = 0
        for name, of in _secrets(Base.metadata):
            # The text as it is stored, and not what the column's own type makes of it.
            stored = TableClause(name, ColumnClause("id", String), ColumnClause(of, String))
            with self.read() as session:
                rows = session.execute(select(stored.c.id, stored.c[of]).where(stored.c[of].is_not(None))).all()
            old = [row for row in rows if not self._vault.is_current(row[1])]
            readable = [(id_, text, secret.clear) for id_, text in old if (secret := self._vault.open(text)).clear]
            lost += len(old) - len(readable)
            if not readable:
                continue
            with self.write() as session:
                for id_, text, clear in readable:
                    unchanged = (stored.c.id == id_, stored.c[of] == text)
                    session.execute(update(stored).where(*unchanged).values({of: self._vault.seal(clear)}))
            sealed += len(readable)
        if sealed:
            structlog.get_logger().info("secrets_encrypted", number=sealed)
            self.tidy()  # the log of SQLite still has them as they were
        if lost:
            why = "no key in GALATEA_SECRETS_KEY opens them: put the one back that encrypted them"
            structlog.get_logger().error("secrets_unreadable", number=lost, why=why)

    def migrate(self, revision: str, forget: bool = False) -> None:
        """Bring the tables to a version, up or down, while nobody works with them.

        Going down forgets what the older version cannot hold, and is done only where `forget` says so. Raises
        `DatabaseInUse`, `DowngradeLosesData`, and alembic's `CommandError` where there is no such version.
        """
        from service.database import steps

        self._engine.dispose()  # our own connections, of which none is at work
        with self._kind.alone(self.url) as connection:
            here = _version(connection)
            connection.rollback()
            if here is not None and steps.aim(revision) == here:
                return
            down = revision in steps.below(here)
            if down and not forget:
                raise DowngradeLosesData("; ".join(self._forgotten(connection, revision)) or "nothing")
            with self._kind.unused(self.url, connection) as free:
                if not free:
                    raise DatabaseInUse
                steps.move(connection, revision, down, self._vault)

    def forgets(self, revision: str) -> list[str]:
        """What going to a version would erase, in words: tables, and columns of tables. Empty where it is not older."""
        from service.database import steps

        with self._engine.connect() as connection:
            older = revision in steps.below(_version(connection))
            return self._forgotten(connection, revision) if older else []

    def _forgotten(self, connection: Connection, revision: str) -> list[str]:
        """The tables and columns that are here and not in an older version, which is made to see what it has."""
        with tempfile.TemporaryDirectory(prefix="galatea-") as folder:
            older = Database(f"sqlite:///{folder}/older.db")
            if revision != "base":
                older.migrate(revision)
            with older._engine.connect() as other:
                stays = _columns(other)
            older.close()
        lost = []
        for table, columns in sorted(_columns(connection).items()):
            if table not in stays:
                lost.append(f"the table {table}")
            elif gone := sorted(columns - stays[table]):
                lost.append(f"of {table} {', '.join(gone)}")
        return lost

    def revision(self) -> str | None:
        """The version of the tables; None if there are none yet."""
        with self._engine.connect() as connection:
            return _version(connection)

    def tidy(self) -> None:
        """See to it that what was erased is nowhere on disk, as far as this database can be told to."""
        with self._engine.connect() as connection:
            self._kind.tidy(connection)

    def close(self) -> None:
        self._engine.dispose()


def _version(connection: Connection) -> str | None:
    """The version of the tables, as alembic wrote it down; None if there are none yet."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.scalar(text("SELECT version_num FROM alembic_version"))


def newest_version() -> str:
    """The newest version that there is a migration to: their files begin with it."""
    return max(path.name.partition("_")[0] for path in package_folder("service.migrations.versions").glob("[0-9]*.py"))


def _secrets(tables: MetaData) -> list[tuple[str, str]]:
    """The columns that hold secrets, each with its table, whose rows have an `id`."""
    found = [(table.name, column) for table in tables.sorted_tables for column in table.columns]
    return [(name, column.name) for name, column in found if isinstance(column.type, Sealed)]


def _columns(connection: Connection) -> dict[str, set[str]]:
    """All tables but alembic's own, with the names of their columns."""
    found = inspect(connection)
    names = [name for name in found.get_table_names() if name != "alembic_version"]
    return {name: {column["name"] for column in found.get_columns(name)} for name in names}


def database_unavailable(error: BaseException) -> bool:
    """Whether an error says that the database cannot be reached now, or has no time: later may be better."""
    if isinstance(error, TimeoutError):
        return True  # all connections of this process are in use
    if not isinstance(error, DBAPIError):
        return False
    code = postgresql.error_code(error.orig)
    return (
        error.connection_invalidated
        or isinstance(error, InterfaceError)
        or code.startswith(postgresql.LOST_CONNECTION_CODES)
        or code in postgresql.BUSY_CODES
        or "database is locked" in str(error.orig)
    )


def database_full(error: DBAPIError) -> bool:
    """Whether an error says that there is no room for what was to be written."""
    return "disk is full" in str(error.orig) or postgresql.error_code(error.orig) == postgresql.NO_ROOM
