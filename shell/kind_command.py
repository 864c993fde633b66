"""One command for each job kind: it runs in this process, with a progress bar.

The first input is an argument where it is a picture; every other input is an option of its own name.
"""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Mapping
from errno import EDQUOT, ENOSPC
from pathlib import Path
from typing import Any

import click
from pydantic import BaseModel, ValidationError
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from engine import run as engine_run
from engine.errors import Canceled, InputError
from engine.kind import Input, Kind
from engine.run import Run
from engine.store import StageStore
from service.kinds import library
from service.settings import MEGABYTE, Settings
from shell.complaint import Complaint
from shell.noise import libraries_silenced
from shell.settings import read_settings


def kind_command(kind: Kind) -> click.Command:
    """The command that runs a job kind."""
    out = click.Option(["-o", "--out"], required=True, metavar="DIR", help="Where the results go; made if needed.")
    options = click.Option(
        ["--options"], metavar="JSON|@FILE", default="{}", help="The options, as the API takes them."
    )

    def command(out: str, options: str, **given: Any) -> None:
        settings = read_settings()
        inputs = {item.name: found for item in kind.inputs if (found := _input(item, given[item.name])) is not None}
        _run(kind, inputs, _options(kind, options), Path(out), settings)

    parameters = [_parameter(item, place) for place, item in enumerate(kind.inputs)]
    return click.Command(kind.name, params=[*parameters, out, options], callback=command, help=kind.summary)


def _parameter(item: Input, place: int) -> click.Parameter:
    metavar = "DIR" if item.many else item.media.upper() + ("|NAME" if item.library else "")
    if place == 0 and item.media == "image":
        return click.Argument([item.name], required=item.required, metavar=item.name.upper())
    flag = "--" + item.name.replace("_", "-")
    return click.Option([flag, item.name], required=item.required, metavar=metavar, help=item.description)


def _input(item: Input, given: str | None) -> Path | tuple[Path, ...] | None:
    if given is None:
        return None
    path = Path(given)
    if item.many and path.is_dir():
        return tuple(sorted(one for one in path.iterdir() if one.is_file() and not one.name.startswith(".")))
    if path.is_file():
        return (path,) if item.many else path
    offered = library.names(item.library) if item.library is not None else ()
    if given in offered:
        return library.item(item.library or "", given)
    built_in = f", nor a built-in one of this name ({', '.join(offered)})" if item.library is not None else ""
    raise Complaint(f"{item.name}: there is no file {given}{built_in}")


def _options(kind: Kind, text: str) -> BaseModel:
    try:
        if text.startswith("@"):
            text = Path(text[1:]).read_text()
        return kind.options.model_validate(json.loads(text))
    except OSError as error:
        raise Complaint(f"--options: {text[1:]} cannot be read: {error.strerror}") from error
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise Complaint(f"--options: {place or 'the whole'}: {first['msg']}") from error
    except ValueError as error:
        raise Complaint(f"--options: this is not valid JSON: {error}") from error


def _run(
    kind: Kind, inputs: Mapping[str, Path | tuple[Path, ...]], options: BaseModel, out: Path, settings: Settings
) -> None:
    cache = StageStore(settings.data_dir / "cache")
    try:
        out.mkdir(parents=True, exist_ok=True)
        with (
            tempfile.TemporaryDirectory(prefix=".galatea-", dir=out) as draft,
            libraries_silenced() as shown,
            _bar(Console(file=shown)) as bar,
        ):
            task = bar.add_task(kind.name, total=1.0)

            def report(progress: engine_run.Progress) -> None:
                bar.update(task, completed=progress.fraction, description=progress.message or progress.stage)

            run = Run(store=cache, on_progress=report, limits=settings.limits)
            kind.work(inputs, options, Path(draft), run)
            results = [Path(shutil.move(made, out / made.name)) for made in sorted(Path(draft).iterdir())]
    except InputError as error:
        raise Complaint(f"{error.code}: {error.detail}") from error
    except Canceled:
        raise click.Abort from None
    except OSError as error:
        if error.errno in (ENOSPC, EDQUOT) or isinstance(error, PermissionError | NotADirectoryError | FileExistsError):
            raise Complaint(f"{error.filename or out}: {error.strerror}") from error
        raise
    for notice in run.notices:
        click.echo(f"{click.style(notice.code, fg='yellow')}: {notice.message}", err=True)
    for result in results:
        click.echo(result)
    cache.trim(settings.cache_mb * MEGABYTE)


def _bar(console: Console) -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
