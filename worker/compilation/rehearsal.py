"""Compiling before the first job of a kind: it does its work once on media of the project's own.

Compiled functions are kept beside the modules that they are of. Jobs may use them but not leave any
(`worker.job_process.child`), so somebody who is trusted must have been there before. Once for each state of the engine
and each machine.

Unlike jobs it does not give way to all others (`worker.programs.niceness`): jobs wait for it, and on a machine that has
other work to do it would take as long as that lasts. It is one process; the API stays quick beside it. Once a kind was
rehearsed there may be jobs beside it, and it gives way as they do.

`python -m worker.compilation.rehearsal KIND PLACE...`
"""

from __future__ import annotations

import hashlib
import os
import pickle
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import structlog

import engine
from engine.kind import Kind
from service.catalogue.registry import load_kinds
from service.settings import Settings
from worker.programs.interpreter import module_command, module_environment
from worker.programs.niceness import lower_priority
from worker.programs.parent_death import tied_command

REHEARSAL_MARK = "rehearsed"
COMPILED_FORGOTTEN_SECONDS = 90 * 24 * 3600.0
"""Seconds after which what was compiled is thrown away; compiled again it is there again."""


def unrehearsed(kinds: Mapping[str, Kind]) -> list[str]:
    """The names of those of these kinds that are yet to be rehearsed, in their order."""
    state = _state()
    return [name for name, kind in kinds.items() if kind.rehearse is not None and not _mark(name, state).exists()]


def rehearse(kind: str, settings: Settings, niceness: int = 0) -> None:
    """Have it done for one kind. Where it fails, its jobs compile for themselves, each anew."""
    log = structlog.get_logger().bind(kind=kind)
    log.info("rehearsal_began", why="the engine is compiled once, which takes a few minutes")
    with subprocess.Popen(  # noqa: S603  (our own program)
        tied_command(module_command("worker.compilation.rehearsal", kind, *settings.kinds)),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        env=module_environment(),
        start_new_session=True,
    ) as process:
        try:
            if niceness:
                lower_priority(process.pid, niceness)
            _, printed = process.communicate()
        except BaseException:  # the worker is told to end
            process.kill()
            raise
    if process.returncode != 0:
        log.warning("rehearsal_failed", printed=printed.decode(errors="replace")[-2000:])
    log.info("rehearsal_ended")


def load_compiled(kinds: Iterable[str]) -> None:
    """Load what was compiled then, and ready the compiler, so that the jobs that are forked from this process find both."""
    state = _state()
    for mark in (_mark(kind, state) for kind in kinds):
        if not mark.exists():
            continue
        for module, name, signatures in pickle.loads(mark.read_bytes()):  # noqa: S301  (ours, as the functions' own files)
            if module in sys.modules:
                for signature in signatures:
                    getattr(sys.modules[module], name).compile(signature)
    if "numba" in sys.modules:
        from numba.core.registry import cpu_target

        cpu_target.target_context.refresh()


def _mark(kind: str, state: str) -> Path:
    """The file that says that it was done for a kind and this state of the engine on this machine."""
    return _folder(Path(engine.__file__).parent) / f"{REHEARSAL_MARK}-{kind}-{state}"


def _state() -> str:
    """What tells this state of the engine on this machine from others."""
    state = hashlib.sha256(f"{version('numba')} {platform.python_version()} {_processor()}".encode())
    for path in sorted(Path(engine.__file__).parent.rglob("*.py")):
        state.update(f"{path} {path.stat().st_mtime_ns}".encode())
    return state.hexdigest()[:16]


def _folder(package: Path) -> Path:
    """Where the record of the rehearsal lies: beside what was compiled, so that both come and go together."""
    if kept := os.environ.get("NUMBA_CACHE_DIR"):
        return Path(kept)
    beside = package / "__pycache__"
    return beside if os.access(beside, os.W_OK) else Path.home() / ".cache" / "galatea"


def _processor() -> str:
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    return next((line for line in lines if line.startswith("model name")), platform.machine())


def main() -> None:
    kind = load_kinds(sys.argv[2:])[sys.argv[1]]
    assert kind.rehearse is not None
    with tempfile.TemporaryDirectory(prefix="galatea-") as folder:
        kind.rehearse(Path(folder))
    mark = _mark(kind.name, _state())
    mark.parent.mkdir(parents=True, exist_ok=True)
    draft = mark.with_suffix(f".{os.getpid()}")
    draft.write_bytes(pickle.dumps(_compiled()))
    draft.rename(mark)
    for other in mark.parent.glob(f"{REHEARSAL_MARK}-*"):  # of an engine that is no more
        if other.stat().st_mtime < time.time() - COMPILED_FORGOTTEN_SECONDS:
            other.unlink(missing_ok=True)


def compiled_folders() -> set[Path]:
    """The folders under which lies what was compiled of the engine's loaded modules: jobs read it when they use it."""
    return {Path(function._cache.cache_path).parent for _, _, function in _functions()}


def _compiled() -> list[tuple[str, str, list[Any]]]:
    """The functions that were compiled, by module and name, with the types of their arguments. Those that run on
    several threads are left out: loading them starts the threads, and a process with threads must not fork."""
    return [
        (module, name, list(function.signatures))
        for module, name, function in _functions()
        if not function.targetoptions.get("parallel")
    ]


def _functions() -> Iterator[tuple[str, str, Any]]:
    """The functions of the engine's loaded modules that are compiled at their first use, by module and name."""
    if "numba" not in sys.modules:
        return
    from numba.core.dispatcher import Dispatcher

    for module, loaded in list(sys.modules.items()):
        if module.startswith("engine."):
            for name, value in vars(loaded).items():
                if isinstance(value, Dispatcher) and value.py_func.__module__ == module:
                    yield module, name, value


if __name__ == "__main__":
    main()
