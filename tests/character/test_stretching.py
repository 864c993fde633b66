"""Which edges the benchmark of characters looks at."""

import numpy as np

from benchmarks.stretching import all_edges


def test_all_three_sides_of_each_triangle_are_there_once() -> None:
    square = np.array([[0, 1, 2], [0, 2, 3]])
    np.testing.assert_array_equal(all_edges(square), [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]])
