"""Reading what a job's process has left: that process may be in a stranger's hands."""

from __future__ import annotations

import os
import re
import stat
from io import BufferedReader
from pathlib import Path

FILE_NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,127}")
"""What a file may be called."""


class FileRefused(Exception):
    """What the process left cannot be taken: a name that cannot be one, a link, a folder."""


def open_plain(path: Path) -> BufferedReader:
    """A plain file under a plain name, itself and never what a link points at. Raises `FileRefused`."""
    if FILE_NAME_PATTERN.fullmatch(path.name) is None:
        raise FileRefused(f"“{path.name}” cannot be the name of a file")
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        raise FileRefused(f"“{path.name}” is not a plain file: {error.strerror}") from error
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise FileRefused(f"“{path.name}” is not a plain file")
    return os.fdopen(descriptor, "rb")
