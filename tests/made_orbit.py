"""Cameras that orbit a cloud of points, and what they see: bundles whose truth is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.multiview.bundle import Bundle, Observations

SIZE = (640, 360)


def orbit(count: int = 12, points: int = 150, seed: int = 0, turn: float = 2 * np.pi, focal: float = 520.0) -> Bundle:
    """`count` cameras 2 m from the middle of a body of points 1.6 m high, in a room of twice as many."""
    random = np.random.default_rng(seed)
    body = random.uniform([-0.3, 0.0, -0.2], [0.3, 1.6, 0.2], (points, 3))
    angle = random.uniform(0, 2 * np.pi, 2 * points)
    reach = random.uniform(3.0, 4.0, 2 * points)
    room = np.stack([reach * np.sin(angle), random.uniform(-0.4, 2.4, 2 * points), reach * np.cos(angle)], axis=1)
    start = Camera((0, 1, 2), focal, (SIZE[1] / 2 - 0.5, SIZE[0] / 2 - 0.5), SIZE)
    along = turn * np.arange(count) / count
    height = 1.0 + 0.3 * random.standard_normal(count)
    cameras = [start.aimed((2 * np.sin(a), h, 2 * np.cos(a)), (0, 0.9, 0)) for a, h in zip(along, height, strict=True)]
    return Bundle(
        np.array([one.rotation for one in cameras]),
        np.array([one.translation for one in cameras]),
        np.array([[focal, 0.05, -0.08]]),
        np.array([start.centre]),
        np.zeros(count, np.intp),
        np.concatenate([body, room]),
    )


def observed(bundle: Bundle, noise: float = 0.0, seed: int = 1) -> Observations:
    """Every point where every camera sees it, if that is within its picture, with so many pixels of noise in x and in y."""
    cameras, points, pixels = [], [], []
    for c in range(len(bundle.rotations)):
        found = bundle.camera(c, SIZE).project(bundle.points, np.float64)
        xy: NDArray[np.float64] = found[:, :2]
        inside = (found[:, 2] > 0.1) & (xy >= 0).all(1) & (xy < [SIZE[1], SIZE[0]]).all(1)
        cameras.append(np.full(int(inside.sum()), c))
        points.append(np.flatnonzero(inside))
        pixels.append(xy[inside])
    seen = np.concatenate(pixels)
    seen = seen + noise * np.random.default_rng(seed).standard_normal(seen.shape)
    found_points = np.concatenate(points)
    often = np.bincount(found_points, minlength=len(bundle.points))[found_points] >= 2
    return Observations(np.concatenate(cameras), found_points, seen)[often]
