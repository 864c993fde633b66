"""One command for each job kind: it runs in this process, with a progress bar.

The first input is an argument where it is of pictures or the only one; every other input is an option of its own name.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from errno import EDQUOT, ENOSPC
from pathlib import Path
from typing import Any, TextIO

import click
from click.shell_completion import CompletionItem
from pydantic import BaseModel, ValidationError

from engine.delivery import deliver
from engine.errors import Canceled, InputError
from engine.kind import AUTO_CHOICE, Candidates, Given, Input, Kind
from engine.package_data import IncompleteInstallation
from engine.run import Progress, Run
from engine.store import StageStore, trim
from engine.unknown_options import with_suggestions
from service.catalogue import built_in
from service.settings import BYTES_PER_MEGABYTE, Settings
from shell.cli_error import CliError
from shell.option_flags import flag_of, form_of, given_options, option_flags
from shell.settings import read_settings
from shell.silence_libraries import silence_libraries

EXAMPLE_OPTIONS = """'{"fps": 24}'"""
MISFORMED_ERRORS = (
    "tuple_type",
    "missing",
    "too_short",
    "too_long",
    "literal_error",
    "int_parsing",
    "int_type",
    "float_parsing",
)
"""What pydantic calls a value that does not have the form of a list of numbers."""


def kind_command(kind: Kind) -> click.Command:
    """The command that runs a job kind."""
    out = click.Option(["-o", "--out"], required=True, metavar="DIR", help="Where the results go; made if needed.")
    options = click.Option(
        ["--options"],
        metavar="JSON|@FILE",
        default="{}",
        help="Options as the API takes them; what flags say counts more.",
    )

    def command(out: str, options: str, **given: Any) -> None:
        settings = read_settings()
        named = {item.named_by: name for item in kind.inputs if item.named_by and (name := _name(given[item.name]))}
        files = {item.name: None if item.named_by in named else given[item.name] for item in kind.inputs}
        inputs = {item.name: found for item in kind.inputs if (found := _input(item, files[item.name])) is not None}
        chosen = _options(kind, options, given, named)
        for item in kind.inputs:
            if item.needed(chosen, inputs) and item.name not in inputs:
                raise CliError(f"{item.name} is missing, --{item.name.replace('_', '-')}: {item.description}")
        _run(kind, inputs, chosen, Path(out), settings)

    alone = len(kind.inputs) == 1
    parameters = [_parameter(item, place, alone) for place, item in enumerate(kind.inputs)]
    taken = {item.name for item in kind.inputs} | {item.named_by for item in kind.inputs if item.named_by}
    flags = option_flags(kind.options, taken)
    return click.Command(kind.name, params=[*parameters, out, *flags, options], callback=command, help=kind.summary)


def _parameter(item: Input, place: int, alone: bool) -> click.Parameter:
    names = "|NAME|auto" if item.auto else "|NAME" if item.named_by else ""
    metavar = "DIR" if item.many else item.media.upper() + names
    if alone or (place == 0 and item.media in ("image", "photos")):
        return click.Argument([item.name], required=item.always_needed, metavar=item.name.upper())
    flag = "--" + item.name.replace("_", "-")
    built_in_names = ", ".join(built_in.names(item.library)) if names and item.library is not None else ""
    told = f"{item.description} Built in: {built_in_names}." if built_in_names else item.description
    return click.Option(
        [flag, item.name], required=item.always_needed, metavar=metavar, help=told, shell_complete=_names_of(item)
    )


def _names_of(item: Input) -> Callable[[click.Context, click.Parameter, str], list[CompletionItem]]:
    """What a shell offers where the input is asked for: what is built in, and files."""
    names = (*built_in.names(item.library), *([AUTO_CHOICE] if item.auto else [])) if item.library is not None else ()

    def complete(context: click.Context, parameter: click.Parameter, begun: str) -> list[CompletionItem]:
        found = [CompletionItem(name) for name in names if name.startswith(begun)]
        return [*found, CompletionItem(begun, type="dir" if item.many else "file")]

    return complete


def _input(item: Input, given: str | None) -> Given | None:
    if given is None:
        return None
    path = Path(given)
    if item.many and path.is_dir():
        return tuple(sorted(one for one in path.iterdir() if one.is_file() and not one.name.startswith(".")))
    if path.is_file():
        return (path,) if item.many else path
    offered = built_in.names(item.library) if item.library is not None else ()
    if item.auto and given == AUTO_CHOICE:
        return Candidates({name: built_in.item(item.library or "", name) for name in offered})
    if given in offered:
        return built_in.item(item.library or "", given)
    nor_named = f", nor a built-in one of this name ({', '.join(offered)})" if item.library is not None else ""
    raise CliError(f"{item.name}: there is no file {given}{nor_named}")


def _name(given: str | None) -> str | None:
    """What was given, if it is the name of something built in and no file."""
    return given if given is not None and not Path(given).is_file() and Path(given).name == given else None


def _options(kind: Kind, text: str, given: Mapping[str, Any], named: Mapping[str, str]) -> BaseModel:
    """The options of which JSON, flags and the names of what is built in tell."""
    flags: dict[str, Any] = {}
    try:
        if text.startswith("@"):
            text = Path(text[1:]).read_text()
        document = json.loads(text)
        flags = given_options(kind.options, given)
        return kind.options.model_validate({**document, **flags, **named} if isinstance(document, dict) else document)
    except OSError as error:
        raise CliError(f"--options: {error.filename} cannot be read: {error.strerror}") from error
    except ValidationError as error:
        first = with_suggestions(error.errors(), kind.options)[0]
        place = [str(part) for part in first["loc"]]
        if place and place[0] in flags:
            form = form_of(kind.options.model_fields[place[0]]) if first["type"] in MISFORMED_ERRORS else None
            raise CliError(f"{flag_of(place[0])}: {f'give {form}' if form else first['msg']}") from error
        raise CliError(f"--options: {'.'.join(place) or 'the whole'}: {first['msg']}") from error
    except ValueError as error:
        raise CliError(f"--options: this is not valid JSON, such as {EXAMPLE_OPTIONS}: {error}") from error


def _run(kind: Kind, inputs: Mapping[str, Given], options: BaseModel, out: Path, settings: Settings) -> None:
    cache = StageStore(settings.data_dir / "shell")
    try:
        with (
            silence_libraries() as shown,
            _bar(kind.name, shown) as report,
            Run(cache, on_progress=report, limits=settings.limits, mark_synthetic=settings.mark_synthetic) as run,
        ):
            results = deliver(kind, inputs, options, out, run)
    except InputError as error:
        raise CliError(f"{error.code}: {error.detail}") from error
    except Canceled:
        raise click.Abort from None
    except IncompleteInstallation as error:
        raise click.ClickException(error.detail) from error
    except OSError as error:
        if error.errno in (ENOSPC, EDQUOT) or isinstance(error, PermissionError | NotADirectoryError | FileExistsError):
            raise CliError(f"{error.filename or out}: {error.strerror}") from error
        raise
    for notice in run.notices:
        click.echo(f"{click.style(notice.code, fg='yellow')}: {notice.message}", err=True)
    for result in results:
        click.echo(result)
    trim([cache.folder], settings.cache_mb * BYTES_PER_MEGABYTE)


@contextmanager
def _bar(name: str, shown: TextIO) -> Iterator[Callable[[Progress], None]]:
    """A progress bar where somebody can see it; what moves it."""
    if not shown.isatty():
        yield lambda progress: None
        return
    from rich import console  # slow to import, and only a terminal needs it
    from rich import progress as bars

    columns = (
        bars.TextColumn("{task.description}"),
        bars.BarColumn(),
        bars.TaskProgressColumn(),
        bars.TimeRemainingColumn(),
    )
    with bars.Progress(*columns, console=console.Console(file=shown), transient=True) as bar:
        task = bar.add_task(name, total=1.0)
        yield lambda now: bar.update(task, completed=now.fraction, description=now.message or now.stage)
