"""Have the engine compiled, where it is not yet: what a worker does before its first job, done before the tests begin. Ends with
an error where it could not be done."""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor

from service.catalogue.registry import load_kinds
from service.settings import Settings
from worker.compilation.rehearsal import rehearse, unrehearsed


def main() -> None:
    settings = Settings(kinds=["engine.kinds:KINDS"])
    offered = load_kinds(settings.kinds)
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        # the later kinds take longer: begun last, one would be alone in the end
        kinds = unrehearsed(offered)[::-1]
        list(pool.map(lambda kind: rehearse(kind, settings), kinds))
    if failed := unrehearsed(offered):
        sys.exit(f"not compiled, by what the log says: {', '.join(failed)}")


if __name__ == "__main__":
    main()
