"""What silhouettes say of things that stand off a body: whether they have room for them, and whether they show them beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.camera import Camera
from engine.geometry.multiview.silhouette_depth import Beside, silhouette_depths
from engine.render.rasterisation.rasteriser import triangle_map

MAX_WRONG_SILHOUETTES_SHARE = 0.12
"""Share of the silhouettes that may leave out what is there: masks miss a hat or its rim in some. With 0.15 a hat and hair came out 6 mm
too large, with 0.08 3, and a brim had gaps."""
MAX_SILHOUETTES_WITHOUT_PIECE_SHARE = 0.3
"""Share of the silhouettes that may leave out what is there, of those alone that have it beside the body: thin things are
seen edge-on in some."""
BESIDE_BODY_METRES = 0.006
"""Metres from the body's outline at which something is beside it."""


@dataclass(frozen=True)
class Silhouettes:
    """What views have of the person.

    masks : (H, W) bool, where each has the person.
    cameras : theirs, each of its mask's size.
    bare : (H, W) bool, where each would have the person's body alone.
    near : how many views, the last ones, are of the clip of the head: they are asked of that alone.
    """

    masks: Sequence[NDArray[np.bool_]]
    cameras: Sequence[Camera]
    bare: Sequence[NDArray[np.bool_]]
    near: int

    def depths(self, points: NDArray[np.floating], of_head: NDArray[np.bool_]) -> NDArray[np.float32]:
        """(N,) metres by which `points` (N, 3) lie within the silhouettes, negative outside: the least over all of them but for
        `MAX_WRONG_SILHOUETTES_SHARE`. `of_head` (N,): those that are beside the head."""
        return self._asked(points, of_head, MAX_WRONG_SILHOUETTES_SHARE, False)[0]

    def depths_beside(
        self, points: NDArray[np.floating], of_head: NDArray[np.bool_]
    ) -> tuple[NDArray[np.float32], NDArray[np.uint16]]:
        """How far `points` (N, 3) lie within silhouettes, and how many views have them there, (N,). The former, (N,)
        metres, negative outside, is the least over the views that have them beside the body, but for
        `MAX_SILHOUETTES_WITHOUT_PIECE_SHARE` of these. It is +inf where no view has them there."""
        return self._asked(points, of_head, MAX_SILHOUETTES_WITHOUT_PIECE_SHARE, True)

    def _asked(
        self, points: NDArray[np.floating], of_head: NDArray[np.bool_], wrong: float, beside: bool
    ) -> tuple[NDArray[np.float32], NDArray[np.uint16]]:
        depths, views = np.full(len(points), np.inf, np.float32), np.zeros(len(points), np.uint16)
        for asked, count in ((of_head, len(self.masks)), (~of_head, len(self.masks) - self.near)):
            known = Beside(self.bare[:count], BESIDE_BODY_METRES) if beside else None
            depths[asked], views[asked] = silhouette_depths(
                points[asked], self.masks[:count], self.cameras[:count], wrong, known
            )
        return depths, views


def silhouettes_beside(
    body: BodySurface, masks: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera], near: int = 0
) -> Silhouettes:
    """The silhouettes of views, the last `near` of which are of the clip of the head, with that of the body in each."""
    bare = [
        triangle_map(camera.project(body.vertices), body.triangles, camera.size, perspective=True) >= 0
        for camera in cameras
    ]
    return Silhouettes(masks, cameras, bare, near)
