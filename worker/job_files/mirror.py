"""What the stages of a job found, kept in the storage too, where that is not a folder of this machine: so another
machine can go on with the job, and a revision can run anywhere.

A stage's output is one object, a plain tar of its files. What is in it was written by a process that may be in a
stranger's hands: only plain files under plain names go in, and only such come out.
"""

from __future__ import annotations

import queue
import re
import shutil
import tarfile
import tempfile
import threading
from contextvars import copy_context
from pathlib import Path

import structlog

from service.jobs.stages import stages_prefix
from service.storage.files import Storage
from worker.job_files.plain_files import FILE_NAME_PATTERN, FileRefused, open_plain

KEY_PATTERN = re.compile(r"[0-9a-f]{40}")
MAX_MIRROR_BYTES = 1_000_000_000
"""The most bytes of one output, and of all that are fetched for one attempt. What is larger is worked out anew
elsewhere."""


class Mirror:
    """The copies of one job tree's stages. A thread of its own sends them, so that nobody waits for the storage."""

    def __init__(self, storage: Storage, tree: str, folder: Path, temporary: Path):
        self._storage = storage
        self._prefix = stages_prefix(tree)
        self._folder = folder
        self._temporary = temporary
        self._waiting: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._sent: set[str] = set()
        self._abandoned = False
        self._thread = threading.Thread(target=copy_context().run, args=(self._send_all,), name="mirror", daemon=True)
        if storage.folder is None:
            self._thread.start()

    def restore(self) -> None:
        """Fetch the outputs that this machine lacks, the newest first. Raises OSError."""
        if self._storage.folder is not None:
            return
        left = MAX_MIRROR_BYTES
        for key, size in self._storage.sizes(self._prefix).items():
            name = key.rpartition("/")[2]
            self._sent.add(name)
            left -= size
            if left > 0 and KEY_PATTERN.fullmatch(name) and not (self._folder / name).exists():
                self._fetch(key, name)

    def keep(self, key: str) -> None:
        """Send a stage's output, soon."""
        if self._storage.folder is None and KEY_PATTERN.fullmatch(key) and (self._folder / key).is_dir():
            self._waiting.put(key)

    def close(self, wait: bool) -> None:
        """Send no more; the rest is sent before that, or given up where there is nobody to wait."""
        self._abandoned = not wait
        self._waiting.put(None)
        if wait and self._thread.is_alive():
            self._thread.join()

    def _send_all(self) -> None:
        while (key := self._waiting.get()) is not None:
            try:
                if key not in self._sent and not self._abandoned:
                    self._send(key)
                    self._sent.add(key)
            except (FileRefused, OSError) as error:
                structlog.get_logger().warning("stage_not_mirrored", stage=key, reason=str(error))

    def _send(self, key: str) -> None:
        with tempfile.TemporaryFile(dir=self._temporary) as packed:
            with tarfile.open(fileobj=packed, mode="w") as tar:
                for path in sorted((self._folder / key).iterdir()):
                    with open_plain(path) as file:
                        entry = tarfile.TarInfo(path.name)
                        entry.size = path.lstat().st_size
                        if packed.tell() + entry.size > MAX_MIRROR_BYTES:
                            raise FileRefused("it is too large")
                        tar.addfile(entry, file)
            packed.seek(0)
            self._storage.put(f"{self._prefix}/{key}", packed)

    def _fetch(self, key: str, name: str) -> None:
        draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=self._folder))
        try:
            packed = self._storage.fetch(key, self._temporary / name)
            with tarfile.open(packed, mode="r:") as tar:
                for entry in tar:
                    content = (
                        tar.extractfile(entry) if entry.isreg() and FILE_NAME_PATTERN.fullmatch(entry.name) else None
                    )
                    if content is not None:
                        with (draft / entry.name).open("xb") as file:
                            shutil.copyfileobj(content, file)
            packed.unlink()
            draft.rename(self._folder / name)
        except (tarfile.TarError, FileNotFoundError, FileExistsError) as error:
            structlog.get_logger().warning("stage_not_restored", stage=name, reason=str(error))
        finally:
            shutil.rmtree(draft, ignore_errors=True)
