"""Depth from normals: known surfaces come back from their normals and their borders."""

from __future__ import annotations

import cv2
import numpy as np

from engine.geometry.normal_integration import integrate_normals


def border(mask: np.ndarray) -> np.ndarray:
    return mask & ~(cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)


def test_a_sphere_comes_back_from_its_normals() -> None:
    y, x = np.mgrid[-70:71, -80:81].astype(float)
    depth = np.sqrt(np.maximum(90**2 - x**2 - y**2, 0))
    mask = x**2 + y**2 < 60**2
    found = integrate_normals(np.stack([x, y, depth], -1), mask, border(mask), depth)
    assert np.abs(found - depth)[mask].max() < 0.01
    assert np.isnan(found[~mask]).all()


def test_a_plane_comes_back_exactly_from_one_held_pixel() -> None:
    y, x = np.mgrid[0:20, 0:30].astype(float)
    depth = 0.5 * x - 0.25 * y + 3
    normals = np.broadcast_to([-0.5, 0.25, 1.0], (20, 30, 3))
    held = np.zeros((20, 30), np.bool_)
    held[7, 9] = True
    found = integrate_normals(normals, np.ones((20, 30), np.bool_), held, depth)
    np.testing.assert_allclose(found, depth, atol=1e-5)


def test_what_is_held_keeps_its_depth() -> None:
    random = np.random.default_rng(0)
    mask = np.ones((15, 15), np.bool_)
    depth = random.normal(size=(15, 15))
    found = integrate_normals(np.broadcast_to([0.0, 0, 1], (15, 15, 3)), mask, border(mask), depth)
    np.testing.assert_allclose(found[border(mask)], depth[border(mask)], rtol=1e-6)
    inner = found[1:-1, 1:-1]
    around = found[:-2, 1:-1] + found[2:, 1:-1] + found[1:-1, :-2] + found[1:-1, 2:]
    np.testing.assert_allclose(inner, around / 4, atol=1e-5)  # a membrane: flat normals, the border's depth
