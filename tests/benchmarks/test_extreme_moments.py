"""Which moments of a driver a sheet shows."""

from __future__ import annotations

import numpy as np

from benchmarks.persona_figures.beside_plain import extreme_moments


def test_moments_are_those_farthest_apart_in_their_order() -> None:
    mouth = [0.0, 0.1, 5.0, 0.2, 0.1, 0.0, -3.0, 0.1]
    assert extreme_moments([np.array([one]) for one in mouth], 2) == [2, 6]


def test_each_next_moment_is_unlike_all_before() -> None:
    shown = [(0.0, 0.0), (4.0, 0.0), (4.0, 0.1), (0.0, 4.0), (0.1, 4.0)]
    found = extreme_moments([np.array(one) for one in shown], 3)
    assert len({(round(shown[one][0]), round(shown[one][1])) for one in found}) == 3


def test_frames_without_a_face_are_no_moments() -> None:
    assert extreme_moments([None, np.array([1.0]), None, np.array([2.0])], 6) == [1, 3]
