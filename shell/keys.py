"""`galatea keys`: make, list and revoke the keys that open the service to others."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import click
from pydantic import ValidationError
from rich.console import Console
from rich.table import Table
from sqlalchemy.orm import Session

from service.auth import repository
from service.auth.tokens import KEY_HINT_CHARACTERS
from service.database.sessions import Database
from service.keys import service
from service.keys.schemas import KeyIn
from service.links import repository as links
from service.problems import Problem
from service.tables.keys import Key
from service.vault import new_key
from shell.cli_error import CliError
from shell.settings import read_settings

MAX_LINKS = 1000
MAX_ROW_CHARACTERS = 10_000
"""Characters of a row that another program reads."""


@click.group()
def keys() -> None:
    """Keys that open the service to others."""


@keys.command()
@click.argument("name")
@click.option("--scope", "scopes", multiple=True, help="read, submit or admin; may be given several times.")
@click.option("--expires-in-days", type=float, help="How long it is good; for good if not given.")
@click.option("--requests-per-minute", type=int, help="A limit of its own (GALATEA_REQUESTS_PER_MINUTE).")
@click.option("--jobs-at-once", type=int, help="A limit of its own (GALATEA_JOBS_AT_ONCE).")
@click.option("--stored-mb", type=int, help="A limit of its own (GALATEA_STORED_MB).")
@click.option("--if-none", is_flag=True, help="Only if no key opens the service yet.")
def create(name: str, scopes: tuple[str, ...], if_none: bool, **limits: float | None) -> None:
    """Make a key. It is printed alone, this once: keep it safe."""
    try:
        requested = KeyIn.model_validate({"name": name, **({"scopes": list(scopes)} if scopes else {}), **limits})
    except ValidationError as error:
        first = error.errors()[0]
        raise CliError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}") from None
    with _writing() as session:
        if if_none and repository.any_usable(session):
            return
        key, token = service.create(session, requested)
        click.echo(f"Key {key.id} “{key.name}” may {', '.join(key.scopes)}.", err=True)
    click.echo(token)


@keys.command("list")
def show() -> None:
    """All keys, without what opens them."""
    with _writing() as session:
        found = repository.with_tokens(session)
    table = Table(box=None)
    longest = max((len(key.id) for key in found), default=0)
    table.add_column("id", no_wrap=True, min_width=longest)  # it is copied, and asked for by other programs
    for heading in ("name", "begins with", "scopes", "state", "last used"):
        # What a key begins with is looked for, too: it stays in one piece.
        whole = KEY_HINT_CHARACTERS if heading == "begins with" else None
        table.add_column(heading, overflow="fold", min_width=whole)
    for key in found:
        used = f"{key.last_used_at:%Y-%m-%d %H:%M}" if key.last_used_at else "never"
        table.add_row(key.id, key.name, key.hint, " ".join(key.scopes), _state(key), used)
    _print(table)


@keys.command()
@click.argument("key_id")
def revoke(key_id: str) -> None:
    """Make a key worthless. What belongs to it stays."""
    try:
        with _writing() as session:
            service.revoke(session, key_id)
    except Problem as problem:
        raise CliError(problem.detail) from None


@keys.command("links")
def show_links() -> None:
    """The public links of all keys, newest first, without what opens them."""
    with _writing() as session:
        found = links.page(session, None, MAX_LINKS, None)
    table = Table(box=None)
    for heading in ("id", "begins with", "key", "job", "made", "good until"):
        table.add_column(heading, overflow="fold")
    for link in found:
        until = f"{link.expires_at:%Y-%m-%d %H:%M}" if link.expires_at else "it is revoked"
        table.add_row(link.id, link.hint, link.owner, link.job_id, f"{link.created_at:%Y-%m-%d}", until)
    _print(table)


@keys.command("revoke-link")
@click.argument("link_id", required=False)
@click.option("--all", "everything", is_flag=True, help="All links of all keys.")
@click.option("--key", "key_id", help="All links of this key.")
def revoke_link(link_id: str | None, everything: bool, key_id: str | None) -> None:
    """Take a public link back, or many."""
    if [link_id is not None, everything, key_id is not None].count(True) != 1:
        raise CliError("Name one link (`galatea keys links` lists them), or say --key or --all.")
    with _writing() as session:
        gone = links.revoke_all(session, key_id) if link_id is None else int(links.revoke(session, None, link_id))
    if link_id is not None and not gone:
        raise CliError("There is no such link.")
    click.echo(f"Links that were taken back: {gone}.")


@keys.command("secrets-key")
def secrets_key() -> None:
    """A fresh key for GALATEA_SECRETS_KEY. It is printed alone, and kept nowhere: keep it safe."""
    click.echo(new_key())


@contextmanager
def _writing() -> Iterator[Session]:
    settings = read_settings()
    settings.data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
    database = Database(settings.database, vault=settings.vault)
    database.upgrade()
    try:
        with database.write() as session:
            yield session
    finally:
        database.close()


def _state(key: Key) -> str:
    if key.revoked_at is not None:
        return f"revoked {key.revoked_at:%Y-%m-%d}"
    return "good" if key.expires_at is None else f"until {key.expires_at:%Y-%m-%d %H:%M}"


def _print(table: Table) -> None:
    """As wide as the terminal; for another program, each row on one line, however long."""
    console = Console()
    if not console.is_terminal:
        console.width = MAX_ROW_CHARACTERS
    console.print(table)
