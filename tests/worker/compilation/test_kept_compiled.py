"""What was compiled elsewhere than beside the program: a job's process may read it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HEAP = """
import numpy as np
from engine.geometry.simplification.heap import sift_up

def heap():
    keys, items = np.array([1.0, 2.0, 0.0]), np.arange(3)
    sift_up(keys, items, 2)
    return items.tolist()
"""

CONFINED = """
import os
from worker.sandbox.confinement import Limits, confine, limit, program_paths
from worker.compilation.rehearsal import compiled_folders

limits = Limits(memory_bytes=4 << 30, file_bytes=1 << 30, cpu_seconds=60, user=None)
limit(limits)
confine(os.getppid(), limits, [*program_paths(), *compiled_folders()], [])
print(heap(), sum(sift_up.stats.cache_hits.values()))
"""


def test_a_confined_process_uses_what_was_compiled_before_it(tmp_path: Path) -> None:
    kept = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    compiled = subprocess.run([sys.executable, "-c", HEAP + "print(heap())"], env=kept, capture_output=True, text=True)
    assert compiled.stdout.strip() == "[2, 1, 0]", compiled.stderr  # the smallest key goes to the top
    loaded = subprocess.run([sys.executable, "-c", HEAP + CONFINED], env=kept, capture_output=True, text=True)
    assert loaded.stdout.strip() == "[2, 1, 0] 1", loaded.stderr
