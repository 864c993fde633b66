"""What a job's process may do: its limits, the files it sees, the calls it may make, and who it is.

Each layer is put on where the system has it; `galatea doctor` says which ones it has. Run as a script, it confines
itself as a job would be and prints what is then refused, as JSON.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import site
import socket
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from worker.programs.parent_death import die_with_parent
from worker.sandbox import landlock, privileges, seccomp

MAX_OPEN_FILES = 1024
CPU_GRACE_SECONDS = 5
"""Seconds between the signal that says that the time is used up and the one that cannot be ignored."""

OF_THE_SYSTEM = (
    *("/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/etc/localtime", "/etc/fonts", "/sys/devices/system/cpu"),
    *("/sys/devices/system/node", "/proc/self", "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/proc/sys/vm"),
)
ALLOWED_DEVICES = ("/dev/null", "/dev/zero", "/dev/urandom", "/dev/random")


@dataclass(frozen=True)
class Limits:
    """Bounds of a job's process: bytes of memory, bytes of one file, seconds of computing (all cores together), the
    user that it works as (None: who the worker is)."""

    memory_bytes: int
    file_bytes: int
    cpu_seconds: int
    user: int | None


def limit(limits: Limits) -> None:
    """Set the limits that also hold for what this process starts; the first to go when the machine itself runs out of
    memory."""
    resource.setrlimit(resource.RLIMIT_DATA, (limits.memory_bytes, limits.memory_bytes))
    resource.setrlimit(resource.RLIMIT_FSIZE, (limits.file_bytes, limits.file_bytes))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    most = min(MAX_OPEN_FILES, resource.getrlimit(resource.RLIMIT_NOFILE)[1])
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    privileges.no_new_privileges()
    Path("/proc/self/oom_score_adj").write_text("1000")


def confine(parent: int, limits: Limits, readable: Iterable[Path], changeable: Iterable[Path]) -> None:
    """Give up, for good and while this process has one thread, all that a job does not need. It ends with `parent`."""
    resource.setrlimit(resource.RLIMIT_DATA, (limits.memory_bytes, limits.memory_bytes))
    resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_seconds, limits.cpu_seconds + CPU_GRACE_SECONDS))
    files_kept = landlock.version() > 0
    if files_kept:
        system = [Path(path) for path in OF_THE_SYSTEM]
        landlock.restrict([*system, *readable], [*map(Path, ALLOWED_DEVICES), *changeable])
    if os.geteuid() == 0:
        _step_down(limits.user if files_kept else None)
    die_with_parent(parent)  # a change of user would undo it
    if seccomp.available():
        seccomp.install_filter()


def keep_to_cores(cores: int) -> None:
    """Keep to so many of the cores that this process may use, by its number to others than its neighbour; 0 is all."""
    there = sorted(os.sched_getaffinity(0))
    if 0 < cores < len(there):
        os.sched_setaffinity(0, {there[(os.getpid() + i) % len(there)] for i in range(cores)})


def _step_down(user: int | None) -> None:
    try:
        if user is not None:
            privileges.become_user(user, may_read_all=True)
        else:
            privileges.keep_capabilities(0)
    except PermissionError:
        privileges.keep_capabilities(0)  # root of a container that may not change who it is


def program_paths() -> list[Path]:
    """The folders and files that the program itself is read from: the interpreter, its packages, and the packages of
    every module that is loaded. Never a whole folder of the module path: the data may lie in it."""
    paths = sysconfig.get_paths()
    roots = {Path(paths[name]) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    roots |= {Path(folder) for folder in site.getsitepackages()}
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if not file or any(Path(file).is_relative_to(root) for root in roots):
            continue
        top = sys.modules.get(name.partition(".")[0])
        top_file = Path(getattr(top, "__file__", None) or file)
        roots.add(top_file.parent if top_file.name == "__init__.py" else top_file)
    return sorted(roots)


def _probe(user: int | None) -> dict[str, bool]:
    """Whether each of these is refused to a process that is confined, and works as `user`."""
    limits = Limits(memory_bytes=4 << 30, file_bytes=1 << 30, cpu_seconds=60, user=user)
    with tempfile.TemporaryDirectory() as folder:
        read_end, write_end = os.pipe()
        parent = os.getpid()
        if (child := os.fork()) == 0:
            limit(limits)
            confine(parent, limits, program_paths(), [Path(folder)])
            found = {
                "network": _refused(lambda: socket.create_server(("127.0.0.1", 0)).close()),
                "files": _refused(lambda: Path("/etc/passwd").read_bytes()),
                "processes": _refused(lambda: os.execv("/bin/true", ["true"])),  # noqa: S606
                "signals": _refused(lambda: os.kill(parent, 0)),
                "root": os.geteuid() != 0,
            }
            os.write(write_end, json.dumps(found).encode())
            os._exit(0)
        os.close(write_end)
        with os.fdopen(read_end, "rb") as told:
            said = told.read()
        os.waitpid(child, 0)
    return json.loads(said)


def _refused(action: Callable[[], object]) -> bool:
    try:
        action()
    except PermissionError:
        return True
    except OSError:
        return False
    return False


if __name__ == "__main__":
    signal.alarm(30)
    print(json.dumps(_probe(privileges.user_id(sys.argv[1] if len(sys.argv) > 1 else "nobody"))))
