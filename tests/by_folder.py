"""Which tests stay together in one of several processes: those of a file, and of a folder that shares fixtures."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from xdist.scheduler import LoadScopeScheduling

TESTS = Path(__file__).parent


@cache
def shared_folder(path: str) -> str:
    """The outermost folder below `tests` that a test file lies in and that has a `conftest.py`; else the file itself.

    What such a folder's tests share is made once, not by each process that is given one of its files.
    """
    folders = [folder for folder in (TESTS.parent / path).parents if TESTS in folder.parents]
    shared = [folder for folder in folders if (folder / "conftest.py").exists()]
    return str(shared[-1].relative_to(TESTS.parent)) if shared else path


class ByFolder(LoadScopeScheduling):
    """`--dist loadfile` for tests whose folders share fixtures."""

    def _split_scope(self, nodeid: str) -> str:
        return shared_folder(nodeid.split("::", 1)[0])
