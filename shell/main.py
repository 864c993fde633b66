"""`galatea`: serve, worker, keys, doctor, and one command for each job kind."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
from contextlib import closing
from difflib import get_close_matches

import click

import engine
from worker.programs.interpreter import leave_out_current_folder
from worker.programs.loading import loading

os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")
"""Threads of linear algebra sleep between products. By default they spin for a tenth of a second, on a core that
somebody needs: asked for before NumPy is imported, for all that is started from here."""
os.environ.setdefault("OPENCV_THREAD_POOL_ACTIVE_WAIT_WORKER", "0")
"""OpenCV's likewise: they would go on asking for work, and take from others what they ask with."""


INTERRUPTED_EXIT_CODE = 128 + signal.SIGINT
"""What a shell calls the end of a command by Ctrl-C."""


class Group(click.Group):
    """Commands by name; a wrong one is told with what is nearest to it."""

    def resolve_command(
        self, context: click.Context, arguments: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(context, arguments)
        except click.UsageError as error:
            near = get_close_matches(arguments[0], self.list_commands(context), n=1)
            there = f"Did you mean {near[0]}?" if near else f"There are {', '.join(self.list_commands(context))}."
            raise click.UsageError(f"{error.message} {there}", error.ctx) from error


class Kinds(Group):
    """The fixed commands, and one made from each job kind; the kinds are loaded only where they are asked for."""

    def list_commands(self, context: click.Context) -> list[str]:
        from service.catalogue.registry import load_kinds
        from service.settings import Settings

        return [*super().list_commands(context), *sorted(load_kinds(Settings().kinds))]

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        fixed = super().get_command(context, name)
        if fixed is not None:
            return fixed
        gc.set_threshold(20_000, 20, 20)  # not after 700 new objects: the numeric libraries make many that stay
        from engine.allocation import keep_memory
        from service.catalogue.registry import load_kinds
        from service.settings import Settings
        from shell.kind_command import kind_command

        keep_memory()
        kind = load_kinds(Settings().kinds).get(name)
        return kind_command(kind) if kind is not None else None


class Keys(Group):
    """Commands that are loaded only where they are asked for."""

    def list_commands(self, context: click.Context) -> list[str]:
        from shell.keys import keys

        return keys.list_commands(context)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        from shell.keys import keys

        return keys.get_command(context, name)


@click.group(cls=Kinds)
@click.version_option(engine.__version__, prog_name="galatea")
def main() -> None:
    """Brings still pictures of people to life."""


@main.command()
@click.option("--host", help="The address to bind (GALATEA_HOST; 127.0.0.1).")
@click.option("--port", type=click.IntRange(0, 65535), help="The port; 0 takes a free one (GALATEA_PORT; 8000).")
def serve(host: str | None, port: int | None) -> None:
    """API, web page, embedded Redis and workers in one command."""
    with loading():
        from shell.settings import read_settings

        settings = read_settings(host=host, port=port)
        from shell.serve import serve as run  # seconds, in which wrong settings would wait to be told of

    run(settings)


@main.command()
def worker() -> None:
    """Workers alone, for further machines."""
    with loading():
        from service.logs import configure
        from shell.opening import open_context
        from shell.settings import read_settings
        from worker.app import run

    settings = read_settings()
    configure(settings)
    run(open_context(settings, "worker"))


@main.group("keys", cls=Keys)
def keys() -> None:
    """Keys that open the service to others: create, list, revoke."""


@main.command()
@click.argument("version", default="head")
@click.option("--down", is_flag=True, help="Go down, and erase what the older tables have no room for.")
def migrate(version: str, down: bool) -> None:
    """Bring the database's tables to the newest version, or to another, up or down.

    The service does so by itself when it starts. Going down is for going back to an older release: stop everything,
    make a backup, then name that release's version. What the older tables have no room for is lost, and said before.
    """
    from alembic.util import CommandError

    from service.database.sessions import Database, DatabaseInUse, DowngradeLosesData
    from service.vault import SecretUnreadable
    from shell.cli_error import CliError
    from shell.settings import read_settings

    settings = read_settings()
    with closing(Database(settings.database, vault=settings.vault)) as database:
        try:
            if down and (lost := database.forgets(version)):
                click.echo(f"Going down to {version} erases {'; '.join(lost)}.", err=True)
            database.migrate(version, forget=down)
        except DowngradeLosesData as lost:
            raise CliError(
                f"{version} is older than the tables are. Going down to it erases {lost}. Nothing was done: make a backup, "
                "then say --down."
            ) from None
        except DatabaseInUse:
            raise CliError(
                "The service runs: stop `galatea serve` and every `galatea worker` that uses this database, on all "
                "machines, then migrate. Nothing was done."
            ) from None
        except SecretUnreadable as error:
            raise CliError(f"{error} Nothing was done.") from None
        except CommandError as error:
            raise CliError(f"{version}: {error}") from error
        click.echo(f"The tables are at version {database.revision()}.")


@main.command()
def doctor() -> None:
    """What is installed, what is missing, how to mend it."""
    from shell.doctor import examine

    raise SystemExit(examine())


def run() -> None:
    """`main` as a process of its own, which ends as soon as its work is done and all is left in order.

    Python itself would take apart every module and look for rubbish in what the numeric libraries hold: half a second
    for nothing.
    """
    leave_out_current_folder()
    status: list[int] = []
    atexit.register(lambda: _leave(status))  # the first to be registered is the last to be called
    try:
        _end(main)
    except SystemExit as end:
        status.append(end.code if isinstance(end.code, int) else int(end.code is not None))
        raise


def _end(command: click.Command) -> None:
    """Run the command and exit as it ends: as click does, but for Ctrl-C, of which the code tells."""
    try:
        said = command.main(standalone_mode=False)
    except click.Abort:
        click.echo("Stopped.", err=True)
        sys.exit(INTERRUPTED_EXIT_CODE)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    sys.exit(said if isinstance(said, int) else 0)


def _leave(status: list[int]) -> None:
    """End the process with the `status` that it meant to end with; without one it broke off, and ends as any other."""
    for stream in sys.stdout, sys.stderr:
        stream.flush()
    if status:
        os._exit(status[0])


if __name__ == "__main__":
    run()
