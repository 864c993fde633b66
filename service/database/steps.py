"""The steps between versions of the tables, by alembic."""

from __future__ import annotations

from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from alembic.script.revision import RevisionError
from alembic.util import CommandError
from sqlalchemy.engine import Connection

from engine.package_data import package_folder
from service.vault import Vault

UNKNOWN_VERSION_ERRORS = (CommandError, RevisionError)
"""What alembic raises where there is no such version, or none on the way."""


def move(connection: Connection, revision: str, down: bool, vault: Vault) -> None:
    """Bring the tables to a version, up or down. Raises alembic's `CommandError` where there is no such version."""
    config = alembic_config()
    config.attributes |= {"connection": connection, "vault": vault}
    (command.downgrade if down else command.upgrade)(config, revision)


def aim(revision: str) -> str | None:
    """The version that is meant by what was named (`head`, a version, the beginning of one). Raises alembic's
    `CommandError` where there is none."""
    found = _scripts().get_revision(revision)
    return found.revision if found is not None else None


def _scripts() -> ScriptDirectory:
    return ScriptDirectory.from_config(alembic_config())


def below(revision: str | None) -> list[str]:
    """The versions that were passed on the way to one: going there is going down."""
    passed = [script.revision for script in _scripts().iterate_revisions(revision, "base")] if revision else []
    return ["base", *passed[1:]] if passed else []


def alembic_config() -> Config:
    """Where the migrations are."""
    config = Config()
    config.set_main_option("script_location", str(package_folder("service.migrations")))
    return config
