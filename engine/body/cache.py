"""The converted template on disk: MakeHuman's text files take half a minute to read, the cache a blink."""

from __future__ import annotations

import os
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from engine.body import makehuman
from engine.npz import read_npz

CACHE_FORMAT = 3
"""Raise it when what is stored changes; older files are then left aside."""


def cache_folder() -> Path:
    """Where things that can be made again are kept: under `GALATEA_DATA_DIR`, else the user's cache folder."""
    if chosen := os.environ.get("GALATEA_DATA_DIR"):
        return Path(chosen) / "cache"
    if sys.platform == "darwin":
        return Path.home() / "Library/Caches/galatea"
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home())) / "galatea/Cache"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "galatea"


def cached_arrays(name: str, convert: Callable[[], Mapping[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """The arrays stored under `name`, converted first if they are not there yet.

    Published by one rename: another process sees the whole file or none. A file that cannot be read is
    converted anew.
    """
    path = cache_folder() / "template" / f"{name}-{makehuman.version()}-{CACHE_FORMAT}.npz"
    try:
        return read_npz(path)
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile):
        pass
    arrays = dict(convert())
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".draft-") as draft:
        np.savez(Path(draft, "arrays.npz"), **arrays)  # type: ignore[arg-type]
        Path(draft, "arrays.npz").replace(path)
    return arrays
