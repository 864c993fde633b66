"""The visual hull: the largest body that casts the given silhouettes, as voxels, and where lines of sight meet it.

Source: A. Laurentini, The Visual Hull Concept for Silhouette-Based Image Understanding, PAMI 1994; carved voxel by voxel as
R. Szeliski, Rapid Octree Construction from Image Sequences, CVGIP 1993, in two levels instead of an octree's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray
from scipy import ndimage

from engine.compiled import njit
from engine.geometry.camera import Camera

COARSE_CELLS = 40
"""Cells along the longest side of the grid in which the body is looked for first."""
CUBE_SIDE_CAMERA_DISTANCES = 1.6
"""Side of the cube in which a body is looked for, in mean distances of the cameras from where they look."""
MAX_MISSED_SILHOUETTES_SHARE = 0.08
"""Share of the silhouettes that see a voxel and may leave it out: segmentation errs in single frames."""
MIN_SIGHTINGS_SHARE = 0.15
"""Share of the views that must have a voxel in their picture: what fewer see is not known to be there."""
NORMAL_BLUR_VOXELS = 1.5
"""Voxels of the Gaussian by which occupancy is blurred before it tells normals."""
RAY_STEP_VOXELS = 0.5
"""Steps along a line of sight, in voxels."""


@dataclass(frozen=True)
class VisualHull:
    """Voxels that a body may fill.

    `occupied` (X, Y, Z) bool; `origin` (3,) the centre of the first voxel and `spacing` from one centre to the next, metres.
    """

    occupied: NDArray[np.bool_]
    origin: NDArray[np.float64]
    spacing: float

    def box(self) -> NDArray[np.float64]:
        """(2, 3) the least and the greatest corner of what is occupied, metres. Raises ValueError where nothing is."""
        filled = np.argwhere(self.occupied)
        if not len(filled):
            raise ValueError("nothing lies within the silhouettes of enough views")
        ends = np.stack([filled.min(axis=0) - 0.5, filled.max(axis=0) + 0.5])
        return np.asarray(self.origin + self.spacing * ends)

    def surface(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N, 3) metres: the centres of the occupied voxels of which a neighbour, across a side, is empty; and (N, 3) unit
        normals there, out of the body."""
        filled = np.pad(self.occupied, 1)
        outer = np.argwhere(filled & ~ndimage.binary_erosion(filled))
        blurred = ndimage.gaussian_filter(filled.astype(np.float32), NORMAL_BLUR_VOXELS)
        slope = np.stack([np.gradient(blurred, axis=axis) for axis in range(3)], axis=-1)
        normals = -slope[tuple(outer.T)].astype(np.float64)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
        return self.origin + self.spacing * (outer - 1), normals


def visual_hull(
    silhouettes: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera], spacing: float, margin: float = 0.0
) -> VisualHull:
    """What lies within the silhouettes of those views that have it in their picture.

    Parameters
    ----------
    silhouettes : (H, W) each, of its camera's size. What lies beyond a picture's border it says nothing about.
    cameras : without distortion, around the body.
    spacing : of the voxels, metres. A voxel is kept where a ball about it may be seen within a silhouette.
    margin : pixels around a silhouette that count as it: what segmentation and cameras err by.

    Raises ValueError where no voxel is left.
    """
    outside = [_distance(silhouette) for silhouette in silhouettes]
    eyes = np.array([camera.eye for camera in cameras])
    centre = _meeting_point(eyes, np.array([camera.axes[2] for camera in cameras]))
    half = CUBE_SIDE_CAMERA_DISTANCES / 2 * float(np.linalg.norm(eyes - centre, axis=1).mean())
    box = np.stack([centre - half, centre + half])
    for _ in range(2):  # the second time in the box of what the first has found
        coarse = float((box[1] - box[0]).max()) / COARSE_CELLS
        box = _largest_piece(_carved(outside, cameras, box, coarse, margin)).box()
    return _carved(outside, cameras, box, spacing, margin)


def depth_range(hull: VisualHull, camera: Camera, pixels: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(H, W, 2) float32, metres along the view axis: where the line of sight of each pixel of `pixels` (H, W) first enters
    the hull, and where it leaves it for good. Zero for other pixels and where the hull is missed."""
    found = np.zeros((*camera.size, 2), np.float32)
    lens = np.array([camera.focal, camera.focal * camera.aspect, *camera.centre])
    eye, axes = np.array(camera.eye), np.array(camera.axes)
    _march(hull.occupied, hull.origin, hull.spacing, eye, axes, lens, np.ascontiguousarray(pixels), found)
    return found


def _meeting_point(eyes: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) the point nearest to lines from `eyes` (N, 3) along `axes` (N, 3), in least squares."""
    across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    return np.asarray(np.linalg.lstsq(across.sum(axis=0), np.einsum("nij,nj->i", across, eyes), rcond=None)[0])


def _largest_piece(hull: VisualHull) -> VisualHull:
    """Cones of sight may meet far from the body, too, where few views look."""
    pieces, _ = ndimage.label(hull.occupied)
    sizes = np.bincount(pieces[hull.occupied], minlength=2)
    return VisualHull(pieces == max(int(np.argmax(sizes)), 1), hull.origin, hull.spacing)


def _distance(silhouette: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(H, W) pixels to the silhouette; far where there is none."""
    return np.asarray(cv2.distanceTransform((~silhouette).astype(np.uint8), cv2.DIST_L2, 3), np.float32)


def _carved(
    outside: Sequence[NDArray[np.float32]],
    cameras: Sequence[Camera],
    box: NDArray[np.float64],
    spacing: float,
    margin: float,
) -> VisualHull:
    cells = np.ceil((box[1] - box[0]) / spacing).astype(int) + 2
    origin = (box[0] + box[1]) / 2 - spacing * (cells - 1) / 2
    seen, missed = np.zeros(cells, np.uint16), np.zeros(cells, np.uint16)
    may_miss = int(MAX_MISSED_SILHOUETTES_SHARE * len(cameras))
    for distance, camera in zip(outside, cameras, strict=True):
        reach = np.sqrt(0.75) * spacing * camera.focal  # a voxel's corner is as far from its centre
        _vote(origin, spacing, camera.projection, distance, margin, reach, may_miss, seen, missed)
    return VisualHull(
        (seen >= MIN_SIGHTINGS_SHARE * len(cameras)) & (missed <= MAX_MISSED_SILHOUETTES_SHARE * seen), origin, spacing
    )


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _vote(
    origin: np.ndarray,
    spacing: float,
    projection: np.ndarray,
    distance: np.ndarray,
    margin: float,
    reach: float,
    may_miss: int,
    seen: np.ndarray,
    missed: np.ndarray,
) -> None:
    """Count for each voxel whether the view sees it and whether it lies outside; those that are lost already are left."""
    height, width = distance.shape
    columns, rows, layers = seen.shape
    for i in prange(columns):
        for j in range(rows):
            x, y = origin[0] + spacing * i, origin[1] + spacing * j
            right = projection[0, 0] * x + projection[0, 1] * y + projection[0, 3]
            down = projection[1, 0] * x + projection[1, 1] * y + projection[1, 3]
            ahead = projection[2, 0] * x + projection[2, 1] * y + projection[2, 3]
            for k in range(layers):
                if missed[i, j, k] > may_miss:
                    continue
                z = origin[2] + spacing * k
                away = ahead + projection[2, 2] * z
                if away <= 0:
                    continue
                u = int(np.floor((right + projection[0, 2] * z) / away + 0.5))
                v = int(np.floor((down + projection[1, 2] * z) / away + 0.5))
                if 0 <= u < width and 0 <= v < height:
                    seen[i, j, k] += 1
                    if distance[v, u] > margin + reach / away:
                        missed[i, j, k] += 1


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _march(
    occupied: np.ndarray,
    origin: np.ndarray,
    spacing: float,
    eye: np.ndarray,
    axes: np.ndarray,
    lens: np.ndarray,
    pixels: np.ndarray,
    found: np.ndarray,
) -> None:
    for y in prange(pixels.shape[0]):
        for x in range(pixels.shape[1]):
            if not pixels[y, x]:
                continue
            right, up = (x - lens[2]) / lens[0], -(y - lens[3]) / lens[1]
            first, last = 0.0, np.inf  # of the ray, within the grid
            at, along = np.empty(3), np.empty(3)
            for k in range(3):
                along[k] = (right * axes[0, k] + up * axes[1, k] - axes[2, k]) / spacing
                at[k] = (eye[k] - origin[k]) / spacing
                if along[k] != 0:
                    enter, leave = (-0.5 - at[k]) / along[k], (occupied.shape[k] - 0.5 - at[k]) / along[k]
                    first, last = max(first, min(enter, leave)), min(last, max(enter, leave))
                elif not -0.5 <= at[k] <= occupied.shape[k] - 0.5:
                    last = -1.0
            step = RAY_STEP_VOXELS / np.sqrt(along[0] ** 2 + along[1] ** 2 + along[2] ** 2)
            away = first
            while away <= last:
                i = int(np.floor(at[0] + away * along[0] + 0.5))
                j = int(np.floor(at[1] + away * along[1] + 0.5))
                k = int(np.floor(at[2] + away * along[2] + 0.5))
                within = 0 <= i < occupied.shape[0] and 0 <= j < occupied.shape[1] and 0 <= k < occupied.shape[2]
                if within and occupied[i, j, k]:
                    if found[y, x, 0] == 0:
                        found[y, x, 0] = away
                    found[y, x, 1] = away
                away += step
