"""What a job of a kind may take: what the kind says that it needs, as far as the operator's settings allow it."""

from __future__ import annotations

from dataclasses import dataclass

from engine.kind import Kind
from service.settings import Settings


@dataclass(frozen=True)
class Allowance:
    """The most that a job may take: seconds of work, millions of bytes of memory, cores (0: all that the worker has).

    `kind` is the name of the kind where the seconds are of its own, None where they are the setting's.
    """

    seconds: float
    memory_mb: float
    cores: int
    kind: str | None

    @classmethod
    def of(cls, kind: Kind, settings: Settings) -> Allowance:
        needs = kind.needs
        seconds = min(needs.seconds or settings.job_seconds, settings.job_seconds)
        memory_mb = min(needs.memory_mb or settings.job_memory_mb, settings.job_memory_mb)
        cores = min(filter(None, (needs.cores, settings.job_cores)), default=0)
        return cls(seconds, memory_mb, cores, kind.name if seconds < settings.job_seconds else None)

    def too_long(self) -> str:
        """What is said to whose job takes longer."""
        whose = f"a job of the kind “{self.kind}” may" if self.kind else "a job may here (GALATEA_JOB_SECONDS)"
        return (
            f"The job worked for {self.seconds:g} seconds without an end, the most that {whose}: send a shorter input."
        )
