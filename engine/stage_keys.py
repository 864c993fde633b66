"""Under which key the output of a stage is kept: what it was made of, and by what."""

from __future__ import annotations

import hashlib
import json
import weakref
from collections.abc import Callable, Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel

import engine

STAGE_FORMAT = 3
"""Of what stages give: raised where it changes between releases, so that nothing older is taken for it."""


class StageKeys:
    """Keys of the stages of one run, who remembers what earlier stages gave.

    `erased` are files that are not there any more, with the SHA-256 of what was in them.
    """

    def __init__(self, erased: Mapping[Path, str]):
        self._erased = erased
        self._outputs: dict[int, tuple[Callable[[], Any], str]] = {}

    def remember(self, output: Any, key: str) -> None:
        """That a stage whose key is `key` gave `output`: as an argument of later stages it counts by that."""
        self._outputs[id(output)] = (_reference(output), key)

    def key(self, name: str, *arguments: Any) -> str:
        """The key (hex) of a stage's output for these arguments; callables among them do not count.

        Raises `TypeError` where an argument has no value that could be written down.
        """
        parts = [
            engine.__version__,
            STAGE_FORMAT,
            name,
            *(self._part(argument) for argument in arguments if not callable(argument)),
        ]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:40]

    def _part(self, argument: Any) -> Any:
        if id(argument) in self._outputs and self._outputs[id(argument)][0]() is argument:
            return self._outputs[id(argument)][1]
        if isinstance(argument, Path):
            return self._erased.get(argument) or content_hash(argument)
        if isinstance(argument, BaseModel):
            return argument.model_dump(mode="json")
        if isinstance(argument, np.ndarray):
            return [
                str(argument.dtype),
                argument.shape,
                hashlib.sha256(np.ascontiguousarray(argument).data).hexdigest(),
            ]
        if is_dataclass(argument) and not isinstance(argument, type):
            return {k: self._part(v) for k, v in vars(argument).items()}
        if isinstance(argument, tuple | list):
            return [self._part(item) for item in argument]
        if isinstance(argument, Mapping):
            return {name: self._part(argument[name]) for name in sorted(argument)}
        if argument is None or isinstance(argument, str | int | float | bool):
            return argument
        raise TypeError(f"a stage cannot be keyed by {type(argument).__name__}")


def content_hash(path: Path) -> str:
    """SHA-256 of a file's content (hex)."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _reference(output: Any) -> Callable[[], Any]:
    """What gives an output as long as somebody else holds it, where Python can tell."""
    try:
        return weakref.ref(output)
    except TypeError:
        return lambda: output
