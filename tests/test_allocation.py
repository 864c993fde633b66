"""Arrays of a short command take the place of those that are gone; what runs for long gives them back."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

PAGES = """
import resource, sys
import numpy as np
from engine.allocation import keep_memory
if sys.argv[1] == "kept":
    keep_memory()
def taken():
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt
np.ones(2_000_000)
before = taken()
for _ in range(20):
    np.ones(2_000_000)
print(taken() - before)
"""

HELD = """
import re
import numpy as np
from pathlib import Path
from engine.allocation import give_back_memory
def resident():
    return int(re.search(r"VmRSS:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) * 1024
many = [np.ones(2000) for _ in range(10_000)]
last = np.ones(2000)
full = resident()
del many
before = resident()
give_back_memory()
print(full - before, full - resident())
"""
glibc = pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library keeps memory in its own way")


@glibc
def test_what_a_last_small_array_holds_back_is_given_back() -> None:
    """Ten thousand arrays of 16 kB, and one above them that stays."""
    done = subprocess.run([sys.executable, "-c", HELD], capture_output=True, text=True, check=True)
    by_itself, given_back = map(int, done.stdout.split())
    assert by_itself < 20e6 and given_back > 140e6


@glibc
def test_memory_is_asked_for_once() -> None:
    """Twenty arrays of 16 MB, one after another, are 4000 pages each; by default each is given back."""

    def pages(how: str) -> int:
        return int(subprocess.run([sys.executable, "-c", PAGES, how], capture_output=True, check=True).stdout)

    assert pages("kept") < pages("returned") / 10
