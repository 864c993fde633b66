"""A sphere with a pattern on it, seen by cameras on a circle: pictures, silhouettes and depths that are known exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera

RADIUS = 0.3
"""Metres; the sphere's centre is (0, 1, 0)."""
CENTRE = np.array([0.0, 1.0, 0.0])
SIZE = 120, 120


def ring(count: int, height: float = 0.3, first: float = 0.0) -> list[Camera]:
    """Cameras 2 m from the axis that look at the centre, from `height` metres above it."""
    lens = Camera((0.0, 0.0, 0.0), 280.0, (59.5, 59.5), SIZE)
    angles = first + np.arange(count) * 2 * np.pi / count
    return [lens.aimed([2 * np.sin(a), 1 + height, 2 * np.cos(a)], CENTRE) for a in angles]


def seen_depth(camera: Camera) -> NDArray[np.float64]:
    """(H, W) metres along the view axis to the sphere, 0 beside it."""
    y, x = np.indices(camera.size)
    rays = camera.rays(np.stack([x, y], -1).reshape(-1, 2).astype(np.float64))
    away = np.array(camera.eye) - CENTRE
    a, b, c = (rays**2).sum(1), 2 * rays @ away, away @ away - RADIUS**2
    inside = b * b - 4 * a * c
    depth = np.where(inside > 0, (-b - np.sqrt(np.maximum(inside, 0))) / (2 * a), 0)
    return depth.reshape(camera.size)


def seen_points(camera: Camera) -> NDArray[np.float64]:
    """(H, W, 3) the points of the sphere that are seen; where none is, the eye."""
    y, x = np.indices(camera.size)
    return camera.unproject(np.stack([x, y], -1).astype(np.float64), seen_depth(camera))


def picture(camera: Camera) -> NDArray[np.float32]:
    """(H, W) float32 grey levels: waves in many directions, painted on the sphere; black beside it."""
    rng = np.random.default_rng(7)
    waves, phases = rng.normal(0, 70, (24, 3)), rng.uniform(0, 2 * np.pi, 24)
    pattern = np.sin(seen_points(camera) @ waves.T + phases).sum(axis=-1)
    return np.where(seen_depth(camera) > 0, np.clip(128 + 20 * pattern, 0, 255), 0).astype(np.float32)
