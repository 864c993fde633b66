"""The runner that walks a system's stages: progress, cancellation, stored outputs, timings.

A pipeline calls `run.stage(name, function, *arguments)` for each stage. The stage's output is stored
under a key made of the engine's version, the stage's name and its arguments: files count by content,
earlier outputs by their own key, everything else by value. So a run that is started again takes up
where the last one stopped, and a corrected input redoes the stages that depend on it and no others.
"""

from __future__ import annotations

import os
import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, Literal, TypeVar, get_type_hints

from engine.errors import Canceled, InputError, Notice
from engine.media.limits import Limits
from engine.stage_keys import StageKeys
from engine.store import StageStore

T = TypeVar("T")

Turn = Literal["began", "ended", "broke"]
"""What becomes of a stage; it breaks off by an error, or because the run is canceled."""

CANCEL_POLL_SECONDS = 0.2
"""Seconds after which a wait for another core looks whether the run was canceled."""

MAX_UNFINISHED_FRACTION = 0.999
"""The largest fraction before a run is over: 1 is told once, when there is nothing left to do."""


@dataclass(frozen=True)
class Progress:
    """How far a run is: the stage's name, the fraction of the whole run done [0, 1], and a message."""

    stage: str
    fraction: float
    message: str = ""


class Run:
    """One run of a system. Used as a context manager, it is over when its last stage is, those that run beside included;
    then, and not before, its progress is 1. Outside of a `with` nothing runs beside: after an error it would go on.

    Parameters
    ----------
    store : where outputs of stages are kept for a later run; None keeps nothing.
    shared : where outputs of stages marked `shared` are kept (a driver's analysis serves many jobs).
    on_progress : called with each `Progress`.
    canceled : asked between stages and inside long loops; True ends the run with `Canceled`.
    on_stage : called with the name of each stage when it begins and when it ends or breaks off.
    on_artifact : called with the path of an artifact that is complete before the run is (a preview).
    erased : files that are not there any more, with the SHA-256 of what was in them: what stages found in them is in the store,
        or the run ends with an `InputError`, `source_erased`.
    limits : how large the inputs may be; whoever opens them hands these on to `engine.media`.
    mark_synthetic : whether what shows a person says of itself that it is synthetic (`engine.export.synthetic`): for
        whoever runs the program to choose, never a job.
    """

    def __init__(
        self,
        store: StageStore | None = None,
        shared: StageStore | None = None,
        on_progress: Callable[[Progress], object] | None = None,
        canceled: Callable[[], bool] | None = None,
        on_artifact: Callable[[Path], None] | None = None,
        limits: Limits | None = None,
        mark_synthetic: bool = True,
        on_stage: Callable[[str, Turn], None] | None = None,
        erased: Mapping[Path, str] | None = None,
    ):
        self._store = store
        self._shared = shared or store
        self._on_progress = on_progress or (lambda progress: None)
        self._canceled = canceled or (lambda: False)
        self._on_artifact = on_artifact or (lambda path: None)
        self._on_stage = on_stage or (lambda name, turn: None)
        self._erased = dict(erased or {})
        self.limits = limits or Limits()
        self.mark_synthetic = mark_synthetic
        self._keys = StageKeys(self._erased)
        self._weights: dict[str, float] = {}
        self._ended: Counter[str] = Counter()
        self._done = 0.0
        self._current = ""
        self._last_report = (0.0, "")
        self._furthest = 0.0
        self._broken = False
        self._entered = False
        self._here = _Here()
        self._others: set[Future[Any]] = set()
        self._at_work: set[ConcurrentStage[Any]] = set()
        self.seconds: dict[str, float] = {}
        self.reused: list[str] = []
        self.notices: list[Notice] = []

    def plan(self, weights: Mapping[str, float], times: Mapping[str, int] | None = None) -> None:
        """Announce the stages to come and their usual share of the time, for the progress fraction; `times` says how
        often a stage comes, where that is more than once. A run that learns this later plans anew, and goes on from where
        it is: a fraction never falls."""
        total = sum(weight * (times or {}).get(name, 1) for name, weight in weights.items())
        self._weights = {name: weight / total for name, weight in weights.items()}
        self._done = sum(
            self._weights.get(name, 0.0) * min(count, (times or {}).get(name, 1)) for name, count in self._ended.items()
        )

    def stage(
        self, name: str, function: Callable[..., T], *arguments: Any, shared: bool = False, stored: bool = True
    ) -> T:
        """Run one stage, or load what an earlier run found with the same arguments.

        A `stored` stage must be annotated with a return type that `engine.store` can write. Callables
        among the arguments (such as `run.tick`) do not count towards the key.
        """
        with self.timed(name):
            return self._output(
                name, function, arguments, (self._shared if shared else self._store) if stored else None
            )

    def beside(
        self, name: str, function: Callable[..., T], *arguments: Any, shared: bool = False
    ) -> ConcurrentStage[T]:
        """Begin a stage on another core while the next ones run; calling what is returned waits for its output.

        What it reports on the way and warns of is heard where it is waited for, and its time is that of the wait.
        Arguments may be stages that were begun so: this one then follows them. It ends early, at its next `tick`,
        where another stage breaks off: then nobody will ask for it.

        Raises `RuntimeError` where the run is not used as a context manager, or is over.
        """
        if not self._entered:
            raise RuntimeError(f"the stage {name} cannot run beside others outside of `with Run()`")
        one: ConcurrentStage[T] = ConcurrentStage(self, name)

        def work() -> T:
            ready = [other.output.result() if isinstance(other, ConcurrentStage) else other for other in arguments]
            self._here.beside = one
            self._at_work.add(one)
            try:
                return self._output(name, function, ready, self._shared if shared else self._store)
            finally:
                self._at_work.discard(one)

        pool = ThreadPoolExecutor(1, thread_name_prefix=name)
        one.output = pool.submit(work)
        self._others.add(one.output)
        one.output.add_done_callback(self._others.discard)
        pool.shutdown(wait=False)
        return one

    def idle_cores(self) -> int:
        """How many cores no stage beside this one is at work on; one at least, which is this one's own."""
        return max(1, (os.cpu_count() or 1) - len(self._at_work - {self._here.beside}))

    def __enter__(self) -> Run:
        self._entered = True
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Left when nothing works beside any more: after an error, when all have come to their next `tick`."""
        self._entered = False
        self._broken = self._broken or error is not None
        wait_for(tuple(self._others))
        if error is None:
            self._on_progress(Progress(self._current, 1.0))

    def _output(self, name: str, function: Callable[..., T], arguments: Sequence[Any], store: StageStore | None) -> T:
        """The output from the store, or made and stored together with the notices given while it was made."""
        heard = self._here.beside.notices if self._here.beside else self.notices
        before = len(heard)
        key = self.key(name, *arguments)
        kind = get_type_hints(function)["return"] if store is not None else None
        kept = store.load(key, kind) if store is not None else None
        if kept is not None:
            notices, output = kept
            heard.extend(notices)
            self.reused.append(name)
        else:
            self._require_there(arguments)
            output = function(*arguments)
            if store is not None:
                output = store.save(key, output, heard[before:], kind)
        self._keys.remember(output, key)
        return output

    @contextmanager
    def timed(self, name: str):  # type: ignore[no-untyped-def]
        """A stage whose work streams and is not stored: timed and reported like any other."""
        self.check()
        self._current = name
        self._report(0.0, "")
        self._on_stage(name, "began")
        started = time.perf_counter()
        turn: Turn = "broke"
        try:
            yield
            turn = "ended"
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - started
            self._broken = turn == "broke"
            self._on_stage(name, turn)
        self._ended[name] += 1
        self._done += self._weights.get(name, 0.0)
        self._current = name

    def tick(self, fraction: float, message: str = "") -> None:
        """Called inside long loops with the stage's own fraction [0, 1]: reports, and may raise `Canceled`."""
        self.check()
        if self._here.beside:
            self._here.beside.fraction = fraction
        else:
            self._report(fraction, message)

    def check(self) -> None:
        """Raise `Canceled` if the run was told to stop, and beside a stage that broke off."""
        if self._canceled() or (self._here.beside and self._broken):
            raise Canceled

    def warn(self, code: str, message: str) -> None:
        """Put a warning into the report, once."""
        heard = self._here.beside.notices if self._here.beside else self.notices
        notice = Notice(code, message)
        if notice not in heard:
            heard.append(notice)

    def publish(self, path: Path) -> None:
        """Say that an artifact is complete although the run goes on."""
        self._on_artifact(path)

    def key(self, name: str, *arguments: Any) -> str:
        """The key of a stage's output for these arguments (hex)."""
        return self._keys.key(name, *arguments)

    def _require_there(self, arguments: Sequence[Any]) -> None:
        """Refuse to work on what was erased."""
        if any(isinstance(one, Path) and one in self._erased for one in arguments):
            raise InputError(
                "source_erased",
                "This has to be made of the files that were sent, which were erased when the first job had succeeded: submit them anew.",
            )

    def _report(self, fraction: float, message: str) -> None:
        now = time.monotonic()
        if fraction > 0 and self._last_report[1] == self._current and now - self._last_report[0] < 0.1:
            return
        self._last_report = (now, self._current)
        share = self._weights.get(self._current, 0.0)
        self._furthest = max(self._furthest, min(self._done + share * fraction, MAX_UNFINISHED_FRACTION))
        self._on_progress(Progress(self._current, self._furthest, message))


class ConcurrentStage(Generic[T]):
    """A stage at work on another core; calling it waits for its `output`, unless the run is canceled."""

    output: Future[T]

    def __init__(self, run: Run, name: str):
        self.fraction = 0.0
        self.notices: list[Notice] = []
        self._run, self._name = run, name

    def __call__(self) -> T:
        with self._run.timed(self._name):
            while not wait_for([self.output], timeout=CANCEL_POLL_SECONDS).done:
                self._run.tick(self.fraction)
            for notice in self.notices:
                self._run.warn(notice.code, notice.message)
            return self.output.result()

    def once(self) -> T:
        """The output for its only user: it is not kept here any more."""
        output = self()
        del self.output
        return output


class _Here(threading.local):
    """The stage `beside` the others that this thread works on, if it does."""

    beside: ConcurrentStage[Any] | None = None
