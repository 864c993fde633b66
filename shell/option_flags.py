"""A flag for each option of a job kind, made from the model that says what they may be: `--strength 0.8 --crop bust`."""

from __future__ import annotations

import json
import re
import types
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import click
from pydantic import BaseModel
from pydantic.fields import FieldInfo

PARAMETER_PREFIX = "option_"
"""What the names of these parameters begin with: an input may have the name of an option."""
LIST_SEPARATOR = re.compile(r",|(?<=\d)x(?=\d)")
"""What stands between the parts of a list: `eyes,mouth`, `640x480`."""
PLAIN_METAVARS = {bool: "true|false", int: "N", float: "NUMBER", str: "TEXT"}


def option_flags(options: type[BaseModel], taken: Collection[str]) -> list[click.Option]:
    """The flags of all options but those whose names are `taken`; none has a default, so that what was not given is known."""
    return [_flag(name, field) for name, field in options.model_fields.items() if name not in taken]


def given_options(options: type[BaseModel], given: Mapping[str, Any]) -> dict[str, Any]:
    """What was said by flags, as JSON would say it; takes them from the parameters that a command was given.

    Raises
    ------
    OSError : a file that was named by @ cannot be read.
    """
    found = {
        name: given[PARAMETER_PREFIX + name]
        for name in options.model_fields
        if given.get(PARAMETER_PREFIX + name) is not None
    }
    return {name: _value(said, options.model_fields[name].annotation) for name, said in found.items()}


def flag_of(name: str) -> str:
    """The flag of an option."""
    return "--" + name.replace("_", "-")


def form_of(field: FieldInfo) -> str | None:
    """How an option that may be a list of numbers is said, with an example; None where there is no such example."""
    said = _example(field)
    return said and f"{_metavar(field.annotation)}, such as {said}"


def _example(field: FieldInfo) -> str | None:
    """A list that the option may be, as a flag says it: `300x300`, `0.5,2`."""
    parts = next((one for one in field.examples or () if isinstance(one, tuple)), ())
    return ("x" if len(parts) == 2 and all(isinstance(one, int) for one in parts) else ",").join(
        f"{one:g}" for one in parts
    ) or None


def _flag(name: str, field: FieldInfo) -> click.Option:
    usual = field.default
    told = "" if usual is None or isinstance(usual, bool | tuple | dict) or field.is_required() else f" [{usual}]"
    if example := _example(field):
        told = f" For instance {example}.{told}"
    given: dict[str, Any] = {"default": None, "help": (field.description or "") + told}
    if field.annotation is bool:
        return click.Option([f"{flag_of(name)}/--no-{flag_of(name)[2:]}", PARAMETER_PREFIX + name], **given)
    return click.Option([flag_of(name), PARAMETER_PREFIX + name], metavar=_metavar(field.annotation), **given)


def _alternatives(annotation: Any) -> list[Any]:
    """The types of which an option may be one, without None."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _alternatives(get_args(annotation)[0])
    if origin in (Union, types.UnionType):
        return [one for each in get_args(annotation) for one in _alternatives(each)]
    return [] if annotation is type(None) else [annotation]


def _metavar(annotation: Any) -> str:
    return "|".join(_word(one) for one in _alternatives(annotation))


def _word(kind: Any) -> str:
    if get_origin(kind) is Literal:
        return "|".join(map(str, get_args(kind)))
    if get_origin(kind) is tuple:
        parts = get_args(kind)
        words = [_metavar(part) for part in parts if part is not Ellipsis]
        if any("JSON" in word or "," in word for word in words):
            return "JSON"
        return f"{words[0]},..." if Ellipsis in parts else ",".join(words)
    return PLAIN_METAVARS.get(kind, "JSON")


def _value(said: Any, annotation: Any) -> Any:
    """What a flag says, as JSON would: text stays text where it may be that, and becomes a list where it may be only that."""
    if not isinstance(said, str):
        return said
    kinds = _alternatives(annotation)
    if str in kinds:
        return said
    if said.startswith("@"):
        said = Path(said[1:]).read_text()
    value = _json(said)
    lists = any(get_origin(kind) is tuple for kind in kinds)
    named = any(value in get_args(kind) for kind in kinds if get_origin(kind) is Literal and isinstance(value, str))
    if isinstance(value, str) and lists and not named:
        return [_json(part) for part in LIST_SEPARATOR.split(value)]
    return value


def _json(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text
