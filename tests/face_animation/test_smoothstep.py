"""Smoothstep."""

from __future__ import annotations

import numpy as np

from engine.face_animation.smoothstep import smoothstep


def test_it_is_level_at_its_edges_and_half_in_the_middle() -> None:
    np.testing.assert_allclose(smoothstep([1.0, 2.0, 2.5, 3.0, 4.0], 2.0, 3.0), [0, 0, 0.5, 1, 1])
    assert smoothstep(2.001, 2.0, 3.0) < 1e-5 and smoothstep(2.999, 2.0, 3.0) > 1 - 1e-5


def test_edges_may_fall() -> None:
    np.testing.assert_allclose(smoothstep([0.0, 0.25, 1.0], 1.0, 0.0), 1 - smoothstep([0.0, 0.25, 1.0]))
