"""What views see about a body beyond doubt, so that nothing stands before it.

Stereo of dark hair and felt is wrong by centimetres. It is believed where it agrees with what else is known: where it has found
the fitted skin of a face, as beside a cheek; below the head, where it lies far behind what the silhouettes have room for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.multiview.free_space import SeenSurfaces, seen_depths
from engine.geometry.multiview.visual_hull import VisualHull, depth_range
from engine.geometry.point_clouds.point_cloud import PointCloud

POINT_RADIUS_METRES = 0.004
"""Metres of the disc that a point of the cloud hides."""
HOLLOW_METRES = 0.03
"""Metres by which a surface lies behind the silhouettes' hull, along a line of sight, where it is believed to be in a hollow."""
ON_SKIN_METRES, MIN_ON_SKIN_COSINE = 0.006, 0.6
"""Metres from the skin at which a point is on it, and the least cosine between its normal and the skin's."""
LOOKED_THROUGH_METRES = 0.006
"""Metres before a surface that is seen at which a place is looked through."""


@dataclass(frozen=True)
class SeenAround:
    """What views see beyond doubt.

    head : of the face's skin, which counts about the head.
    elsewhere : in hollows, which counts about the rest of the body.
    """

    head: SeenSurfaces
    elsewhere: SeenSurfaces

    def votes(self, places: NDArray[np.floating], of_head: NDArray[np.bool_]) -> NDArray[np.int32]:
        """(N, 2) how many views look through each of the `places` (N, 3), of which `of_head` (N,) are beside the head, and how many see
        something there."""
        votes = np.zeros((len(places), 2), np.int32)
        votes[of_head] = self.head.votes(places[of_head], LOOKED_THROUGH_METRES)
        votes[~of_head] = self.elsewhere.votes(places[~of_head], LOOKED_THROUGH_METRES)
        return votes


def seen_around(
    body: BodySurface, hull: VisualHull, cloud: PointCloud, cameras: Sequence[Camera], near: int
) -> SeenAround:
    """What `cameras` see of a `cloud` about a body with its `hull`; the last `near` of them are of the clip of the head."""
    depths = [seen_depths(cloud.points, cloud.normals, camera, POINT_RADIUS_METRES) for camera in cameras]
    skin = cloud[_on_face(cloud, body)]
    of_skin = []
    for camera, measured in zip(cameras, depths, strict=True):
        found = seen_depths(skin.points, skin.normals, camera, POINT_RADIUS_METRES)
        of_skin.append(np.where(found < measured + ON_SKIN_METRES, found, np.float32(np.inf)))
    far = len(cameras) - near
    hollows = [_in_hollow(hull, camera, measured) for camera, measured in zip(cameras[:far], depths[:far], strict=True)]
    return SeenAround(SeenSurfaces(cameras, of_skin), SeenSurfaces(cameras[:far], hollows))


def _on_face(cloud: PointCloud, body: BodySurface) -> NDArray[np.intp]:
    """Which points of a cloud are on the skin of the face, and look where it does."""
    nearest = body.nearest(cloud.points)
    asked = np.flatnonzero(body.face[nearest])
    normals = vertex_normals(body.vertices, body.triangles)[nearest[asked]]
    along = np.einsum("nd,nd->n", cloud.normals[asked], normals)
    return asked[(along > MIN_ON_SKIN_COSINE) & (np.abs(body.distances(cloud.points[asked])) < ON_SKIN_METRES)]


def _in_hollow(hull: VisualHull, camera: Camera, measured: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W) what a view has `measured` where that is far behind the hull, +inf elsewhere."""
    entered = depth_range(hull, camera, np.isfinite(measured))[..., 0]
    return np.where((entered > 0) & (measured - entered > HOLLOW_METRES), measured, np.float32(np.inf))
