"""Studio light as many small distant lamps: softboxes and a dome, each lamp casting its own shadows.

A large light is a sum of small ones; with some dozens of them the penumbrae of softboxes, the occlusion of
mouth and nostrils and the contact shadows under lids and hair all come out of one mechanism (A. Keller,
Instant Radiosity, SIGGRAPH 1997, used here for direct light only).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.rasterisation.rasteriser import depth_map


@dataclass(frozen=True)
class Lamps:
    """Distant lamps. `directions` (L, 3) float32 unit vectors towards each; `irradiance` (L, 3) float32 what
    each sends, in RGB, onto a surface that faces it."""

    directions: NDArray[np.float32]
    irradiance: NDArray[np.float32]

    def __add__(self, other: Lamps) -> Lamps:
        return Lamps(
            np.concatenate([self.directions, other.directions]), np.concatenate([self.irradiance, other.irradiance])
        )


def softbox(
    azimuth: float, elevation: float, extent: tuple[float, float], irradiance: NDArray[np.floating], count: int
) -> Lamps:
    """A rectangular light.

    Parameters
    ----------
    azimuth, elevation : degrees; 0, 0 is where the camera stands, positive to the sitter's left and up.
    extent : width and height, degrees seen from the sitter.
    irradiance : (3,) RGB of the whole box, on a surface that faces it.
    count : number of lamps.
    """
    index = np.arange(count)
    u = (index + 0.5) / count - 0.5
    v = (index * 0.6180339887498949) % 1 - 0.5  # a rank-1 lattice by the golden ratio covers the box evenly
    right, up = np.radians(azimuth + u * extent[0]), np.radians(elevation + v * extent[1])
    directions = np.stack([np.sin(right) * np.cos(up), np.sin(up), np.cos(right) * np.cos(up)], 1)
    share = np.tile(irradiance / count, (count, 1))
    return Lamps(directions.astype(np.float32), share.astype(np.float32))


def dome(zenith: NDArray[np.floating], horizon: NDArray[np.floating], nadir: NDArray[np.floating], count: int) -> Lamps:
    """Light from everywhere, given as radiance (3,) straight up, level and straight down: `count` lamps on a
    Fibonacci sphere."""
    index = np.arange(count) + 0.5
    height = 1 - 2 * index / count
    turn = np.pi * (1 + 5**0.5) * index
    flat = np.sqrt(1 - height**2)
    directions = np.stack([flat * np.cos(turn), height, flat * np.sin(turn)], 1)
    ends = np.where(height[:, None] > 0, zenith, nadir)
    radiance = horizon + np.abs(height[:, None]) * (ends - horizon)
    return Lamps(directions.astype(np.float32), (radiance * 4 * np.pi / count).astype(np.float32))


@dataclass(frozen=True)
class Shadow:
    """What one lamp sees.

    depth : (S, S) float32 along its rays.
    view : (4, 3) float32 that takes a point to (x, y, depth) of that map: rows right, down and away from the lamp, and
        the offset.
    """

    depth: NDArray[np.float32]
    view: NDArray[np.float32]
    texel: float


def cast_shadow(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    direction: NDArray[np.floating],
    centre: NDArray[np.floating],
    radius: float,
    size: int,
) -> Shadow:
    """The depth map of a lamp over the ball of `radius` metres around `centre`, `size` pixels wide."""
    away = -np.asarray(direction, np.float64)
    helper = np.array([0.0, 1.0, 0.0]) if abs(away[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    right = np.cross(away, helper)
    right /= np.linalg.norm(right)
    down = np.cross(away, right)
    texel = 2 * radius / size
    axes = np.stack([right / texel, down / texel, away])
    offset = np.array([(size - 1) / 2, (size - 1) / 2, 0.0]) - axes @ centre
    view = np.concatenate([axes, offset[None]]).astype(np.float32)
    seen = _seen_by(np.ascontiguousarray(vertices, np.float32), view)
    return Shadow(depth_map(seen, triangles, (size, size)), view, texel)


@njit(fastmath=True)
def _seen_by(vertices: np.ndarray, view: np.ndarray) -> np.ndarray:
    out = np.empty_like(vertices)
    for i in range(len(vertices)):
        x, y, z = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        for k in range(3):
            out[i, k] = view[k, 0] * x + view[k, 1] * y + view[k, 2] * z + view[3, k]
    return out


@njit(inline="always")
def light_visibility(depth: np.ndarray, view: np.ndarray, x: float, y: float, z: float, bias: float) -> np.float32:
    """The share of light [0, 1] that reaches a point: four texels compared, blended bilinearly."""
    u = view[0, 0] * x + view[0, 1] * y + view[0, 2] * z + view[3, 0]
    v = view[1, 0] * x + view[1, 1] * y + view[1, 2] * z + view[3, 1]
    w = view[2, 0] * x + view[2, 1] * y + view[2, 2] * z + view[3, 2] - bias
    left, top = int(np.floor(u)), int(np.floor(v))
    if left < 0 or top < 0 or left + 1 >= depth.shape[1] or top + 1 >= depth.shape[0]:
        return np.float32(1)
    fu, fv = np.float32(u - left), np.float32(v - top)
    one, nought = np.float32(1), np.float32(0)
    upper = (one - fu if depth[top, left] >= w else nought) + (fu if depth[top, left + 1] >= w else nought)
    lower = (one - fu if depth[top + 1, left] >= w else nought) + (fu if depth[top + 1, left + 1] >= w else nought)
    return upper * (one - fv) + lower * fv
