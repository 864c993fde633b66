"""Points of a cloud that stand off the fitted skin, where silhouettes have room for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.silhouettes import MIN_BESIDE_VIEWS, Silhouettes
from engine.geometry.point_clouds.cloud_cleaning import crowded_points
from engine.geometry.point_clouds.point_cloud import thinning

MIN_STANDING_OFF_METRES = 0.012
"""Metres from the skin at which a surface stands off it."""
MIN_FACE_DISTANCE_METRES = 0.02
"""Metres from the skin of a face at which a surface stands off it. A face moves while it is filmed, and stays free of
what does not clearly stand off."""
ROOT_REACH_METRES, ROOT_DEPTH_METRES = 0.03, -0.02
"""Metres from what stands off within which other points are of the same piece, although they are near the skin, and how far within it
at most: a piece comes off the body somewhere, and has no holes where the skin comes close."""
DOUBTED_POINTS_SHARE = 0.25
"""Share of a cloud's points, those that fewest views saw, of which no piece is made."""
POINT_SPACING_METRES = 0.004
"""Metres between points that are looked at."""
MEAN_RADIUS_METRES, MAX_MEAN_POINTS = 0.012, 32
"""Metres about a point within which points, so many at most, say in the mean how far off the surface is: single ones
scatter."""
MAX_WORN_METRES = 0.3
"""Metres from the skin within which anything can be worn."""
SWAY_METRES = 0.006
"""Metres by which a silhouette may be beside where the cloud has the person."""
STANDING_OFF_NEIGHBOUR_METRES, MIN_STANDING_OFF_NEIGHBOURS = 0.012, 10
"""Metres within which so many others stand off with a point."""
MIN_PIECE_POINTS = 250
"""Points of a piece that stand off: at their spacing a hand's palm of it."""
ATTACHED_PIECE_GAP_METRES = 0.012
"""Metres that part pieces."""


def well_supported(points: NDArray[np.floating], support: NDArray[np.integer]) -> NDArray[np.floating]:
    """Those of a cloud's `points` (N, 3) that as many views saw (`support` (N,)) as most of the others: what a few alone say of places
    off the body is mostly room."""
    measured = support[support > 0]
    if not len(measured):
        return points[:0]
    return points[support >= np.quantile(measured, DOUBTED_POINTS_SHARE)]


def pieces_standing_off(
    points: NDArray[np.floating], body: BodySurface, silhouettes: Silhouettes
) -> list[NDArray[np.floating]]:
    """Those of the `points` (N, 3) of a cloud that stand off the skin within the silhouettes, with those about their roots, piece
    by piece, the largest first."""
    points = points[thinning(points, POINT_SPACING_METRES)]
    nearest = np.asarray(cKDTree(body.vertices).query(points, distance_upper_bound=MAX_WORN_METRES)[1])
    asked = np.flatnonzero(nearest < len(body.vertices))
    asked = asked[~body.own[nearest[asked]]]
    if not len(asked):
        return []
    points, face = points[asked], body.face[nearest[asked]]
    off = _mean_about(points, body.distances(points))
    stands = np.flatnonzero(off > np.where(face, MIN_FACE_DISTANCE_METRES, MIN_STANDING_OFF_METRES))
    depths, views = silhouettes.depths(points[stands])
    stands = stands[(depths > -SWAY_METRES) & (views >= MIN_BESIDE_VIEWS)]
    stands = stands[crowded_points(points[stands], STANDING_OFF_NEIGHBOUR_METRES, MIN_STANDING_OFF_NEIGHBOURS)]
    if not len(stands):
        return []
    about = cKDTree(points[stands]).query(points, distance_upper_bound=ROOT_REACH_METRES)[0] < np.inf
    own = about & ~face & (off > ROOT_DEPTH_METRES)
    own[stands] = True
    chosen = np.flatnonzero(own)
    piece = _pieces(points[chosen])
    number = np.bincount(piece, np.isin(chosen, stands))
    return [points[chosen[piece == k]] for k in np.argsort(-number, kind="stable") if number[k] >= MIN_PIECE_POINTS]


def _mean_about(points: NDArray[np.floating], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N,) the mean of what the points (N, 3) around each say."""
    distance, which = cKDTree(points).query(
        points, min(MAX_MEAN_POINTS, len(points)), distance_upper_bound=MEAN_RADIUS_METRES
    )
    within = np.isfinite(distance).reshape(len(points), -1)
    which = np.where(within, np.reshape(which, within.shape), 0)
    return np.asarray((np.where(within, values[which], 0)).sum(1) / within.sum(1))


def _pieces(points: NDArray[np.floating]) -> NDArray[np.intp]:
    """(N,) which piece each of the points (N, 3) is of, from 0: those that an empty cell of `ATTACHED_PIECE_GAP_METRES` parts."""
    if not len(points):
        return np.zeros(0, np.intp)
    cells = np.floor((points - points.min(0)) / ATTACHED_PIECE_GAP_METRES).astype(int)
    grid = np.zeros(cells.max(0) + 1, np.bool_)
    grid[tuple(cells.T)] = True
    return np.asarray(ndimage.label(grid, np.ones((3, 3, 3)))[0][tuple(cells.T)] - 1, np.intp)
