"""How a job's process died, by a short name (`SIGABRT`, `exit 3`) that is the same when it dies so again, and in words."""

from __future__ import annotations

import os
from signal import Signals

EXTERNAL_SIGNALS = ("SIGKILL", "SIGTERM", "SIGINT", "SIGHUP")
"""What others do to a process, the kernel that runs out of memory among them: it says nothing about the input."""

SIGNAL_REASONS = {
    "SIGABRT": "a library gave up on its input: something that it takes for granted was not so (SIGABRT)",
    "SIGSEGV": "a library reached for memory that is not there (SIGSEGV)",
    "SIGBUS": "a library reached for memory that could not be read (SIGBUS)",
    "SIGFPE": "a library divided a whole number by zero (SIGFPE)",
    "SIGILL": "a library used an instruction that this processor does not know (SIGILL)",
    "SIGKILL": "the job's process was killed (SIGKILL), as where the machine runs out of memory",
}


def death_name(status: int) -> str | None:
    """The name of the death that `os.wait` tells of; None for an orderly end."""
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        try:
            return Signals(number).name
        except ValueError:  # a real-time signal
            return f"signal {number}"
    code = os.waitstatus_to_exitcode(status)
    return f"exit {code}" if code else None


def death_in_words(death: str | None) -> str:
    """What happened, as the rest of a sentence that may begin with "The last time: "."""
    if death is None:
        return "the job's process ended unexpectedly"
    if death.startswith("exit "):
        return f"a library ended the job's process (status {death.removeprefix('exit ')})"
    return SIGNAL_REASONS.get(death, f"the job's process was ended by {death}")


def own_death(death: str | None) -> str | None:
    """The death if the process brought it about itself, None if it may have come from outside."""
    return None if death in EXTERNAL_SIGNALS else death
