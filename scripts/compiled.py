"""Have the engine compiled, where it is not yet: what a worker does before its first job, done before the tests begin."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

from service.catalogue.registry import load_kinds
from service.settings import Settings
from worker.compilation.rehearsal import rehearse, unrehearsed


def main() -> None:
    settings = Settings(kinds=["engine.kinds:KINDS"])
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        # the later kinds take longer: begun last, one would be alone in the end
        kinds = unrehearsed(load_kinds(settings.kinds))[::-1]
        list(pool.map(lambda kind: rehearse(kind, settings), kinds))


if __name__ == "__main__":
    main()
