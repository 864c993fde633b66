"""That the service is about to end: whoever holds a request back is told, so that every request gets its answer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Annotated

from fastapi import Depends, Request


class Stopping:
    """Begins once, when the service was asked to end. Of the event loop's thread alone."""

    def __init__(self) -> None:
        self._begun = asyncio.Event()
        self._told: set[Callable[[], None]] = set()

    @property
    def begun(self) -> bool:
        return self._begun.is_set()

    def begin(self) -> None:
        """Tell all who are to be told."""
        self._begun.set()
        for tell in list(self._told):
            tell()

    def tell(self, told: Callable[[], None]) -> None:
        """Have this called when it begins."""
        self._told.add(told)

    @contextmanager
    def telling(self, told: Callable[[], None]) -> Iterator[None]:
        """Have this called when it begins while this is open."""
        self._told.add(told)
        try:
            yield
        finally:
            self._told.discard(told)

    async def sleep(self, seconds: float) -> None:
        """Sleep, but no longer than until it begins."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._begun.wait(), seconds)


async def _stopping(request: Request) -> Stopping:
    stopping: Stopping = request.app.state.stopping
    return stopping


InStopping = Annotated[Stopping, Depends(_stopping)]
