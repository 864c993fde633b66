"""What was compiled elsewhere than beside the program: a job's process may read it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

WARP = """
import numpy as np
from engine.geometry import mean_value_coordinates as module

def warp():
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], np.float64)
    return module._warp(np.array([[1.0, 1.0]]), square, square)[0].tolist()
"""

CONFINED = """
import os
from worker.confinement import Limits, confine, limit, of_the_program
from worker.rehearsal import kept_in

limits = Limits(memory_bytes=4 << 30, file_bytes=1 << 30, cpu_seconds=60, user=None)
limit(limits)
confine(os.getppid(), limits, [*of_the_program(), *kept_in()], [])
print(warp(), sum(module._warp.stats.cache_hits.values()))
"""


def test_a_confined_process_uses_what_was_compiled_before_it(tmp_path: Path) -> None:
    kept = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    compiled = subprocess.run([sys.executable, "-c", WARP + "print(warp())"], env=kept, capture_output=True, text=True)
    assert compiled.stdout.strip() == "[1.0, 1.0]", compiled.stderr  # the middle of a square stays its middle
    loaded = subprocess.run([sys.executable, "-c", WARP + CONFINED], env=kept, capture_output=True, text=True)
    assert loaded.stdout.strip() == "[1.0, 1.0] 1", loaded.stderr
