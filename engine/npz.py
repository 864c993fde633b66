"""Reading npz files in several threads at once."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_ONE_AT_A_TIME = threading.Lock()
"""numpy parses each array's header as Python; CPython before 3.11.8 counts the depth of that for all threads together and
now and then raises SystemError when two of them parse (its issue 106905)."""


def read_npz(path: Path) -> dict[str, NDArray[Any]]:
    """Every array of an npz file by its name; none is unpickled.

    Raises
    ------
    OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile : the file cannot be read.
    """
    with _ONE_AT_A_TIME, np.load(path, allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}
