"""Where on the picture the sides of a body take their colours from.

Seen from its side, a body shows what the picture hardly has: a surface that turns away has a pixel for ten of its own
width, and that one is mixed with what is behind the person. Stretched over the side it makes bands. So the picture is
folded over at the outline: from the last whole pixel on, colours run back inward, nearly at the pace of the surface.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from engine.character.surface.front_and_back import ClosedMesh

MAX_FOLD_PIXELS = 8.0
"""Pixels inward at which a fold ends, at most."""
MIN_FOLD_SLOPE = 0.5
"""Of each step inward, what must be gained in distance from the border: the fold ends at the middle of a limb."""
FOLD_SHARE = 0.6
"""The share of a fold that is taken: it costs the front its outermost pixels, and the rest of it is not missed at the side."""
FOLD_SMOOTHING_ROUNDS = 4
"""How often the folds' directions and lengths are smoothed along the border."""


def places_on_the_picture(mesh: ClosedMesh, barred: NDArray[np.bool_], body_layer: int) -> NDArray[np.float64]:
    """For each vertex the pixel (V, 2) of the grid, x and y, whose colour it takes: its own, or on the border that of
    the fold. Vertices of the border at one place take one pixel, of the front and of the back. No fold of the body's
    goes where it is `barred` (h, w): front and back differ there, or it would show an ear twice. What has `places`
    keeps them."""
    own = mesh.vertices[:, :2]
    at, point = _points(mesh)
    inward, length = _folds(mesh, at, point)
    start = at[:, :2]
    folded = start.copy()
    for layer in np.unique(mesh.layer[mesh.rim]):
        here = np.unique(point[mesh.rim & (mesh.layer == layer)])
        where = barred if layer == body_layer else np.zeros_like(barred)
        folded[here] = _followed(start[here], inward[here], length[here], where)
    places = own.copy()
    places[mesh.rim] = (start + FOLD_SHARE * (folded - start))[point[mesh.rim]]
    elsewhere = np.isfinite(mesh.places[:, 0])
    places[elsewhere] = mesh.places[elsewhere]
    return places


def _points(mesh: ClosedMesh) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """The middles (N, 3) of the places where vertices lie above one another, of one part; and each vertex' number."""
    key = np.column_stack([mesh.vertices[:, :2], mesh.layer])
    _, point = np.unique(key, axis=0, return_inverse=True)
    point = point.ravel()
    count = np.bincount(point)
    at = np.stack([np.bincount(point, mesh.vertices[:, axis]) / count for axis in range(3)], 1)
    return at, np.asarray(point, np.intp)


def _folds(
    mesh: ClosedMesh, at: NDArray[np.float64], point: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """For each point (N, 3) the direction (N, 2) that leads inward from the border, and how far along it the fold ends,
    (N,): as far inward of the next vertices as these are away on the surface. 0 off the border."""
    count = len(at)
    edges = np.concatenate([mesh.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2))])
    out = edges[mesh.rim[edges[:, 0]] & ~mesh.rim[edges[:, 1]]]
    step = mesh.vertices[out[:, 1]] - mesh.vertices[out[:, 0]]
    here = point[out[:, 0]]
    met = np.maximum(np.bincount(here, minlength=count), 1)
    inward = np.stack([np.bincount(here, step[:, axis], count) / met for axis in range(2)], 1)
    flat = np.bincount(here, np.linalg.norm(step[:, :2], axis=1), count) / met
    length = flat + np.bincount(here, np.linalg.norm(step, axis=1), count) / met
    along = edges[mesh.rim[edges].all(1)]
    beside = csr_matrix((np.ones(len(along)), (point[along[:, 0]], point[along[:, 1]])), (count, count))
    beside.setdiag(1)
    share = 1 / np.maximum(np.asarray(beside.sum(1)).ravel(), 1)
    for _ in range(FOLD_SMOOTHING_ROUNDS):
        inward, length = share[:, None] * (beside @ inward), share * (beside @ length)
    size = np.linalg.norm(inward, axis=1)
    inward /= np.maximum(size, 1e-9)[:, None]
    return inward, np.where(size > 1e-6, np.minimum(length, MAX_FOLD_PIXELS), 0)


def _followed(
    start: NDArray[np.float64], inward: NDArray[np.float64], length: NDArray[np.float64], barred: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """The ends (n, 2) of the folds that begin at `start` (n, 2), on the border of one part: they end where they come to the
    part's middle, or to a pixel that is `barred` (h, w)."""
    border = cKDTree(start)
    reached = np.zeros(len(start))
    going = np.ones(len(start), np.bool_)
    before = np.zeros(len(start))
    for step in range(1, int(MAX_FOLD_PIXELS) + 1):
        far = np.minimum(step, length)
        ahead = start + far[:, None] * inward
        away = np.asarray(border.query(ahead)[0])
        x, y = np.clip(np.rint(ahead), 0, [barred.shape[1] - 1, barred.shape[0] - 1]).astype(int).T
        going &= (away - before >= MIN_FOLD_SLOPE * (far - reached)) & (far > reached) & ~barred[y, x]
        reached[going], before[going] = far[going], away[going]
        if not going.any():
            break
    return np.asarray(start + reached[:, None] * inward)
