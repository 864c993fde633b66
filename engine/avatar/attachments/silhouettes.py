"""What silhouettes say of things that stand off a body: whether they have room for them, and whether they show them beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.camera import Camera
from engine.geometry.multiview.silhouette_depth import Beside, silhouette_depths
from engine.render.rasteriser import rasterise

MAX_SILHOUETTES_WITHOUT_PIECE_SHARE = 0.3
"""Share of the silhouettes beside the body that may leave out what is there: thin things are seen edge-on in some, and the person
sways."""
BESIDE_BODY_METRES = 0.006
"""Metres from the body's outline at which something is beside it."""
MIN_BESIDE_VIEWS, BESIDE_SHARE = 4, 0.7
"""Views that show a surface beside the body, at least, and the share of its pixels there that silhouettes have: depth alone is no
proof."""
RIM_PIXELS = 2
"""Pixels around the body that do not count as beside it."""
MIN_ADDED_SHARE = 0.03
"""Share of a surface's pixels that a view has beside the body, if it shows it there."""


@dataclass(frozen=True)
class Silhouettes:
    """Where views have the person, `masks` (H, W) bool of the views' `cameras`, each of its mask's size; and where they would have the
    person's body alone, `bare`."""

    masks: Sequence[NDArray[np.bool_]]
    cameras: Sequence[Camera]
    bare: Sequence[NDArray[np.bool_]]

    def depths(self, points: NDArray[np.floating]) -> tuple[NDArray[np.float32], NDArray[np.uint16]]:
        """How far `points` (N, 3) lie within silhouettes, and how many views have them there, (N,). The former, (N,)
        metres, negative outside, is the least over the views that have them beside the body, but for
        `MAX_SILHOUETTES_WITHOUT_PIECE_SHARE` of these. It is +inf where no view has them there."""
        beside = Beside(self.bare, BESIDE_BODY_METRES)
        return silhouette_depths(points, self.masks, self.cameras, MAX_SILHOUETTES_WITHOUT_PIECE_SHARE, beside)

    def confirm(self, vertices: NDArray[np.floating], triangles: NDArray[np.int32]) -> bool:
        """Whether enough views have a surface, vertices (V, 3) and triangles (T, 3), beside the body, and most of what it adds there
        within the silhouettes."""
        views, added, within = 0, 0, 0
        for mask, camera, bare in zip(self.masks, self.cameras, self.bare, strict=True):
            own = _shown(camera, vertices, triangles)
            rim = np.ones((2 * RIM_PIXELS + 1, 2 * RIM_PIXELS + 1), np.uint8)
            more = own & (cv2.dilate(bare.astype(np.uint8), rim) == 0)
            views += int(more.sum() > MIN_ADDED_SHARE * own.sum())
            added += int(more.sum())
            within += int((more & mask).sum())
        return views >= MIN_BESIDE_VIEWS and within >= BESIDE_SHARE * added


def silhouettes_beside(body: BodySurface, masks: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera]) -> Silhouettes:
    """The silhouettes of views, with that of the body in each."""
    return Silhouettes(masks, cameras, [_shown(camera, body.vertices, body.triangles) for camera in cameras])


def _shown(camera: Camera, vertices: NDArray[np.floating], triangles: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(H, W) which pixels show a surface."""
    return rasterise(camera.project(vertices), triangles, camera.size, perspective=True).triangle >= 0
