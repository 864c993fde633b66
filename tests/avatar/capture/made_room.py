"""Films of a pillar in a room, both with patterns, by rays: small, quick, and with cameras that are known."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera

SIZE = (288, 162)
FOCAL = 240.0
HALF_SIDE, HEIGHT = 3.0, 2.6
PILLAR_RADIUS, PILLAR_HEIGHT = 0.3, 1.75
TEXELS = 160
"""Of the patterns, a metre."""


def pattern(seed: int, height: int, width: int) -> NDArray[np.float32]:
    """Detail at several scales, around 128."""
    random = np.random.default_rng(seed)
    total = np.zeros((height, width, 3), np.float32)
    for sigma, strength in ((1.2, 18), (4.0, 22), (12.0, 28)):
        layer = cv2.GaussianBlur(random.standard_normal((height, width, 3)).astype(np.float32), (0, 0), sigma)
        total += strength * layer / layer.std()
    return np.clip(total + 128, 0, 255)


class Room:
    """Six walls and a pillar, drawn by rays."""

    def __init__(self) -> None:
        side = round(2 * HALF_SIDE * TEXELS)
        self.walls = [pattern(k, round(HEIGHT * TEXELS), side) for k in range(4)]
        self.floor, self.ceiling = pattern(4, side, side), pattern(5, side, side)
        around = round(2 * np.pi * PILLAR_RADIUS * TEXELS * 2)
        self.pillar = pattern(6, round(PILLAR_HEIGHT * TEXELS * 2), around)

    def picture(self, camera: Camera, shift: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.uint8]:
        """What a camera sees, (H, W, 3); the pillar stands so far from the middle (x, z), metres."""
        height, width = SIZE
        y, x = np.indices((height, width), np.float64)
        rays = camera.rays(np.stack([x.ravel(), y.ravel()], axis=1))
        eye = np.array(camera.eye)
        colour = np.zeros((len(rays), 3), np.float32)
        nearest = np.full(len(rays), np.inf)
        for axis, at, texture in self._planes():
            with np.errstate(divide="ignore"):
                away = (at - eye[axis]) / rays[:, axis]
            hit = (away > 0) & (away < nearest)
            others = [k for k in range(3) if k != axis]
            place = eye + np.where(np.isfinite(away), away, 0)[:, None] * rays
            low = np.array([-HALF_SIDE, 0, -HALF_SIDE])[others]
            if axis == 0:  # rows go up
                others, low = others[::-1], low[::-1]
            _paint(colour, texture, (place[:, others] - low) * TEXELS, hit)
            nearest = np.where(hit, away, nearest)
        offset = np.array([eye[0] - shift[0], eye[2] - shift[1]])
        flat = rays[:, [0, 2]]
        a, b, c = (flat**2).sum(1), flat @ offset, offset @ offset - PILLAR_RADIUS**2
        inside = b**2 - a * c
        away = (-b - np.sqrt(np.maximum(inside, 0))) / a
        place = eye + away[:, None] * rays
        hit = (inside > 0) & (away > 0) & (away < nearest) & (place[:, 1] < PILLAR_HEIGHT) & (place[:, 1] > 0)
        angle = np.arctan2(place[:, 0] - shift[0], place[:, 2] - shift[1]) + np.pi
        texels = np.stack([angle * PILLAR_RADIUS, place[:, 1]], axis=1) * TEXELS * 2
        _paint(colour, self.pillar, texels, hit)
        return np.clip(np.rint(colour), 0, 255).astype(np.uint8).reshape(height, width, 3)

    def _planes(self) -> list[tuple[int, float, NDArray[np.float32]]]:
        west, east, north, south = self.walls
        return [
            *((0, -HALF_SIDE, west), (0, HALF_SIDE, east), (2, -HALF_SIDE, north), (2, HALF_SIDE, south)),
            *((1, 0.0, self.floor), (1, HEIGHT, self.ceiling)),
        ]


def _paint(
    colour: NDArray[np.float32], texture: NDArray[np.float32], texels: NDArray[np.float64], hit: NDArray[np.bool_]
) -> None:
    at = np.where(hit[:, None], texels, 0).astype(np.float32).reshape(*SIZE, 2)
    found = cv2.remap(texture, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT_101)
    colour[hit] = found.reshape(-1, 3)[hit]


def orbit(count: int, turn: float = 2 * np.pi, seed: int = 0) -> list[Camera]:
    """Cameras that go around the pillar 1.9 m away, by hand: heights and directions vary a little."""
    random = np.random.default_rng(seed)
    start = Camera((0, 1, 2), FOCAL, ((SIZE[1] - 1) / 2, (SIZE[0] - 1) / 2), SIZE)
    cameras = []
    for k in range(count):
        angle = turn * k / count
        eye = (1.9 * np.sin(angle), 1.3 + 0.05 * random.standard_normal(), 1.9 * np.cos(angle))
        cameras.append(start.aimed(eye, (0.04 * random.standard_normal(), 0.95, 0.04 * random.standard_normal())))
    return cameras


def pillar_mask(camera: Camera) -> NDArray[np.bool_]:
    """Where a camera sees the pillar, (H, W)."""
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.stack([PILLAR_RADIUS * np.sin(angle), np.zeros(60), PILLAR_RADIUS * np.cos(angle)], axis=1)
    seen = camera.project(np.concatenate([ring, ring + np.array([0, PILLAR_HEIGHT, 0])]))[:, :2]
    drawn = np.zeros(camera.size, np.uint8)
    cv2.fillConvexPoly(drawn, cv2.convexHull(np.rint(seen).astype(np.int32)), (1,))
    return drawn > 0
