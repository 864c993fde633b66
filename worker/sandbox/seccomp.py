"""seccomp: the kernel refuses this process the system calls that no job needs (Linux on x86-64, ctypes).

There are no sockets of any family, so no network and no way to the embedded Redis. There are no new processes and
programs, no signals to others and no look into others' memory. Nobody changes whose file something is. Threads, files
and memory are as always.

Source: the kernel's `linux/seccomp.h`, `linux/filter.h` and its table of system calls.
"""

from __future__ import annotations

import ctypes
import os
import platform
import struct
from collections.abc import Sequence
from errno import ENOSYS, EPERM

PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 22, 2
AUDIT_ARCH_X86_64 = 0xC000003E
X32 = 0x40000000
"""Set in the numbers of the calls of a second, forgotten binary interface."""

KILL, ERRNO, ALLOW = 0x80000000, 0x00050000, 0x7FFF0000
LOAD, IF_EQUAL, IF_AT_LEAST, IF_ANY_BIT, RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
NUMBER, ARCHITECTURE, FIRST_ARGUMENT = 0, 4, 16
CLONE_THREAD = 0x10000

REFUSED_CALLS = {
    "socket": 41,
    "fork": 57, "vfork": 58, "execve": 59, "execveat": 322,
    "ptrace": 101, "process_vm_readv": 310, "process_vm_writev": 311, "pidfd_open": 434, "pidfd_getfd": 438,
    "pidfd_send_signal": 424, "tkill": 200, "rt_sigqueueinfo": 129, "rt_tgsigqueueinfo": 297,
    "setsid": 112, "setpgid": 109, "setns": 308, "unshare": 272, "mount": 165, "umount2": 166, "pivot_root": 155,
    "chroot": 161, "move_mount": 429, "open_tree": 428, "fsopen": 430, "open_by_handle_at": 304,
    "chmod": 90, "fchmod": 91, "fchmodat": 268, "fchmodat2": 452, "chown": 92, "fchown": 93, "lchown": 94,
    "fchownat": 260, "setxattr": 188, "lsetxattr": 189, "removexattr": 197, "lremovexattr": 198, "setxattrat": 463,
    "io_uring_setup": 425, "io_uring_enter": 426, "io_uring_register": 427,
    "bpf": 321, "perf_event_open": 298, "userfaultfd": 323, "add_key": 248, "request_key": 249, "keyctl": 250,
}  # fmt: skip
"""Calls that end with EPERM. io_uring is among them because it makes sockets too."""

ON_ITSELF = {"kill": 62, "tgkill": 234, "prlimit64": 302}
"""Calls whose first argument must be this process (or 0)."""

CLONE, CLONE3 = 56, 435


def available() -> bool:
    """Whether the filter fits this machine and the kernel takes filters."""
    return platform.machine() == "x86_64" and ctypes.CDLL(None).prctl(21, 0, 0, 0, 0) >= 0  # PR_GET_SECCOMP


def install_filter() -> None:
    """Refuse these calls to this thread, and to those that it starts, for good. Needs `no_new_privs`. Raises
    OSError."""
    program = b"".join(_program(os.getpid()))
    buffer = ctypes.create_string_buffer(program, len(program))
    header = struct.pack("HxxxxxxP", len(program) // 8, ctypes.addressof(buffer))
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.c_char_p(header), 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "seccomp: the filter is refused")


def _program(process: int) -> Sequence[bytes]:
    def refused_if(number: int, error: int = EPERM) -> list[bytes]:
        return [_step(IF_EQUAL, number, 0, 1), _step(RETURN, ERRNO | error)]

    steps = [
        _step(LOAD, ARCHITECTURE),
        _step(IF_EQUAL, AUDIT_ARCH_X86_64, 1, 0),
        _step(RETURN, KILL),
        _step(LOAD, NUMBER),
        _step(IF_AT_LEAST, X32, 0, 1),
        _step(RETURN, ERRNO | EPERM),
    ]
    for number in REFUSED_CALLS.values():
        steps += refused_if(number)
    steps += refused_if(CLONE3, ENOSYS)  # its flags lie in memory; the C library then takes the older call
    steps += [
        _step(IF_EQUAL, CLONE, 0, 4),
        _step(LOAD, FIRST_ARGUMENT),
        _step(IF_ANY_BIT, CLONE_THREAD, 0, 1),
        _step(RETURN, ALLOW),
        _step(RETURN, ERRNO | EPERM),
    ]
    for number in ON_ITSELF.values():
        steps += [
            _step(IF_EQUAL, number, 0, 5),
            _step(LOAD, FIRST_ARGUMENT),
            _step(IF_EQUAL, process, 2, 0),
            _step(IF_EQUAL, 0, 1 if number == ON_ITSELF["prlimit64"] else 0, 0),
            _step(RETURN, ERRNO | EPERM),
            _step(RETURN, ALLOW),
        ]
    return [*steps, _step(RETURN, ALLOW)]


def _step(code: int, value: int, true: int = 0, false: int = 0) -> bytes:
    return struct.pack("HBBI", code, true, false, value)
