"""Landlock: the kernel lets a thread reach no files but those under named folders (Linux 5.13 and later, ctypes).

Source: the kernel's userspace API, `linux/landlock.h`. What a thread starts later inherits its rules; what runs
already does not, so this must come before a second thread.
"""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
ASK_VERSION = 1
PATH_BENEATH = 1

EXECUTE, WRITE_FILE, READ_FILE, READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
TRUNCATE, IOCTL_DEV = 1 << 14, 1 << 15
REMOVE_AND_MAKE_PLAIN = 1 << 4 | 1 << 5 | 1 << 7 | 1 << 8
"""Remove folders and files, make folders and plain files; links, pipes, sockets and devices are never granted."""
REFER = 1 << 13
RIGHTS_SINCE = {1: (1 << 13) - 1, 2: REFER, 3: TRUNCATE, 5: IOCTL_DEV}
TCP_SINCE, TCP = 4, 0b11
SCOPES_SINCE, SCOPE_RULES = 6, 0b11
"""Abstract sockets and signals of processes outside."""

READ = READ_FILE | READ_DIR
CHANGE = READ | WRITE_FILE | TRUNCATE | REFER | REMOVE_AND_MAKE_PLAIN
OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV


class _Ruleset(ctypes.Structure):
    _fields_ = (("fs", ctypes.c_uint64), ("net", ctypes.c_uint64), ("scoped", ctypes.c_uint64))


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32))


def version() -> int:
    """The version of Landlock that the kernel offers; 0 where it has none, or has it switched off."""
    return max(_libc().syscall(CREATE_RULESET, None, ctypes.c_size_t(0), ASK_VERSION), 0)


def restrict(readable: Iterable[Path], changeable: Iterable[Path]) -> None:
    """Let this thread read nothing but what lies at or under `readable`, and change nothing but what lies under
    `changeable`. Needs `no_new_privs`. What is not there is passed over. Raises OSError."""
    offered = version()
    handled = sum(rights for since, rights in RIGHTS_SINCE.items() if since <= offered)
    rules = _Ruleset(handled, TCP if offered >= TCP_SINCE else 0, SCOPE_RULES if offered >= SCOPES_SINCE else 0)
    size = 24 if offered >= SCOPES_SINCE else 16 if offered >= TCP_SINCE else 8
    ruleset = _checked(_libc().syscall(CREATE_RULESET, ctypes.byref(rules), ctypes.c_size_t(size), 0))
    try:
        for paths, rights in ((readable, READ), (changeable, CHANGE)):
            for path in paths:
                with suppress(FileNotFoundError):
                    _allow(ruleset, path, rights & handled)
        _checked(_libc().syscall(RESTRICT_SELF, ruleset, 0))
    finally:
        os.close(ruleset)


def _allow(ruleset: int, path: Path, rights: int) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
            rights &= OF_FILES
        beneath = _PathBeneath(rights, descriptor)
        _checked(_libc().syscall(ADD_RULE, ruleset, PATH_BENEATH, ctypes.byref(beneath), 0))
    finally:
        os.close(descriptor)


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _checked(result: int) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"Landlock: {os.strerror(number)}")
    return result
