"""Opening what the service works with, where a person reads what is wrong."""

from __future__ import annotations

from sqlalchemy.exc import DBAPIError

from service.catalogue.registry import load_kinds, require_known
from service.context import Context
from service.database import postgresql
from service.database.sessions import UnknownVersion
from service.settings import Settings
from shell.cli_error import CliError


def open_context(settings: Settings, part: str) -> Context:
    """The opened parts. Raises `CliError` where a setting, the data folder or the database stands in the way."""
    check_kinds(settings)
    try:
        return Context.open(settings, part)
    except DBAPIError as error:
        raise CliError(explain_database_error(settings, error)) from error
    except UnknownVersion as error:
        raise CliError(
            f"The database is not of this release ({error}): start the newer one, or go back with its `galatea migrate`."
        ) from error
    except OSError as error:
        raise CliError(
            f"{error.filename or settings.data_dir}: {error.strerror or error}. Set GALATEA_DATA_DIR to a folder of "
            "your own."
        ) from error


def check_kinds(settings: Settings) -> None:
    """Raise `CliError` where the job kinds that the settings name are not there."""
    try:
        kinds = load_kinds(settings.kinds)
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise CliError(f"GALATEA_KINDS: {error}. Use module:attribute, of modules that can be imported.") from error
    try:
        require_known(settings.worker_kinds, kinds)
    except ValueError as error:
        raise CliError(str(error)) from error


def explain_database_error(settings: Settings, error: DBAPIError) -> str:
    """What is wrong with the database, and what to do; without its password."""
    if not postgresql.is_postgresql_url(settings.database):
        return f"The database {settings.database.removeprefix('sqlite:///')} cannot be used: {error.orig}."
    place = postgresql.redacted_url(settings.database)
    if said := postgresql.message(error.orig):
        return f"PostgreSQL at {place} refuses: {said}. Correct GALATEA_DATABASE_URL, or what it names."
    return f"PostgreSQL at {place} cannot be reached: start it, or correct GALATEA_DATABASE_URL."
