"""A soft shadow on the ground: dark where the feet touch it, fading with the height of what casts it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import draw_into

SHADOW_CELL_METRES = 0.02
"""Metres of ground to a cell of the shadow's map."""

SHADOW_HEIGHT_METRES = 0.06
"""Metres above the ground below which what is there casts the dark core of the shadow."""

PENUMBRA_SCALE = 4.0
"""How much softer than its core the rest of the shadow is."""

MAX_CELLS = 700
"""Cells along a side of the map: shadows that reach further (a low sun) are cut off."""


@dataclass(frozen=True)
class GroundShadow:
    """How the ground is darkened.

    strength : [0, 1]: how much of the light the core takes away.
    softness : metres over which its edge fades.
    reach : metres above the ground over which casting fades to a third; infinite for the whole shadow of a sun.
    light : (3,) the direction towards the light, y > 0.
    """

    strength: float = 0.55
    softness: float = 0.035
    reach: float = 0.5
    light: tuple[float, float, float] = (0.0, 1.0, 0.0)


def cast_on_ground(
    rgb: NDArray[np.uint8],
    lit: NDArray[np.uint8],
    posed: NDArray[np.float32],
    triangles: NDArray[np.int32],
    camera: Camera,
    shadow: GroundShadow,
    closed: bool = False,
) -> None:
    """Darken, in place, the pixels of `rgb` (H, W, 3) that show the ground y = 0 under the mesh `posed` (V, 3). `lit`
    (H, W, 3) is the same picture without any shadow: where several fall, the darkest stays. See `shadow_map` for
    `closed`."""
    points, corner, (rows, columns) = _laid(posed, shadow)
    ends = corner + np.array([[0, 0], [columns, 0], [0, rows], [columns, rows]]) * SHADOW_CELL_METRES
    seen = camera.project(np.stack([ends[:, 0], np.zeros(4), ends[:, 1]], 1))
    left, top, right, bottom = 0, 0, camera.size[1], camera.size[0]
    if (seen[:, 2] > 0).all():
        left, top = (max(int(np.floor(seen[:, k].min())), 0) for k in range(2))
        right = min(int(np.ceil(seen[:, 0].max())) + 1, right)
        bottom = min(int(np.ceil(seen[:, 1].max())) + 1, bottom)
    if right <= left or bottom <= top:
        return
    # a pixel's ray is linear in its coordinates
    start = camera.rays(np.array([[left, top]]))[0]
    across, down = (camera.rays(np.array([[left + dx, top + dy]]))[0] - start for dx, dy in ((1, 0), (0, 1)))
    _darken(
        rgb[top:bottom, left:right],
        lit[top:bottom, left:right],
        _density(points, (rows, columns), triangles, shadow, closed) * np.float32(shadow.strength),
        corner,
        np.array(camera.eye),
        start,
        across,
        down,
    )


def shadow_map(
    posed: NDArray[np.float32], triangles: NDArray[np.int32], shadow: GroundShadow, closed: bool = False
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """The shadow seen from above: (rows along z, columns along x) float32 [0, 1], and the (x, z) of its first corner.

    `closed`: the triangles make a closed surface, so that whatever is nearest to the ground is seen from below.
    """
    points, corner, size = _laid(posed, shadow)
    return _density(points, size, triangles, shadow, closed), corner


def _laid(
    posed: NDArray[np.float32], shadow: GroundShadow
) -> tuple[NDArray[np.float32], NDArray[np.float64], tuple[int, int]]:
    """The vertices as the light lays them on the ground, (V, 3): z and x in cells, and the height in metres. With them
    the (x, z) of the map's first corner, and the map's rows and columns."""
    lx, ly, lz = shadow.light
    if not ly > 0:
        raise ValueError("the light of a ground shadow must come from above")
    height = np.maximum(posed[:, 1], 0)
    x, z = posed[:, 0] - height * (lx / ly), posed[:, 2] - height * (lz / ly)
    margin = 3 * PENUMBRA_SCALE * shadow.softness + SHADOW_CELL_METRES
    corner = np.array([x.min(), z.min()], np.float64) - margin
    far = np.array([x.max(), z.max()], np.float64) + margin
    columns, rows = (int(np.clip(np.ceil(side / SHADOW_CELL_METRES), 1, MAX_CELLS)) for side in far - corner)
    points = np.stack(
        [(z - corner[1]) / SHADOW_CELL_METRES - 0.5, (x - corner[0]) / SHADOW_CELL_METRES - 0.5, height], 1
    ).astype(np.float32)
    return points, corner, (rows, columns)


def _density(
    points: NDArray[np.float32],
    size: tuple[int, int],
    triangles: NDArray[np.int32],
    shadow: GroundShadow,
    closed: bool,
) -> NDArray[np.float32]:
    """The map (rows, columns) [0, 1]. It is drawn with z across and x down: so the fronts of triangles are those that are
    seen from below."""
    across = np.full(size[::-1], np.inf, np.float32)
    draw_into(points, triangles, False, closed, np.empty(across.shape, np.int32), across)
    above = np.ascontiguousarray(across.T)
    blur = shadow.softness / SHADOW_CELL_METRES
    hit = np.isfinite(above)
    above[~hit] = 0
    core = cv2.GaussianBlur(hit * np.exp(-above / np.float32(SHADOW_HEIGHT_METRES)), (0, 0), max(blur, 1e-3))
    wide = cv2.GaussianBlur(hit * np.exp(-above / np.float32(shadow.reach)), (0, 0), max(PENUMBRA_SCALE * blur, 1e-3))
    return (1 - (1 - core) * (1 - 0.6 * wide)).astype(np.float32)


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _darken(
    rgb: np.ndarray,
    lit: np.ndarray,
    density: np.ndarray,
    corner: np.ndarray,
    eye: np.ndarray,
    start: np.ndarray,
    across: np.ndarray,
    down: np.ndarray,
) -> None:
    rows, columns = density.shape
    for i in range(rgb.shape[0]):
        for j in range(rgb.shape[1]):
            slope = start[1] + j * across[1] + i * down[1]
            if not slope * eye[1] < 0:  # the ray does not meet the ground
                continue
            far = -eye[1] / slope
            x = (eye[0] + far * (start[0] + j * across[0] + i * down[0]) - corner[0]) / SHADOW_CELL_METRES - 0.5
            z = (eye[2] + far * (start[2] + j * across[2] + i * down[2]) - corner[1]) / SHADOW_CELL_METRES - 0.5
            if not (x >= 0 and z >= 0 and x < columns - 1 and z < rows - 1):
                continue
            c, r = int(x), int(z)
            fx, fz = x - c, z - r
            dark = (1 - fz) * ((1 - fx) * density[r, c] + fx * density[r, c + 1])
            dark += fz * ((1 - fx) * density[r + 1, c] + fx * density[r + 1, c + 1])
            for k in range(3):
                rgb[i, j, k] = min(rgb[i, j, k], int(lit[i, j, k] * (1 - dark) + 0.5))
