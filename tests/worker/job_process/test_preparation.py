"""What kinds do in the process that jobs are forked from, before any is."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
from engine.kinds import KINDS
for kind in KINDS.values():
    if kind.prepare is not None:
        kind.prepare()
import numba.np.ufunc.parallel as threads
print(threads._is_initialized)
"""


def test_no_kind_starts_threads_of_compiled_loops_as_it_is_prepared() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n", "the first such loop of a forked job would end it"
