"""What silhouettes say of things that stand off a body: whether they have room for them, and whether they show them beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.camera import Camera
from engine.geometry.multiview.silhouette_depth import silhouette_depths
from engine.render.rasteriser import rasterise

WRONG_SILHOUETTES = 0.2
"""Share of the silhouettes that may leave a point out: thin things are seen edge-on in some, and the person sways."""
BESIDE_VIEWS, BESIDE_SHARE = 4, 0.7
"""Views that show something beside the fitted body, at least, and the share of them whose silhouettes have it: depth alone is no
proof."""
BODY_RIM_PIXELS = 2
"""Pixels around the body that do not count as beside it."""
LEAST_ADDED = 0.03
"""Share of a surface's pixels that a view has beside the body, if it shows it there."""


@dataclass(frozen=True)
class Silhouettes:
    """Where views have the person: `masks` (H, W) bool of the views' `cameras`, each of its mask's size."""

    masks: Sequence[NDArray[np.bool_]]
    cameras: Sequence[Camera]

    def depths(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """(N,) metres by which `points` (N, 3) lie within the silhouettes, but for `WRONG_SILHOUETTES` of them; negative outside."""
        return silhouette_depths(points, self.masks, self.cameras, WRONG_SILHOUETTES)[0]

    def show_beside(self, points: NDArray[np.floating], body: BodySurface, distance: float) -> NDArray[np.bool_]:
        """(N,) which of the `points` (N, 3) enough views have beside the body, by more than `distance` metres, and most of these
        within its silhouette."""
        seen, within = np.zeros(len(points), np.intp), np.zeros(len(points), np.intp)
        for mask, camera in zip(self.masks, self.cameras, strict=True):
            at = camera.project(points)
            inside = ((at[:, :2] > -0.5) & (at[:, :2] < np.array(camera.size[::-1]) - 0.5)).all(1) & (at[:, 2] > 0)
            column, row = np.rint(np.where(inside[:, None], at[:, :2], 0)).astype(np.intp).T
            away = _pixels_from(_shown(camera, body.vertices, body.triangles))[row, column]
            beside = inside & (away > distance * camera.focal / np.maximum(at[:, 2], 1e-6))
            seen += beside
            within += beside & (_pixels_from(mask)[row, column] <= 1)
        return (seen >= BESIDE_VIEWS) & (within >= BESIDE_SHARE * seen)

    def confirm(self, vertices: NDArray[np.floating], triangles: NDArray[np.int32], body: BodySurface) -> bool:
        """Whether enough views have a surface, vertices (V, 3) and triangles (T, 3), beside the body, and most of what it adds there
        within the silhouettes."""
        views, added, within = 0, 0, 0
        for mask, camera in zip(self.masks, self.cameras, strict=True):
            own = _shown(camera, vertices, triangles)
            more = own & (_pixels_from(_shown(camera, body.vertices, body.triangles)) > BODY_RIM_PIXELS)
            views += int(more.sum() > LEAST_ADDED * own.sum())
            added += int(more.sum())
            within += int((more & mask).sum())
        return views >= BESIDE_VIEWS and within >= BESIDE_SHARE * added


def _shown(camera: Camera, vertices: NDArray[np.floating], triangles: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(H, W) which pixels show a surface."""
    return rasterise(camera.project(vertices), triangles, camera.size, perspective=True).triangle >= 0


def _pixels_from(mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(H, W) how far each pixel is from the nearest of a mask; 0 within it."""
    if not mask.any():
        return np.full(mask.shape, np.inf, np.float32)
    return np.asarray(cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5), np.float32)
