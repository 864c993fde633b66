"""What a camera sees of a surface: nothing behind other parts of it, and nothing beside an edge of them, where a camera that
is a little off takes the wrong one."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import depth_map

DEPTH_SLACK = 4e-3
"""By how much a point may lie behind what the depth buffer has and still be seen, in the unit of the vertices (metres)."""
DEPTH_JUMP = 3e-2
"""A jump of depth from which two pixels side by side show two parts of the surface, in the same unit."""
JUMP_MARGIN_PIXELS = 5
"""Pixels across about a jump of depth in which nothing is taken."""


class DepthBuffer(NamedTuple):
    """Of a surface in a picture (H, W): `depth` float32 along the view axis, +inf where nothing is, and `edge` bool, beside
    a jump of it."""

    depth: NDArray[np.float32]
    edge: NDArray[np.bool_]


def depth_buffer(
    camera: Camera, vertices: NDArray[np.floating], triangles: NDArray[np.integer], jump: float = DEPTH_JUMP
) -> DepthBuffer:
    """The depth of a surface, `vertices` (V, 3) and `triangles` (T, 3), as `camera` sees it; `jump` as `DEPTH_JUMP` says."""
    depth = depth_map(camera.project(vertices), triangles, camera.size, perspective=True)
    return DepthBuffer(depth, _beside_edges(depth, jump))


def view_cosines(camera: Camera, points: NDArray[np.floating], normals: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N,) of the angle between the unit normals (N, 3) of points (N, 3) and the way back to the camera; -1 behind it."""
    pixels = camera.project(points)
    before = pixels[:, 2] > 0
    out = np.full(len(points), -1, np.float32)
    rays = camera.rays(pixels[before, :2])
    out[before] = -(rays * normals[before]).sum(1) / np.linalg.norm(rays, axis=1)
    return out


@njit(nogil=True, boundscheck=False, error_model="numpy")
def shows(buffer: DepthBuffer, x: float, y: float, away: float, slack: float) -> bool:
    """Whether a point seen at pixel (x, y), `away` along the view axis, is what the picture shows there: within it, beside no
    edge, and not more than `slack` behind the surface. For callers that are compiled themselves."""
    depth, edge = buffer
    height, width = depth.shape
    if not (x >= 0 and y >= 0 and x <= width - 1 and y <= height - 1):  # NaN: beyond what a lens shows
        return False
    if edge[int(y + 0.5), int(x + 0.5)]:
        return False
    left, top = max(min(int(x), width - 2), 0), max(min(int(y), height - 2), 0)
    right, bottom = min(left + 1, width - 1), min(top + 1, height - 1)
    fx, fy = x - left, y - top
    nearest = (1 - fy) * ((1 - fx) * depth[top, left] + fx * depth[top, right])
    nearest += fy * ((1 - fx) * depth[bottom, left] + fx * depth[bottom, right])
    return bool(away <= nearest + slack)


def seen_points(buffer: DepthBuffer, pixels: NDArray[np.floating], slack: float = DEPTH_SLACK) -> NDArray[np.bool_]:
    """(N,) which points, as `Camera.project` has them in `pixels` (N, 3), the camera of the buffer sees."""
    return np.asarray(_seen(buffer, np.ascontiguousarray(pixels), slack))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _seen(buffer: DepthBuffer, pixels: np.ndarray, slack: float) -> np.ndarray:
    out = np.empty(len(pixels), np.bool_)
    for n in range(len(pixels)):
        out[n] = pixels[n, 2] > 0 and shows(buffer, pixels[n, 0], pixels[n, 1], pixels[n, 2], slack)
    return out


def _beside_edges(depth: NDArray[np.float32], jump: float) -> NDArray[np.bool_]:
    """(H, W) close to where the depth jumps, or the surface ends: a slope, however steep, does not jump."""
    known = np.where(np.isfinite(depth), depth, np.float32(0))
    framed = np.pad(known, 1, mode="reflect", reflect_type="odd")
    down = np.abs(framed[:-2, 1:-1] - 2 * known + framed[2:, 1:-1])
    across = np.abs(framed[1:-1, :-2] - 2 * known + framed[1:-1, 2:])
    jumps = (np.maximum(down, across) > jump).astype(np.uint8)
    return np.asarray(cv2.dilate(jumps, np.ones((JUMP_MARGIN_PIXELS, JUMP_MARGIN_PIXELS), np.uint8)) > 0)
