"""Limbs drawn to the outline: what is left between both silhouettes once the template is displaced, taken up by a smooth warp of the picture plane.

Beyond the paper, whose mean value warp (section 4.1.2) has all of a part go to its outline. Here limbs are near it already: each point of their
silhouette goes to the nearest of the outline that faces as it does, and what is within goes with what is about it.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.character.hybrid.limbs import Limbs
from engine.character.shell.outlines import border_points
from engine.character.surface.front_and_back import ClosedMesh
from engine.imaging.masks.mask_distance import dilate_mask
from engine.render.rasterisation.rasteriser import rasterise

FINE_SCALE = 3
"""Pixels at which silhouettes are compared for each of the grid's."""
MAX_WARP_PIXELS, MIN_OUTLINE_NORMAL_COSINE = 6.0, 0.6
"""Pixels of the grid that a silhouette is drawn at most, and cosine between its normal and that of the outline there."""
WARP_SIGMA_PIXELS, FULL_WARP_WEIGHT = 4.0, 0.02
"""Pixels of the grid over which the warp is one; and how much of the silhouette is about a place that goes with it wholly."""
HELD_MARGIN_PIXELS = 3
"""Pixels of the grid around what is held in which the outline is not the body's."""
WARP_ROUNDS = 3
"""Times that silhouettes are compared."""


def drawn_to_the_outline(
    pictured: NDArray[np.float64],
    limbs: Limbs,
    triangles: NDArray[np.int32],
    trunk: ClosedMesh,
    soft: NDArray[np.float32],
    held: NDArray[np.int8] | None = None,
) -> NDArray[np.float64]:
    """The shell's vertices (V, 3) as `pictured`, those of its limbs moved in the picture. Afterwards limbs, whose
    `triangles` (T, 3) are shown, and trunk have the outline of the mask `soft` (h, w), from 0 to 1. What is `held` (h,
    w), -1 where nothing is, draws nothing."""
    size = (soft.shape[1] * FINE_SCALE, soft.shape[0] * FINE_SCALE)
    mask = cv2.resize(soft, size, interpolation=cv2.INTER_LINEAR) > 0.5
    outline, facing = border_points(mask)
    beside = np.ones(mask.shape, np.bool_)
    if held is not None:
        around = dilate_mask(held >= 0, HELD_MARGIN_PIXELS).astype(np.uint8)
        beside = cv2.resize(around, size, interpolation=cv2.INTER_NEAREST_EXACT) == 0
        x, y = outline.astype(int).T
        outline, facing = outline[beside[y, x]], facing[beside[y, x]]
    tree, moved = cKDTree(outline), pictured.copy()
    own = limbs.limb >= 0
    for _ in range(WARP_ROUNDS):
        seen = _silhouette(moved, triangles, trunk, (size[1], size[0]))
        points, normals = border_points(seen >= 0)
        x, y = points.astype(int).T
        limb = (seen[y, x] >= 0) & (seen[y, x] < len(triangles)) & beside[y, x]
        points, normals = points[limb], normals[limb]
        if not len(points):
            return moved
        away, nearest = tree.query(points)
        agrees = (away < MAX_WARP_PIXELS * FINE_SCALE) & (
            (normals * facing[nearest]).sum(1) > MIN_OUTLINE_NORMAL_COSINE
        )
        field = _spread(points[agrees], (outline[nearest] - points)[agrees], (size[1], size[0]))
        at = ((moved[own, :2] + 0.5) * FINE_SCALE - 0.5).astype(np.float32)
        shift = cv2.remap(field, at[:, None, 0].copy(), at[:, None, 1].copy(), cv2.INTER_LINEAR)[:, 0]
        moved[own, :2] += shift / FINE_SCALE
    return moved


def _silhouette(
    vertices: NDArray[np.float64], triangles: NDArray[np.int32], trunk: ClosedMesh, size: tuple[int, int]
) -> NDArray[np.int32]:
    """Which triangle is nearest (h, w) on the finer grid, those of limbs first, -1 beside all."""
    places = np.concatenate([vertices, trunk.vertices])
    places[:, :2] = (places[:, :2] + 0.5) * FINE_SCALE - 0.5
    both = np.concatenate([triangles, trunk.triangles + len(vertices)])
    return rasterise(places * [1, 1, -1], both, size).triangle


def _spread(points: NDArray[np.float64], ways: NDArray[np.float64], size: tuple[int, int]) -> NDArray[np.float32]:
    """The ways (N, 2) of points (N, 2), smoothed over the picture plane (h, w, 2), 0 far from all."""
    field = np.zeros((*size, 3), np.float32)
    x, y = np.rint(points).astype(int).T
    np.add.at(field, (y, x), np.concatenate([ways, np.ones((len(ways), 1))], 1).astype(np.float32))
    smooth = np.asarray(cv2.GaussianBlur(field, (0, 0), WARP_SIGMA_PIXELS * FINE_SCALE), np.float32)
    weight = smooth[..., 2:]
    return np.asarray(smooth[..., :2] / np.maximum(weight, FULL_WARP_WEIGHT / FINE_SCALE), np.float32)
