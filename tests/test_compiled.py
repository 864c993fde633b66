"""Compiled loops in processes of their own: made once, loaded lightly, and compiled for other types beside that."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

LOOP = """
from engine.compiled import njit

@njit(nogil=True)
def total(values):
    sum_ = values[0] * 0
    for value in values:
        sum_ += value
    return sum_
"""

USE = """
import sys
import numpy as np
from loop import total

print(float(total(np.arange(10, dtype=np.float32))), dict(total.stats.cache_hits) != {}, "numba.np.arraymath" in sys.modules)
"""

OTHERWISE = USE + "print(int(total(np.arange(10, dtype=np.int64))), float(total(np.ones(3, np.float32))))\n"


@pytest.fixture
def run(tmp_path: Path):
    (tmp_path / "loop.py").write_text(LOOP)
    known = {"NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}

    def run(code: str) -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", code], env=os.environ | known, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.split()

    return run


def test_what_was_compiled_is_loaded_without_the_compiler(run) -> None:
    assert run(USE) == ["45.0", "False", "True"]  # compiled
    assert run(USE) == ["45.0", "True", "False"]  # loaded


def test_a_process_that_loaded_one_still_compiles_for_other_types(run) -> None:
    run(USE)
    assert run(OTHERWISE) == ["45.0", "True", "False", "45", "3.0"]
    assert run(OTHERWISE) == ["45.0", "True", "False", "45", "3.0"]


def test_what_numba_has_no_use_for_is_not_loaded_and_can_be_afterwards(run) -> None:
    assert run("import sys, engine.compiled; print('coverage' in sys.modules or 'yaml' in sys.modules)") == ["False"]
    assert run("import engine.compiled, yaml; print(yaml.safe_load('1'))") == ["1"]


CALLED = """
from engine.compiled import njit

RATE = {rate}

@njit()
def scaled(value):
    return value * RATE
"""

CALLING = """
from called import OFFSET, scaled
from engine.compiled import njit

@njit()
def both(value):
    return inner(value) + OFFSET

@njit()
def inner(value):
    return scaled(value)
"""

CALL = "from calling import both; print(both(10), dict(both.stats.cache_hits) != {})"


def test_what_it_calls_and_what_it_holds_count_too(run, tmp_path: Path) -> None:
    (tmp_path / "calling.py").write_text(CALLING)
    (tmp_path / "called.py").write_text(CALLED.format(rate=2) + "OFFSET = 1\n")
    assert run(CALL) == ["21", "False"]
    assert run(CALL) == ["21", "True"]
    (tmp_path / "called.py").write_text(CALLED.format(rate=3) + "OFFSET = 1\n")
    assert run(CALL) == ["31", "False"], "the file of `both` is as it was"
    (tmp_path / "called.py").write_text(CALLED.format(rate=3) + "OFFSET = 5\n")
    assert run(CALL) == ["35", "False"]
    assert run(CALL) == ["35", "True"]
