"""The solid of a piece that stands off: what the silhouettes have room for about it, without what views look through.

Of what is filmed from all around and from above silhouettes leave little room beside the truth, and stereo, of plain dark hair and felt,
is wrong by more. They fill hollows, as between hair and cheek, or two legs and the coat's tails behind: what views look through there
is taken out of them. What hangs beside the body is no thicker than cloth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.avatar.attachments.between_grid_points import between_grid_points
from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.seen_around import SeenAround
from engine.avatar.attachments.silhouettes import Silhouettes
from engine.avatar.attachments.standing_off import (
    MIN_FACE_DISTANCE_METRES,
    MIN_STANDING_OFF_METRES,
    POINT_REACH_METRES,
    StandingPiece,
)
from engine.geometry.mesh.iso_surface import iso_surface
from engine.geometry.point_clouds.point_cloud import PointCloud

GRID_SPACING_METRES = 0.004
"""Metres between the grid's points."""
SOLID_REACH_METRES = 0.03
"""Metres about what stands off, and about what it covers of a head, within which the piece is."""
NAPE_REACH_METRES = 0.008
"""Metres about what stands off a head within which it is beside neck and shoulders: outlines have room below hair, down to a collar that
does not turn with the head."""
SKIN_OVERLAP_METRES, SKIN_COVER_METRES = 0.006, 0.0015
"""Metres that a piece reaches into the skin, so that no gap shows, and by which it lies over the skin that it covers on a
head, where it is whole."""
MIN_LOOKING_VIEWS = 3
"""Views that must look through a place where nothing is."""
FREE_SHARE, DOUBTED_SHARE = 0.5, 0.3
"""Share of the views that tell of a place that look through it where the surface is, and what this share must be less or more
for certainty."""
ROOM_BLUR_GRID_POINTS, FREE_BLUR_GRID_POINTS, END_BLUR_GRID_POINTS = 0.8, 1.5, 3.0
"""Grid points of the Gaussians over what silhouettes and what views say, and over where the piece ends on the skin."""
CLOTH_INSIDE_METRES, CLOTH_OUTSIDE_METRES = 0.015, 0.015
"""Metres that what hangs beside the body reaches within what stereo has of its outside, and out of it: no view tells how thick cloth is,
and outlines, which show it before or behind a leg, do not tell how far away it hangs."""
CLOTH_POINTS = 24
"""Points of a piece's outside that are nearest to a place, whose mean says how far within it is."""
CLOTH_BLOCK_PLACES = 50_000
"""Places that are looked at at once."""
CLOTH_REACH_METRES = 0.06
"""Metres from the nearest point of an outside up to which a piece goes: the holes that stereo leaves in plain cloth."""
MAX_FIELD_DISTANCE_METRES = 4 * GRID_SPACING_METRES
"""Metres: the field says no more than that a place is so far off."""


@dataclass(frozen=True)
class _Grid:
    """Places `GRID_SPACING_METRES` apart.

    origin : (3,) the first of them, metres.
    near : (X, Y, Z) bool, those at which anything can be.
    """

    origin: NDArray[np.float64]
    near: NDArray[np.bool_]

    def spread(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """(X, Y, Z) `values` of the places `near`, and -`MAX_FIELD_DISTANCE_METRES` elsewhere; none beyond it."""
        out = np.full(self.near.shape, -MAX_FIELD_DISTANCE_METRES)
        out[self.near] = np.clip(values, -MAX_FIELD_DISTANCE_METRES, MAX_FIELD_DISTANCE_METRES)
        return out


def solid(
    piece: StandingPiece, body: BodySurface, silhouettes: Silhouettes, seen: SeenAround, cloud: PointCloud
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The closed surface, vertices (V, 3) and triangles (T, 3), of what stands off as a `piece`. `seen` is what views see
    about the body, and `cloud` the points."""
    grid, places, away = _around(np.concatenate([piece.places, body.vertices[piece.covered & body.head]]))
    nearest = body.nearest(places)
    of_head, before_face = body.head[nearest], body.face[nearest]
    off = body.distances(places)
    room = silhouettes.depths(places, of_head).astype(np.float64)
    room = np.where(of_head & piece.covered[nearest], np.maximum(room, SKIN_COVER_METRES - off), room)
    room = np.where(before_face, np.minimum(room, off - MIN_FACE_DISTANCE_METRES), room)
    field = ndimage.gaussian_filter(grid.spread(room), ROOM_BLUR_GRID_POINTS)
    held, ends = _held(seen.votes(places, of_head)), SOLID_REACH_METRES - away
    if body.beside_head(piece.places).mean() > 0.5:
        ends = np.where(of_head, ends, NAPE_REACH_METRES - cKDTree(piece.places).query(places)[0])
    sheet = np.full(len(places), np.inf)
    outside = _outside(piece, body, cloud)
    if len(outside) >= CLOTH_POINTS:
        sheet[~of_head] = between_grid_points(
            np.argwhere(grid.near)[~of_head], lambda at: cloth_depths(grid.origin + GRID_SPACING_METRES * at, outside)
        )
    for said, blur in ((held, FREE_BLUR_GRID_POINTS), (ends, END_BLUR_GRID_POINTS), (sheet, FREE_BLUR_GRID_POINTS)):
        field = np.minimum(field, ndimage.gaussian_filter(grid.spread(said), blur))
    return iso_surface(np.minimum(field, grid.spread(off + SKIN_OVERLAP_METRES)), grid.origin, GRID_SPACING_METRES)


def _held(votes: NDArray[np.integer]) -> NDArray[np.float64]:
    """(N,) metres: positive where views do not look through places, by their votes (N, 2)."""
    share = votes[:, 0] / np.maximum(votes.sum(1), 1)
    said = np.clip((FREE_SHARE - share) / DOUBTED_SHARE, -1, 1)
    return MAX_FIELD_DISTANCE_METRES * np.where(votes[:, 0] >= MIN_LOOKING_VIEWS, said, 1.0)


def _outside(piece: StandingPiece, body: BodySurface, cloud: PointCloud) -> PointCloud:
    """The points of a piece's own surface."""
    near = cKDTree(piece.places).query(cloud.points, distance_upper_bound=POINT_REACH_METRES)[0]
    own = cloud[np.isfinite(near)]
    return own[body.distances(own.points) > MIN_STANDING_OFF_METRES]


def cloth_depths(places: NDArray[np.float64], outside: PointCloud) -> NDArray[np.float64]:
    """(N,) metres by which `places` (N, 3) lie within cloth whose `outside` is known: from `CLOTH_OUTSIDE_METRES` before it to
    `CLOTH_INSIDE_METRES` behind it, and no farther aside than `CLOTH_REACH_METRES`. It has `CLOTH_POINTS` at least."""
    tree = cKDTree(outside.points)
    found = np.empty(len(places))
    for start in range(0, len(places), CLOTH_BLOCK_PLACES):
        some = places[start : start + CLOTH_BLOCK_PLACES]
        away, nearest = (np.asarray(one) for one in tree.query(some, k=CLOTH_POINTS))
        off = some[:, None] - outside.points[nearest]
        outwards = np.einsum("nkd,nkd->nk", off, outside.normals[nearest]).mean(1)
        within = np.minimum(CLOTH_INSIDE_METRES + outwards, CLOTH_OUTSIDE_METRES - outwards)
        found[start : start + CLOTH_BLOCK_PLACES] = np.minimum(within, CLOTH_REACH_METRES - away[:, 0])
    return found


def _around(own: NDArray[np.floating]) -> tuple[_Grid, NDArray[np.float64], NDArray[np.float64]]:
    """A grid about a piece's `own` places (M, 3), its places (N, 3) near those, and how far from them they are."""
    reach = SOLID_REACH_METRES + GRID_SPACING_METRES
    origin = own.min(0) - reach
    shape = np.ceil((own.max(0) + reach - origin) / GRID_SPACING_METRES).astype(int) + 1
    empty = np.ones(shape, np.bool_)
    empty[tuple(np.rint((own - origin) / GRID_SPACING_METRES).astype(int).T)] = False
    off_grid = np.sqrt(3) / 2  # grid points, at most, from a place to the nearest of the grid
    near = np.asarray(ndimage.distance_transform_edt(empty) <= reach / GRID_SPACING_METRES + off_grid)
    places = origin + GRID_SPACING_METRES * np.argwhere(near)
    away = np.asarray(cKDTree(own).query(places, distance_upper_bound=reach)[0])
    within = np.isfinite(away)
    near[near] = within
    return _Grid(origin, near), places[within], away[within]
