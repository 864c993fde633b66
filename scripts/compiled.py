"""Have the engine compiled, where it is not yet: what a worker does before its first job, done before the tests begin."""

from __future__ import annotations

from service.settings import Settings
from worker.compilation.rehearsal import is_rehearsed, rehearse


def main() -> None:
    settings = Settings(kinds=["engine.kinds:KINDS"])
    if not is_rehearsed(settings):
        rehearse(settings)


if __name__ == "__main__":
    main()
