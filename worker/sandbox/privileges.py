"""What a process may do because of who it is: given up before a stranger's file is opened (Linux, ctypes)."""

from __future__ import annotations

import ctypes
import os
import pwd
import struct
from contextlib import suppress

PR_SET_KEEPCAPS, PR_SET_SECUREBITS, PR_SET_NO_NEW_PRIVS = 8, 28, 38
NO_SETUID_FIXUP = 1 << 2
CAPABILITY_VERSION_3 = 0x20080522
CAP_DAC_READ_SEARCH = 2


class UnknownUser(Exception):
    """There is no user of that name."""


def user_id(user: str) -> int | None:
    """The number of the user that jobs work as. It is None where they stay who the worker is: that is not root, or
    `user` is empty. Raises `UnknownUser`."""
    if os.geteuid() != 0 or not user:
        return None
    if user.isdecimal():
        return int(user)
    try:
        return pwd.getpwnam(user).pw_uid
    except KeyError:
        raise UnknownUser(f"there is no user “{user}”") from None


def no_new_privileges() -> None:
    """Nothing that this process starts can be more than it is. Raises OSError."""
    _prctl(PR_SET_NO_NEW_PRIVS, 1)


def become_user(user: int, may_read_all: bool) -> None:
    """Become another user, for good, without groups and capabilities. Raises OSError where root may not even do that.

    With `may_read_all` one capability is kept: to read and search whatever lies there. It is for processes whose
    reading is restricted by Landlock: the program itself may lie where only root looks.
    """
    with suppress(OSError):  # access(2) would else answer as if the capability that is kept were not there
        _prctl(PR_SET_SECUREBITS, NO_SETUID_FIXUP)
    _prctl(PR_SET_KEEPCAPS, 1)
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    keep_capabilities(1 << CAP_DAC_READ_SEARCH if may_read_all else 0)


def keep_capabilities(kept: int) -> None:
    """Give up all capabilities but these (a bit for each), for good. Raises OSError."""
    header = struct.pack("Ii", CAPABILITY_VERSION_3, 0)
    data = struct.pack("IIIIII", kept, kept, 0, 0, 0, 0)
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.capset(ctypes.c_char_p(header), ctypes.c_char_p(data)) != 0:
        raise OSError(ctypes.get_errno(), "capset failed")


def _prctl(option: int, value: int) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(option, value, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), f"prctl({option}) failed")
