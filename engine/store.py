"""What stages found, on disk: arrays as npz, the rest as JSON, never pickle.

Each output is a folder named by its key, written under a temporary name and published by one rename,
so that a killed process leaves either a whole output or none.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import time
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from engine.errors import Notice
from engine.npz import read_npz

T = TypeVar("T")

IN_USE_SECONDS = 3600.0
"""Seconds since its last use within which an output is not erased."""


@dataclass(frozen=True)
class StoredOutput:
    """A stored output."""

    folder: Path

    def load(self, kind: Any) -> tuple[list[Notice], Any]:
        """The notices that the stage gave and its output, of type `kind`."""
        document = json.loads((self.folder / "output.json").read_text())
        output = _unpack(kind, document["output"], read_npz(self.folder / "arrays.npz"), self.folder)
        return [Notice(**notice) for notice in document["notices"]], output


class StageStore:
    """A folder of stage outputs by key."""

    def __init__(self, folder: Path):
        self.folder = folder

    def find(self, key: str) -> StoredOutput | None:
        """The output stored under `key`, if there is one; it counts as just used."""
        folder = self.folder / key
        try:
            os.utime(folder)
        except FileNotFoundError:
            return None
        return StoredOutput(folder)

    def load(self, key: str, kind: Any) -> tuple[list[Notice], Any] | None:
        """The notices and the output stored under `key`; None if there is none that can be read.

        One that cannot be read (the power failed before the disk had it all, or another version wrote it) is thrown
        away, to be made anew.
        """
        found = self.find(key)
        if found is None:
            return None
        try:
            return found.load(kind)
        except (OSError, ValueError, EOFError, LookupError, TypeError, AttributeError, zipfile.BadZipFile):
            shutil.rmtree(found.folder, ignore_errors=True)
            return None

    def save(self, key: str, output: T, notices: Sequence[Notice] = (), kind: Any = None) -> T:
        """Store a dataclass of arrays, numbers, strings, tuples, files, further such dataclasses, and mappings from names to these.

        Files (`Path`) are moved into the store. Returns what `load` would, of type `kind` (by default the output's), but for
        the arrays, which are not read again: those of a long clip would be there twice.
        """
        if isinstance(output, Mapping) and kind is None:
            raise TypeError("a mapping alone cannot be stored without its type: what it holds is not told by it")
        self.folder.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=self.folder))
        try:
            arrays: dict[str, np.ndarray] = {}
            document = {"notices": [asdict(notice) for notice in notices], "output": _pack(output, "", arrays, draft)}
            written = json.dumps(document)
            (draft / "output.json").write_text(written)
            np.savez(draft / "arrays.npz", **arrays)  # type: ignore[arg-type]
            self._publish(draft, key)
        finally:
            shutil.rmtree(draft, ignore_errors=True)
        stored: T = _unpack(kind or type(output), json.loads(written)["output"], arrays, self.folder / key)
        return stored

    def discard_drafts(self) -> None:
        """Erase what a killed process began to store; what another may just be storing stays."""
        for draft in self.folder.glob(".draft-*"):
            with suppress(FileNotFoundError):
                if draft.stat().st_mtime < time.time() - IN_USE_SECONDS:
                    shutil.rmtree(draft, ignore_errors=True)

    def _publish(self, draft: Path, key: str) -> None:
        try:
            draft.rename(self.folder / key)
        except OSError:
            if not (self.folder / key).is_dir():  # otherwise another run was faster; both found the same
                raise


def trim(stores: Iterable[Path], most: float) -> None:
    """Erase the outputs that were not used for longest until these stores hold no more than `most` bytes together.

    What was used within the last hour stays: a running job may be about to read it. Others may publish and erase at the
    same time: what is gone when its turn comes is passed over.
    """
    entries = sorted(_entries(stores))
    total = sum(size for _, size, _ in entries)
    limit = time.time() - IN_USE_SECONDS
    for used, size, folder in entries:
        draft = folder.name.startswith(".draft-")
        if used > limit or (total <= most and not draft):
            continue
        # First out of sight in one step, so that nobody finds half of it.
        doomed = folder.with_name(f".draft-erased-{folder.name}")
        with suppress(FileNotFoundError):
            folder.rename(doomed)
        shutil.rmtree(doomed, ignore_errors=True)
        total -= size


def _pack(value: Any, name: str, arrays: dict[str, np.ndarray], folder: Path) -> Any:
    if isinstance(value, np.ndarray) and not value.dtype.hasobject:  # numpy would pickle objects
        arrays[name] = value
        return None
    if isinstance(value, Path):
        shutil.move(value, folder / value.name)
        return value.name
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _pack(getattr(value, f.name), f"{name}.{f.name}", arrays, folder) for f in fields(value)}
    if isinstance(value, tuple | list):
        return [_pack(item, f"{name}.{i}", arrays, folder) for i, item in enumerate(value)]
    if isinstance(value, Mapping) and all(isinstance(key, str) for key in value):
        return {key: _pack(item, f"{name}.{key}", arrays, folder) for key, item in value.items()}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, str | int | float | bool):
        return value
    raise TypeError(f"{name or 'output'}: {type(value).__name__} cannot be stored")


def _unpack(kind: Any, value: Any, arrays: dict[str, np.ndarray], folder: Path, name: str = "") -> Any:
    if name in arrays:
        return arrays[name]
    if value is None:
        return None
    if kind is Path:
        return folder / value
    origin = get_origin(kind)
    if origin in (Union, UnionType):
        return _unpack(next(k for k in get_args(kind) if k is not type(None)), value, arrays, folder, name)
    if origin in (tuple, list):
        inner = get_args(kind)
        kinds = inner[:1] * len(value) if len(inner) < 2 or inner[1] is Ellipsis else inner
        return origin(
            _unpack(k, v, arrays, folder, f"{name}.{i}") for i, (k, v) in enumerate(zip(kinds, value, strict=True))
        )
    if origin in (dict, Mapping):
        return {k: _unpack(get_args(kind)[1], v, arrays, folder, f"{name}.{k}") for k, v in value.items()}
    if is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{k: _unpack(hints[k], v, arrays, folder, f"{name}.{k}") for k, v in value.items()})  # type: ignore[operator]
    return value


def _entries(stores: Iterable[Path]) -> Iterator[tuple[float, int, Path]]:
    """(seconds since the epoch of its last use, bytes, folder) of each output and draft in these stores; what is no folder
    is none."""
    for store in stores:
        with suppress(FileNotFoundError, NotADirectoryError):
            for one in store.iterdir():
                with suppress(FileNotFoundError):
                    yield one.stat().st_mtime, _size(one), one


def _size(folder: Path) -> int:
    """Bytes of the files in a folder, of those that are still there when they are looked at."""
    size = 0
    for place, _, names in os.walk(folder):
        for name in names:
            with suppress(FileNotFoundError):
                size += Path(place, name).stat().st_size
    return size
