"""Where something stands off the fitted skin: places that the silhouettes have, and show beside the body.

Hair and hats are dark and plain, and stereo has holes there, or points inside; their outlines are seen from all around. So it is
silhouettes that say what stands off, and points are told of it by lying there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.silhouettes import Silhouettes
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.multiview.visual_hull import VisualHull

MIN_STANDING_OFF_METRES = 0.012
"""Metres from the skin at which a surface stands off it."""
MIN_FACE_DISTANCE_METRES = 0.02
"""Metres from the skin of a face at which a surface stands off it. A face moves while it is filmed, and stays free of
what does not clearly stand off."""
MAX_WORN_METRES = 0.2
"""Metres from the skin within which anything can be worn."""
VOLUME_SPACING_METRES = 0.006
"""Metres between places about a body that are asked whether they are the person's."""
COARSE_STEP = 3
"""Places along each side of a block whose middle is asked first whether anything of it can be the person's."""
MIN_BESIDE_VIEWS = 4
"""Views that have a place beside the body, at least: what none has there is a hollow that silhouettes do not see."""
MIN_PIECE_CUBIC_METRES = 6e-5
"""Cubic metres of a piece: less are folds of sleeves and buckles."""
POINT_REACH_METRES = 0.012
"""Metres from a piece within which points of the cloud are of it."""
COVER_REACH_METRES, COVER_DEPTH_METRES = 0.03, -0.02
"""Metres from a piece within which it covers the skin, and how far within the skin points may be that are of what covers it."""
DOUBTED_POINTS_SHARE = 0.25
"""Share of a cloud's points, those that fewest views saw, that are not believed."""


@dataclass(frozen=True)
class StandingPiece:
    """What stands off as one.

    places : (N, 3) metres, `VOLUME_SPACING_METRES` apart.
    covered : (S,) bool, the skin's vertices about these, but for the face, and what they enclose, as a brim does a crown.
    """

    places: NDArray[np.float64]
    covered: NDArray[np.bool_]


@dataclass(frozen=True)
class StandingVolume:
    """What silhouettes have about the skin.

    hull : all of it.
    pieces : those parts that stand off, the largest first.
    """

    hull: VisualHull
    pieces: list[StandingPiece]


def well_supported(support: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(N,) which of a cloud's points as many views saw (`support` (N,)) as most of the others: what a few alone say of places off the
    body is mostly room."""
    measured = support[support > 0]
    if not len(measured):
        return np.zeros(len(support), np.bool_)
    return np.asarray(support >= np.quantile(measured, DOUBTED_POINTS_SHARE))


def standing_volume(
    body: BodySurface,
    silhouettes: Silhouettes,
    known: Callable[[NDArray[np.float64]], NDArray[np.bool_]] | None = None,
) -> StandingVolume:
    """What silhouettes have about a body, and what of it stands off, but for what is `known` otherwise: which of places (N, 3)."""
    spacing = VOLUME_SPACING_METRES
    origin = body.vertices.min(0) - MAX_WORN_METRES
    blocks = np.ceil((body.vertices.max(0) + MAX_WORN_METRES - origin) / (COARSE_STEP * spacing)).astype(int) + 1
    shape = COARSE_STEP * blocks
    near = _about(body.vertices, origin, blocks)
    middles = origin + spacing * (COARSE_STEP * np.argwhere(near) + COARSE_STEP // 2)
    reach = np.sqrt(3) * spacing * (COARSE_STEP // 2)  # from a block's middle to its corners
    near[near] = silhouettes.depths(middles, body.beside_head(middles)) > -reach
    cells = np.argwhere(np.kron(near, np.ones((COARSE_STEP,) * 3, np.bool_)))
    places = origin + spacing * cells
    nearest = body.nearest(places)
    inside = silhouettes.depths(places, body.head[nearest]) > 0
    cells, places, nearest = cells[inside], places[inside], nearest[inside]
    occupied, stands = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
    occupied[tuple(cells.T)] = True
    asked = _stand_off(places, body, nearest)
    if known is not None:
        asked[asked] = ~known(places[asked])
    depths, views = silhouettes.depths_beside(places[asked], body.head[nearest[asked]])
    stands[tuple(cells[asked][(depths > 0) & (views >= MIN_BESIDE_VIEWS)].T)] = True
    own = np.argwhere(stands)
    piece = ndimage.label(stands)[0][stands]
    number = np.bincount(piece)
    large = [k for k in np.argsort(-number, kind="stable") if number[k] * spacing**3 > MIN_PIECE_CUBIC_METRES]
    found = [origin + spacing * own[piece == k] for k in large]
    pieces = [StandingPiece(places, _covered(places, body)) for places in found]
    return StandingVolume(VisualHull(occupied, origin, spacing), pieces)


def points_standing_off(
    points: NDArray[np.floating], body: BodySurface, pieces: Sequence[StandingPiece]
) -> NDArray[np.floating]:
    """Those of the `points` (N, 3) of a cloud that are of pieces, or about them of what they cover. Others of a crown that a brim encloses
    hold the skin, which otherwise stands out of the hat."""
    if not pieces:
        return points[:0]
    tree = cKDTree(np.concatenate([piece.places for piece in pieces]))
    away = np.asarray(tree.query(points, distance_upper_bound=COVER_REACH_METRES)[0])
    nearest = body.nearest(points)
    near = (away < POINT_REACH_METRES) & _stand_off(points, body, nearest)
    under = np.any([piece.covered for piece in pieces], axis=0)[nearest]
    under &= np.isfinite(away) & (body.distances(points) > COVER_DEPTH_METRES)
    return points[near | under]


def _covered(places: NDArray[np.float64], body: BodySurface) -> NDArray[np.bool_]:
    """(S,) which vertices of the skin a piece at `places` (N, 3) covers."""
    near = np.isfinite(cKDTree(places).query(body.vertices, distance_upper_bound=COVER_REACH_METRES)[0])
    bare = ~near | body.face | body.own
    kept = body.triangles[bare[body.triangles].all(1)]
    part = connected_components(neighbours(kept, len(bare)), directed=False)[1]
    return np.asarray(part != np.bincount(part).argmax())


def _stand_off(points: NDArray[np.floating], body: BodySurface, nearest: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(N,) which `points` (N, 3) are so far from the skin that they can be of something else. `nearest` (N,): its vertex at each."""
    least = np.where(body.face[nearest], MIN_FACE_DISTANCE_METRES, MIN_STANDING_OFF_METRES)
    return (body.distances(points) > least) & ~body.own[nearest]


def _about(vertices: NDArray[np.float64], origin: NDArray[np.float64], shape: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Which blocks are so near to a vertex (S, 3) that anything there can be worn."""
    side = COARSE_STEP * VOLUME_SPACING_METRES
    empty = np.ones(shape, np.bool_)
    empty[tuple(((vertices - origin) / side).astype(int).T)] = False
    return np.asarray(ndimage.distance_transform_edt(empty) < MAX_WORN_METRES / side)
