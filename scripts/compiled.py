"""Have the engine compiled, where it is not yet: what a worker does before its first job, done before the tests begin."""

from __future__ import annotations

from service.catalogue.registry import load_kinds
from service.settings import Settings
from worker.compilation.rehearsal import rehearse, unrehearsed


def main() -> None:
    settings = Settings(kinds=["engine.kinds:KINDS"])
    for kind in unrehearsed(load_kinds(settings.kinds)):
        rehearse(kind, settings)


if __name__ == "__main__":
    main()
