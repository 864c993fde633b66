"""Dense stereo: from views with their cameras to a cloud of the person (the paper's section 3.2, without Metashape).

The silhouettes' hull says between which depths the person is, PatchMatch measures each view against four others, and a point
stays where views agree. What sways between frames is taken out twice: each view's depth is laid on what all say, rigidly, and
fused anew. Where stereo found nothing, rims of the silhouettes stand in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.capture.captured_view import CapturedView
from engine.avatar.capture.silhouette_rims import rim_points
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.multiview.depth_fusion import Agreement, FusedPoints, fuse_depth_maps
from engine.geometry.multiview.patch_match_stereo import DepthMap, StereoView, nothing_measured, patch_match_stereo
from engine.geometry.multiview.view_selection import chosen_sources, shared_sight
from engine.geometry.multiview.visual_hull import VisualHull, depth_range, visual_hull
from engine.geometry.point_clouds.cloud_cleaning import crowded, in_large_pieces, smoothed_along_normals
from engine.geometry.point_clouds.point_cloud import PointCloud, joined, thinning
from engine.geometry.registration.cloud_alignment import align_to_surface

HULL_SPACING_METRES = 0.008
"""Metres from voxel to voxel."""
SILHOUETTE_ERROR_PIXELS = 1.5
"""Pixels by which segmentation errs, at the size at which stereo works."""
SIGHT_SUBSAMPLING = 16
"""One of so many points of the hull's surface tells which views share sight."""
SOURCE_VIEW_COUNT, ASKED_VIEW_COUNT = 4, 12
"""Views that a view is measured against, and those that are asked about its points."""
VIEW_ALIGNMENT_ROUNDS = 2
"""Rounds of laying views on the fused cloud."""
FUSED_STEP = 2
"""Of a view's rows and of its columns one in so many gives points of the cloud: others show the same places."""
ALIGNMENT_STEP = 3
"""Of a view's rows and of its columns one in so many is fused to the cloud on which views are laid."""
MAX_ALIGNED_VIEW_POINTS = 1500
"""Points of a view, at most, that are laid on the cloud."""
VIEW_ALIGNMENT_GATE_METRES = 0.02
"""Metres within which the cloud's surface is looked for."""
CLOUD_SPACING_METRES = 0.003
"""Metres: of points in one cell so wide one stays."""
ALIGNMENT_SPACING_METRES = 0.006
"""Metres between points of the surface on which views are laid."""
POINT_SMOOTHING_RADIUS_METRES = 0.008
"""Metres about a point whose points smooth it."""
ALIGNED_COST = 0.5
"""Greatest cost of the measurements by which a view is laid on the cloud."""
CROP_BORDER_PIXELS = 8
"""Pixels around the person that are kept."""
STEREO_SHARE = 0.9
"""Share of the stage's time that stereo takes."""
SURFACE_NEIGHBOUR_METRES, MIN_SURFACE_NEIGHBOURS = 0.012, 6
"""Metres within which a point of the surface has so many others."""
RIM_GAP_METRES = 0.015
"""Metres around a point of a silhouette's rim in which stereo found nothing."""
RIM_RADIUS_METRES, MIN_RIM_CONFIRMATIONS = 0.01, 3
"""Metres within which so many others confirm a point of a silhouette's rim, and from one that is taken to the next."""
CLOUD_PIECE_GAP_METRES, PIECE_SHARE = 0.02, 0.01
"""Metres that part pieces, and what a piece must have of the largest one's points."""


@dataclass(frozen=True)
class DenseCloud:
    """What stereo measured.

    cloud : the points.
    support : (N,) uint8, how many views saw each point, 0 where silhouettes alone tell of it.
    cameras : of all views, moved with the person's sway, lens's distortion included.
    """

    cloud: PointCloud
    support: NDArray[np.uint8]
    cameras: tuple[Camera, ...]


def dense_cloud(
    views: Sequence[CapturedView],
    agreement: Agreement | None = None,
    told: Callable[[float], None] = lambda share: None,
) -> DenseCloud:
    """The cloud of the person in `views`, in their cameras' world, metres.

    `told` hears from time to time what share of the work is done.

    Raises `InputError` (`person_not_measured`) where the silhouettes share nothing or no two views agree.
    """
    agreement = agreement or Agreement()
    straight = _cropped([view.undistorted() for view in views])
    cameras = [view.camera for view in straight]
    try:
        hull = visual_hull([view.figure for view in straight], cameras, HULL_SPACING_METRES, SILHOUETTE_ERROR_PIXELS)
    except ValueError as error:
        raise _not_measured() from error
    shared = shared_sight(cameras, *(part[::SIGHT_SUBSAMPLING] for part in hull.surface()))
    centre = hull.box().mean(axis=0)
    sources = chosen_sources(shared, cameras, centre, SOURCE_VIEW_COUNT)
    asked = [[int(v) for v in np.argsort(-row)[:ASKED_VIEW_COUNT] if row[v] > 0] for row in shared]
    maps = _measured(straight, hull, sources, told)
    images = [view.image for view in straight]
    for _ in range(VIEW_ALIGNMENT_ROUNDS):
        thin = fuse_depth_maps(maps, cameras, images, asked, agreement, ALIGNMENT_STEP)
        if not len(thin.cloud):
            raise _not_measured()
        cameras = _aligned(maps, cameras, thin)
    fused = fuse_depth_maps(maps, cameras, images, asked, agreement, FUSED_STEP)
    cloud, support = _with_rims(*_cleaned(fused), straight, hull)
    told(1.0)
    moved = [replace(v.camera, eye=c.eye, axes=c.axes) for c, v in zip(cameras, views, strict=True)]
    return DenseCloud(cloud, support, tuple(moved))


def _not_measured() -> InputError:
    return InputError(
        "person_not_measured",
        "The frames do not agree about the person's shape; film a slow circle around someone who stands still, in even light.",
    )


def _cropped(views: Sequence[CapturedView]) -> list[CapturedView]:
    """The parts of the views that hold the person, all of one size: that is less to keep and to go through."""
    boxes = [cv2.boundingRect(view.figure.astype(np.uint8)) for view in views]
    height = min(max(box[3] for box in boxes) + 2 * CROP_BORDER_PIXELS, *(view.camera.size[0] for view in views))
    width = min(max(box[2] for box in boxes) + 2 * CROP_BORDER_PIXELS, *(view.camera.size[1] for view in views))
    parts = []
    for view, (left, top, wide, high) in zip(views, boxes, strict=True):
        x = min(max(left + (wide - width) // 2, 0), view.camera.size[1] - width)
        y = min(max(top + (high - height) // 2, 0), view.camera.size[0] - height)
        parts.append(view.cropped(x, y, (height, width)))
    return parts


def _measured(
    views: Sequence[CapturedView], hull: VisualHull, sources: Sequence[Sequence[int]], told: Callable[[float], None]
) -> list[DepthMap]:
    """Each view's depth against its sources'."""
    ready = [StereoView(view.grey, view.figure, view.camera) for view in views]
    maps = []
    for number, view in enumerate(ready):
        others = [ready[source] for source in sources[number]]
        if others:
            reach = depth_range(hull, view.camera, view.figure)
            maps.append(patch_match_stereo(view, others, reach, seed=number))
        else:  # it sees what no other does
            maps.append(nothing_measured(view.camera.size))
        told(STEREO_SHARE * (number + 1) / len(ready))
    return maps


def _aligned(maps: Sequence[DepthMap], cameras: Sequence[Camera], fused: FusedPoints) -> list[Camera]:
    """The cameras, each moved with its view's depth as that lies best on what all views say."""
    surface = fused.cloud[thinning(fused.cloud.points, ALIGNMENT_SPACING_METRES)]
    tree = cKDTree(surface.points)
    moved = []
    for measured, camera in zip(maps, cameras, strict=True):
        y, x = np.nonzero((measured.depth > 0) & (measured.cost < ALIGNED_COST))
        step = max(len(y) // MAX_ALIGNED_VIEW_POINTS, 1)
        y, x = y[::step], x[::step]
        points = camera.unproject(np.stack([x, y], axis=-1).astype(np.float64), measured.depth[y, x])
        normals = measured.normals[y, x]
        motion = align_to_surface(points, normals, tree, surface.normals, VIEW_ALIGNMENT_GATE_METRES)
        moved.append(camera.moved(motion))
    return moved


def _cleaned(fused: FusedPoints) -> tuple[PointCloud, NDArray[np.uint8]]:
    """One point in each cell, without lone points and pieces that hang apart, smoothed; and its support."""
    chosen = thinning(fused.cloud.points, CLOUD_SPACING_METRES)
    chosen = chosen[crowded(fused.cloud[chosen], SURFACE_NEIGHBOUR_METRES, MIN_SURFACE_NEIGHBOURS)]
    chosen = chosen[in_large_pieces(fused.cloud[chosen], CLOUD_PIECE_GAP_METRES, PIECE_SHARE)]
    return smoothed_along_normals(fused.cloud[chosen], POINT_SMOOTHING_RADIUS_METRES), fused.support[chosen]


def _with_rims(
    cloud: PointCloud, support: NDArray[np.uint8], views: Sequence[CapturedView], hull: VisualHull
) -> tuple[PointCloud, NDArray[np.uint8]]:
    """The cloud and, where it has nothing, points of the silhouettes' rims on which several agree."""
    rims = joined([rim_points(view, hull) for view in views])
    rims = rims[crowded(rims, RIM_RADIUS_METRES, MIN_RIM_CONFIRMATIONS)]
    rims = rims[thinning(rims.points, RIM_RADIUS_METRES)]
    distance = np.asarray(cKDTree(cloud.points).query(rims.points, distance_upper_bound=RIM_GAP_METRES)[0])
    rims = rims[~np.isfinite(distance)]
    return joined([cloud, rims]), np.concatenate([support, np.zeros(len(rims), np.uint8)])
