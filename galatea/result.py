"""What a call leaves."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from engine.errors import Notice


@dataclass(frozen=True)
class Result:
    """The artifacts of a call, and what the run says about itself.

    It stands for the path of its main artifact wherever a path is taken: `open(result)`, `shutil.copy(result, ...)`.
    """

    path: Path
    """The main artifact: the animation, the profile of a portrait that reacts, the character, the avatar, the persona."""
    artifacts: Mapping[str, Path]
    """All of them, by name."""
    warnings: tuple[Notice, ...]
    """The result stands, but you should know."""
    report: Mapping[str, Any]
    """What `report.json` says: seconds by stage, figures of the inputs, measures of quality."""

    @property
    def folder(self) -> Path:
        """Where the artifacts are."""
        return self.path.parent

    def __fspath__(self) -> str:
        return str(self.path)


def result_of(made: Sequence[Path], main: str, warnings: Sequence[Notice]) -> Result:
    """The result of a run that has left these artifacts."""
    artifacts = {path.name: path for path in made}
    return Result(artifacts[main], artifacts, tuple(warnings), json.loads(artifacts["report.json"].read_text()))
