"""Arrays of a short command take the place of those that are gone."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

PAGES = """
import resource, sys
import numpy as np
from shell.allocation import keep_memory
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


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library keeps memory in its own way")
def test_memory_is_asked_for_once() -> None:
    """Twenty arrays of 16 MB, one after another, are 4000 pages each; by default each is given back."""

    def pages(how: str) -> int:
        return int(subprocess.run([sys.executable, "-c", PAGES, how], capture_output=True, check=True).stdout)

    assert pages("kept") < pages("returned") / 10
