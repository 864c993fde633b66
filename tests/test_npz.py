"""Npz files read by several threads at once."""

import gc
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from engine.npz import read_npz


@pytest.fixture
def collections_change_threads():
    """While it lasts, each collection of garbage lets another thread go on, in the middle of whatever is done."""

    def give_way(*_: object) -> None:
        time.sleep(0)

    gc.callbacks.append(give_way)
    yield
    gc.callbacks.remove(give_way)


def test_threads_that_read_at_once_each_find_every_array(tmp_path: Path, collections_change_threads: None) -> None:
    arrays = {f"a{i}": np.full((i, 3), i, np.int16) for i in range(40)}
    np.savez(tmp_path / "arrays.npz", **arrays)
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(read_npz, [tmp_path / "arrays.npz"] * 200))
    for one in found:
        assert one.keys() == arrays.keys()
        assert all(np.array_equal(one[name], arrays[name]) for name in arrays)
