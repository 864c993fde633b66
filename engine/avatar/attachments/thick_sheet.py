"""The solid of a piece that stands off: a sheet through its points, as thick as cloth or felt, that ends where silhouettes end.

Points say where the sheet is, and silhouettes how far it goes: stereo scatters at an outline, where masks are sharp.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.silhouettes import Silhouettes
from engine.avatar.attachments.standing_off import MIN_FACE_DISTANCE_METRES
from engine.geometry.mesh.iso_surface import iso_surface
from engine.geometry.point_clouds.point_sheet import PointSheet, sheet_through

GRID_SPACING_METRES = 0.003
"""Metres between the grid's points."""
SHEET_THICKNESS_METRES = 0.006
"""Metres that a sheet is thick, as of felt: two of the grid's spacing."""
SHEET_RADIUS_METRES, SHEET_ROUNDS, SHEET_SPACING_METRES = 0.02, 4, 0.003
"""Of the sheet through the points: metres about each that make it smooth, rounds, and metres from point to point."""
SHEET_EXTENSION_METRES = 0.015
"""Metres by which the sheet goes on beyond its points, if silhouettes let it."""
SILHOUETTE_TOLERANCE_METRES, TOLERANCE_LOSS_PER_METRE = 0.003, 0.5
"""Metres by which silhouettes may be too small, and how many of them less where no point is, for each metre from the points."""
SKIN_COVER_METRES, SKIN_OVERLAP_METRES = 0.0025, 0.006
"""Metres that a piece reaches over the skin where it comes close, so that it is whole, and into it, so that no gap shows."""
OUTLINE_BLUR_GRID_POINTS, SHEET_BLUR_GRID_POINTS = 2.0, 0.7
"""Grid points of the Gaussians over where the sheet ends, and over all."""
MAX_FIELD_DISTANCE_METRES = 4 * GRID_SPACING_METRES
"""Metres: the field says no more than that a place is so far off."""


@dataclass(frozen=True)
class _Grid:
    """`shape` points from `origin`, `GRID_SPACING_METRES` apart; `near` (X, Y, Z) bool: those at which anything can be."""

    origin: NDArray[np.float64]
    near: NDArray[np.bool_]

    def spread(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """(X, Y, Z) `values` of the places `near`, and -`MAX_FIELD_DISTANCE_METRES` elsewhere; none beyond it."""
        out = np.full(self.near.shape, -MAX_FIELD_DISTANCE_METRES)
        out[self.near] = np.clip(values, -MAX_FIELD_DISTANCE_METRES, MAX_FIELD_DISTANCE_METRES)
        return out


def thick_sheet(
    points: NDArray[np.floating], body: BodySurface, silhouettes: Silhouettes
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The closed surface, vertices (V, 3) and triangles (T, 3), of what the `points` (N, 3) are of; both empty where they
    make no sheet. What lies between sheet and skin, if nothing leads there, is filled."""
    sheet = sheet_through(points, SHEET_RADIUS_METRES, SHEET_ROUNDS, SHEET_SPACING_METRES)
    if not len(sheet.points):
        return np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    grid, places = _around(sheet)
    across, along = sheet.distances(places)
    off = body.distances(places)
    free = np.where(body.before_face(places), off - MIN_FACE_DISTANCE_METRES, np.inf)
    room = silhouettes.depths(places)[0] + SILHOUETTE_TOLERANCE_METRES - TOLERANCE_LOSS_PER_METRE * along
    ends = ndimage.gaussian_filter(
        grid.spread(np.minimum(np.minimum(SHEET_EXTENSION_METRES - along, room), free)), OUTLINE_BLUR_GRID_POINTS
    )
    field = np.minimum(grid.spread(np.maximum(SHEET_THICKNESS_METRES / 2 - across, SKIN_COVER_METRES - off)), ends)
    skin = grid.spread(-off) > 0
    enclosed = ndimage.binary_fill_holes((field > 0) | skin) & ~skin
    field = np.where(enclosed, np.maximum(field, SHEET_THICKNESS_METRES / 2), field)
    field = np.minimum(ndimage.gaussian_filter(field, SHEET_BLUR_GRID_POINTS), grid.spread(off + SKIN_OVERLAP_METRES))
    return iso_surface(field, grid.origin, GRID_SPACING_METRES)


def _around(sheet: PointSheet) -> tuple[_Grid, NDArray[np.float64]]:
    """A grid about a sheet, and its places (N, 3) near it."""
    reach = SHEET_EXTENSION_METRES + 2 * GRID_SPACING_METRES
    origin = sheet.points.min(0) - reach - GRID_SPACING_METRES
    shape = np.ceil((sheet.points.max(0) + reach + GRID_SPACING_METRES - origin) / GRID_SPACING_METRES).astype(int) + 1
    places = origin + GRID_SPACING_METRES * np.moveaxis(np.indices(shape), 0, -1)
    away = cKDTree(sheet.points).query(places.reshape(-1, 3), distance_upper_bound=reach)[0]
    near = np.isfinite(away).reshape(tuple(shape))
    return _Grid(origin, near), places[near]
