"""Loading a program without looking for rubbish meanwhile: what modules make as they are loaded stays."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def loading() -> Iterator[None]:
    """A block in which modules are loaded, and all else is made that stays as long as the process does.

    Python would go through all of it again and again while it grows, a quarter of the time that the service takes to
    start. What is there at the end of the block is never gone through again (`gc.freeze`): later looks are short, and
    processes that are forked from this one go on sharing its memory.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if was_enabled:
            gc.enable()
