"""Skinning weights by heat that bones give off, within an outline.

I. Baran, J. Popović, Automatic rigging and animation of 3D characters, SIGGRAPH 2007, section 4: each point is heated by the bone nearest
to it, the more the nearer it is, and heat spreads through the figure: (L + H) w = H p. Here the figure is an area of pixels, and
nearness is counted within it, so that no hand heats the hip that it is drawn beside.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import splu

from engine.geometry.graph_cut import grid_edges
from engine.imaging.masks.mask_distance import distance_to

HEAT_COEFFICIENT = 1.0
"""The paper's c: heat that reaches a point is this by the square of its distance."""
MIN_BONE_DISTANCE_PIXELS = 1.0
"""Pixels from a bone within which a point is no nearer."""


def bones_nearby(mask: NDArray[np.bool_], bones: Sequence[NDArray[np.floating]]) -> NDArray[np.float32]:
    """How far (B, H, W) each bone is from each pixel, on ways within the figure `mask` (H, W); infinite where none leads, and beside the
    figure. `bones`: polylines (n, 2), pixels; those that leave the figure begin at its pixel nearest to them."""
    edges, lengths = grid_edges(mask)
    count = int(mask.sum())
    graph = csr_matrix((lengths, (edges[:, 0], edges[:, 1])), (count, count))
    number = np.full(mask.shape, -1)
    number[mask] = np.arange(count)
    pixels = np.argwhere(mask)[:, ::-1]
    far = np.full((len(bones), *mask.shape), np.inf, np.float32)
    for bone, line in enumerate(bones):
        drawn = np.zeros(mask.shape, np.uint8)
        cv2.polylines(drawn, [np.rint(line).astype(np.int32)], False, (1,))
        sources = number[(drawn > 0) & mask]
        if not len(sources):
            away = np.linalg.norm(pixels - np.asarray(line).mean(0), axis=1)
            sources = np.array([int(away.argmin())])
        far[bone][mask] = dijkstra(graph, directed=False, indices=sources, min_only=True)
    return far


def heat_weights(
    mask: NDArray[np.bool_], nearest: NDArray[np.integer], far: NDArray[np.floating], count: int
) -> NDArray[np.float32]:
    """Weights (H, W, B) of `count` bones in the figure `mask` (H, W), summing to one; 0 beside it. `nearest` (H, W): the bone that heats each
    pixel; `far` (H, W): how far it is, pixels."""
    edges, lengths = grid_edges(mask)
    pixels = int(mask.sum())
    conductance = 1 / lengths**2
    a, b = edges.T
    spread = coo_matrix(
        (np.tile(-conductance, 2), (np.concatenate([a, b]), np.concatenate([b, a]))), (pixels, pixels)
    ).tocsr()
    laplacian = spread - diags(np.asarray(spread.sum(1)).ravel())
    heat = HEAT_COEFFICIENT / np.maximum(far[mask].astype(np.float64), MIN_BONE_DISTANCE_PIXELS) ** 2
    solved = splu((laplacian + diags(heat)).tocsc())
    weights = np.zeros((*mask.shape, count), np.float32)
    own = nearest[mask]
    for bone in np.unique(own):
        weights[mask, bone] = np.clip(solved.solve(heat * (own == bone)), 0, 1)
    total = weights[mask].sum(1, keepdims=True)
    weights[mask] /= np.maximum(total, 1e-9)
    return weights


def thickness(mask: NDArray[np.bool_], half: float, within: float) -> NDArray[np.float32]:
    """Half the thickness (H, W) of a cut-out `mask` (H, W) that is round at its edge: a quarter of an ellipse that reaches `half` at
    `within` pixels from the edge."""
    share = np.clip(distance_to(~mask) / within, 0, 1)
    return np.where(mask, half * np.sqrt(1 - (1 - share) ** 2), 0).astype(np.float32)
