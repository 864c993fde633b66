"""What every part of service and worker works with: settings, database, storage, queue and the job kinds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request

import service.tables  # noqa: F401  (the tables must know of each other before the first query)
from engine.kind import Kind
from service.database import Database
from service.kinds.registry import load_kinds
from service.queue import Queue
from service.settings import Settings
from service.storage import Storage


@dataclass(frozen=True)
class Context:
    """The opened parts."""

    settings: Settings
    kinds: Mapping[str, Kind]
    database: Database
    storage: Storage
    queue: Queue

    @classmethod
    def open(cls, settings: Settings) -> Context:
        """Open everything, making the data folder and the tables where they are not there yet."""
        settings.data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
        kinds = load_kinds(settings.kinds)
        database = Database(settings.database)
        database.upgrade()
        return cls(settings, kinds, database, Storage(settings.data_dir / "storage"), Queue(settings, kinds))

    def close(self) -> None:
        self.queue.close()
        self.database.close()


def _context(request: Request) -> Context:
    context: Context = request.app.state.context
    return context


InContext = Annotated[Context, Depends(_context)]
