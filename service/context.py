"""What every part of service and worker works with: settings, database, storage, queue and the job kinds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.kind import Kind
from service.catalogue.registry import load_kinds, require_known
from service.database.sessions import Database
from service.disk import keep_ballast
from service.queue import Queue
from service.settings import Settings
from service.storage.bucket import Bucket
from service.storage.files import Storage
from service.traces.tracer import Traces


@dataclass(frozen=True)
class Context:
    """The opened parts."""

    settings: Settings
    kinds: Mapping[str, Kind]
    database: Database
    storage: Storage
    queue: Queue
    traces: Traces

    @classmethod
    def open(cls, settings: Settings, part: str = "api") -> Context:
        """Open everything, making the data folder and the tables where they are not there yet. `part` is what this
        process is, for the traces."""
        settings.data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
        keep_ballast(settings)
        kinds = load_kinds(settings.kinds)
        require_known(settings.worker_kinds, kinds)
        database = Database(settings.database, settings.database_connections, settings.vault)
        database.upgrade()
        traces = Traces(settings.traces_url, part)
        return cls(settings, kinds, database, open_storage(settings), Queue(settings, kinds), traces)

    def close(self) -> None:
        self.queue.close()
        self.database.close()
        self.traces.close()


def open_storage(settings: Settings) -> Storage:
    """The bucket of the settings, or a folder in the data folder."""
    return Bucket(settings) if settings.storage_url is not None else Storage(settings.data_dir / "storage")
