"""The short lane: jobs of kinds that take seconds do not wait behind those that take minutes.

A worker's slots take the jobs of all its kinds, as messages come. A slot that is busy for an hour would hold up all that
comes after; so there are further places, for the short kinds alone. They need no message: they look in SQL, where each job
is taken once, by a place or by a slot that is free.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

from service.context import Context
from service.job_records import jobs as repository
from worker.job_process.children import ChildLost, WarmChildren

SHORT_LANE_POLL_SECONDS = 0.5
"""How often is looked for a short job; a slot that is free has it at once."""


class ShortLane:
    """Places for short jobs, each a thread that watches over one process."""

    def __init__(
        self,
        context: Context,
        kinds: Sequence[str],
        places: int,
        children: WarmChildren,
        run_next: Callable[[str, WarmChildren], None],
        repeat: Callable[[Callable[[], object], float], None],
    ):
        """`run_next` runs the next job of a kind in one of the `children`; `repeat` does something again and again until
        the worker stops."""
        self._context, self._kinds, self.children, self._run_next = context, kinds, children, run_next
        self._threads = [
            threading.Thread(
                target=repeat, args=(self._look, SHORT_LANE_POLL_SECONDS), name=f"short-lane-{place}", daemon=True
            )
            for place in range(places)
        ]
        for thread in self._threads:
            thread.start()

    def close(self, seconds: float) -> None:
        """Wait so long for the jobs to be given back, and end the processes."""
        deadline = time.monotonic() + seconds
        for thread in self._threads:
            thread.join(max(deadline - time.monotonic(), 0.0))
        self.children.close()

    def _look(self) -> None:
        """Run a job of each kind that has one."""
        for kind in self._kinds:
            with self._context.database.read() as session:
                waiting = repository.count_queued(session, kind)
            if waiting:
                try:
                    self._run_next(kind, self.children)
                except ChildLost:
                    return  # the worker is stopping
