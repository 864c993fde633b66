"""A piece of surface laid flat in a disk, without folds, its triangles of like size and shape.

Source: W. T. Tutte, How to draw a graph, Proc. London Math. Society 13, 1963, for a map without folds; M. Rabinovich, R. Poranne,
D. Panozzo, O. Sorkine-Hornung, Scalable locally injective mappings, ACM TOG 36, 2017, for making its triangles alike without
turning one over.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.geometry.mesh.adjacency import neighbours

MAX_DISK_STEPS = 60
"""Steps in which triangles are made alike, at most."""
MIN_ENERGY_GAIN_SHARE = 1e-4
"""The share of the energy that a step must gain for another to follow."""
DISK_DAMPING_SHARE = 1e-8
"""What keeps the system of a step regular, as a share of its mean diagonal."""
SAFE_SHARE = 0.8
"""Of the way to where a triangle would be turned over, how far a step leads at most."""


def injective_disk(corners: NDArray[np.integer], edge: NDArray[np.floating], free: int) -> NDArray[np.float64]:
    """(free, 2): where the inner vertices are of a surface `corners` (T, 3) whose vertices are the `free` inner ones and then
    those of its border, which lie at `edge` (L, 2), on a convex curve.

    The symmetric Dirichlet energy from equilateral triangles is made small. Raises ValueError where Tutte's map has no area
    somewhere: a vertex has too few neighbours.
    """
    triangles = np.asarray(corners, np.intp)
    places = _tutte(triangles, np.asarray(edge, np.float64), free)
    reference = _gradients(places, triangles)
    if (np.linalg.det(_jacobians(places, triangles, reference)) <= 0).any():
        triangles = triangles[:, ::-1]  # the border runs the other way
    if (np.linalg.det(_jacobians(places, triangles, reference)) <= 0).any():
        raise ValueError("the surface is no disk whose inner vertices hang together")
    before = _energy(places, triangles, reference)
    for _ in range(MAX_DISK_STEPS):
        places = _step(places, triangles, reference, free)
        now = _energy(places, triangles, reference)
        if before - now < MIN_ENERGY_GAIN_SHARE * before:
            break
        before = now
    return places[:free]


def _tutte(corners: NDArray[np.intp], edge: NDArray[np.float64], free: int) -> NDArray[np.float64]:
    """(V, 2): each inner vertex in the middle of its neighbours."""
    beside = neighbours(corners, free + len(edge))
    mean = sp.csr_array(sp.diags_array(1 / beside.sum(1)) @ beside)[:free]
    inner = splu(sp.csc_array(sp.eye_array(free) - mean[:, :free])).solve(mean[:, free:] @ edge)
    return np.concatenate([inner, edge])


def _gradients(places: NDArray[np.float64], corners: NDArray[np.intp]) -> NDArray[np.float64]:
    """(3, 2) the gradients of the three corners' hat functions on an equilateral triangle with the mean area in the disk."""
    area = np.abs(np.linalg.det(_sides(places, corners))).mean() / 2
    side = np.sqrt(4 / np.sqrt(3) * area)
    inverse = np.linalg.inv(side * np.array([[1, 0.5], [0, np.sqrt(3) / 2]]))
    return np.stack([-inverse.sum(0), inverse[0], inverse[1]])


def _sides(places: NDArray[np.float64], corners: NDArray[np.intp]) -> NDArray[np.float64]:
    first = places[corners[:, 0]]
    return np.stack([places[corners[:, 1]] - first, places[corners[:, 2]] - first], 2)


def _jacobians(
    places: NDArray[np.float64], corners: NDArray[np.intp], reference: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(T, 2, 2) how the equilateral triangle became each."""
    return np.einsum("tka,kb->tab", places[corners], reference)


def _energy(places: NDArray[np.float64], corners: NDArray[np.intp], reference: NDArray[np.float64]) -> float:
    """The symmetric Dirichlet energy; boundless where a triangle is turned over."""
    jacobian = _jacobians(places, corners, reference)
    determinant = np.linalg.det(jacobian)
    if determinant.min() <= 0:
        return np.inf
    return float(((jacobian**2).sum((1, 2)) * (1 + determinant**-2)).sum())


def _step(
    places: NDArray[np.float64], corners: NDArray[np.intp], reference: NDArray[np.float64], free: int
) -> NDArray[np.float64]:
    """The vertices after one step: towards where triangles are turned copies of the reference, each direction weighted by what it
    costs (section 3 of the paper), as far as none is turned over."""
    jacobian = _jacobians(places, corners, reference)
    left, stretch, right = np.linalg.svd(jacobian)
    turn = left @ right
    away = stretch - 1
    flat = np.abs(away) < 1e-6
    cost = np.sqrt(np.where(flat, 4.0, (stretch - stretch**-3) / np.where(flat, 1.0, away)))
    metric = (left * cost[:, None, :]) @ left.transpose(0, 2, 1)
    target = metric @ turn
    count = len(places)
    rows = np.arange(len(corners)).repeat(3)
    slopes = [
        sp.csr_array((np.tile(reference[:, b], len(corners)), (rows, corners.ravel())), (len(corners), count))
        for b in (0, 1)
    ]
    blocks = [[sp.diags_array(metric[:, i, a]) @ slopes[b] for a in (0, 1)] for i in (0, 1) for b in (0, 1)]
    system = sp.csr_array(sp.block_array(blocks))
    wanted = np.concatenate([target[:, i, b] for i in (0, 1) for b in (0, 1)])
    columns = np.concatenate([np.arange(free), count + np.arange(free)])
    flat_places = places.T.ravel()
    left_over = wanted - system @ flat_places
    own = system[:, columns]
    normal = sp.csc_array(own.T @ own)
    normal = normal + DISK_DAMPING_SHARE * normal.diagonal().mean() * sp.eye_array(2 * free)
    moved = np.zeros_like(places)
    moved[:free] = splu(sp.csc_array(normal)).solve(own.T @ left_over).reshape(2, free).T
    share = min(1.0, SAFE_SHARE * _until_turned_over(places, moved, corners))
    now = _energy(places, corners, reference)
    while share > 1e-6 and _energy(places + share * moved, corners, reference) > now:
        share /= 2
    return places + share * moved if share > 1e-6 else places


def _until_turned_over(places: NDArray[np.float64], moved: NDArray[np.float64], corners: NDArray[np.intp]) -> float:
    """The least share of a step at which a triangle has no area."""
    start, change = _sides(places, corners), _sides(moved, corners)
    c = np.linalg.det(start)
    a = np.linalg.det(change)
    b = np.linalg.det(start + change) - a - c
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(b * b - 4 * a * c, 0))
        q = -(b + np.where(b >= 0, 1.0, -1.0) * root) / 2
        both = np.stack([q / a, c / q])
    both[:, b * b < 4 * a * c] = np.inf
    both = both[np.isfinite(both) & (both > 0)]
    return float(both.min(initial=np.inf))
