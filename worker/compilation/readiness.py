"""Which kinds a worker takes jobs of: those that are compiled. The others are rehearsed one by one, in the order of the kinds."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from service.context import Context
from worker.compilation.announcement import announcing, take_back
from worker.compilation.rehearsal import rehearse, unrehearsed


class Readiness:
    """The kinds of a worker, ready or waiting to be rehearsed."""

    def __init__(self, context: Context, kinds: Sequence[str]):
        self._context = context
        self._waiting = unrehearsed({name: context.kinds[name] for name in kinds})
        self.ready = [name for name in kinds if name not in self._waiting]
        """The names of those whose jobs may begin."""
        self._rehearsed = False

    def await_one(self) -> None:
        """Rehearse until there is a kind that is ready. No message is taken meanwhile: those that wait are not lost."""
        if not self.ready:
            with announcing(self._context, self._waiting):
                self._rehearse_next()

    def rehearse_others(self, on_ready: Callable[[str], None]) -> None:
        """Rehearse the others in a thread of their own, beside the jobs of those that are ready; tell of each when it is."""

        def rehearse_all() -> None:
            with announcing(self._context, self._waiting):
                while self._waiting:
                    on_ready(self._rehearse_next())

        if self._waiting:
            threading.Thread(target=rehearse_all, name="rehearsal", daemon=True).start()

    def _rehearse_next(self) -> str:
        """Rehearse one. The first does not give way: somebody waits for it. The others do, as jobs do, to those of the first."""
        kind = self._waiting[0]
        rehearse(kind, self._context.settings, self._context.settings.job_niceness if self._rehearsed else 0)
        self._rehearsed = True
        self._waiting.remove(kind)
        take_back(self._context, [kind])
        self.ready.append(kind)
        return kind
