"""A surface laid on a cloud of points: near its closest points, and otherwise bent as little as can be.

Source: equation 1 of S. Wenninger, J. Achenbach, A. Bartl, M. E. Latoschik, M. Botsch, Realistic Virtual Humans from
Smartphone Videos, VRST 2020; minimised as in J. Achenbach, T. Waltemate, M. E. Latoschik, M. Botsch, Fast generation of
realistic virtual humans, VRST 2017: by turns for the places of vertices, the turns of edges and the closest points. Beyond the
paper, what points about a place scatter takes from what they count (`engine.geometry.registration.point_noise`): where a cloud is
noise, the surface stays as smooth as it was at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.geometry.deformation.handles import surface_points
from engine.geometry.deformation.hinge_laplacian import HingeLaplacian
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_areas, vertex_normals
from engine.geometry.registration.point_noise import point_noise

MIN_MATCH_NORMAL_COSINE = 0.2
"""Between the normals of a point and of the surface there: what faces another way is another side of the body."""
ROUNDS_PER_STEP = 3
"""Of each step: new closest points, new turns, new places."""
WEIGHED_STEPS = 2
"""The last steps, in which points count by how much those around them scatter; before, the surface is too stiff to tell."""
CONTACT_WEIGHT = 1e4
"""Of what is left between points that touch, against all points of the cloud: nothing pulls them apart."""
FREE_VERTEX_WEIGHT = 1e-14
"""What holds vertices of no hinge where they are at rest, against any other pull."""


@dataclass(frozen=True)
class ElasticSurface:
    """What is laid on the points.

    rest : (V, 3) metres: how it likes to be bent.
    triangles : (T, 3) vertex numbers.
    matched : (T,) bool: those that points are of.
    stiffness : (V,) by how much more than others the hinges at a vertex keep their bend.
    trust : (V,) in [0, 1]: what points near a vertex count.
    held : (V,) bool, those that stay where they are at first; none by default.
    point_sigma : (V,) or one for all, metres by which points may scatter before they count less; as many as they like
        by default.
    anchor : what it counts that the surface stays where it is at rest, where all points together count 1. Bending alone
        lets a limb without points swing about the joint at which the points end.
    contact : (C, V) sparse, by default none: each row is a point of the surface minus another that it touches, in weights of
        vertices; times the vertices, it is what is between the two.
    """

    rest: NDArray[np.float64]
    triangles: NDArray[np.integer]
    matched: NDArray[np.bool_]
    stiffness: NDArray[np.float64]
    trust: NDArray[np.float64]
    held: NDArray[np.bool_] | None = None
    point_sigma: NDArray[np.float64] | float = np.inf
    anchor: float = 0.0
    contact: sp.csr_array | None = None


@dataclass(frozen=True)
class SurfaceLandmarks:
    """Points of the surface with known places: `rows` (L, V) sparse, each the weights of vertices, summing to one, and
    `places` (L, 3) metres; `weights` (L,), by default ones: what each counts."""

    rows: sp.csr_array
    places: NDArray[np.float64]
    weights: NDArray[np.float64] | None = None

    def pulls(self) -> tuple[sp.csr_array, NDArray[np.float64]]:
        """Their part of the normal equations, (V, V) sparse and (V, 3), as the mean over all."""
        weights = np.ones(len(self.places)) if self.weights is None else self.weights
        weighed = sp.csr_array(self.rows.T @ sp.diags_array(weights / max(len(weights), 1)))
        return sp.csr_array(weighed @ self.rows), np.asarray(weighed @ self.places)


@dataclass(frozen=True)
class Step:
    """Weights of equation 1 while so many `ROUNDS_PER_STEP` last, in metres: `regularisation` grows with the fourth power of the
    unit of length. `gate`: metres from which on points pull no more (J. Tukey's weight)."""

    regularisation: float
    landmarks: float
    gate: float


def geometric_steps(
    count: int, regularisation: tuple[float, float], landmarks: tuple[float, float], gate: tuple[float, float]
) -> list[Step]:
    """So many steps, each quantity from its first value to its last by equal factors."""
    series = [np.geomspace(*ends, count) for ends in (regularisation, landmarks, gate)]
    return [Step(float(stiff), float(drawn), float(reach)) for stiff, drawn, reach in zip(*series, strict=True)]


def lay_on_points(
    surface: ElasticSurface,
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    steps: Sequence[Step],
    landmarks: SurfaceLandmarks | None = None,
    start: NDArray[np.floating] | None = None,
) -> NDArray[np.float64]:
    """The vertices (V, 3) float64 metres of the surface, laid on `points` (N, 3) metres with unit `normals` (N, 3).

    `start` (V, 3): where it is first, by default at rest. Raises ValueError where no point is near the surface and there are
    no landmarks.
    """
    hinges = HingeLaplacian(surface.rest, surface.triangles)
    shares = hinges.areas * surface.stiffness[hinges.hinges].max(1) / hinges.areas.sum()
    weighed = sp.csr_array(hinges.operator.T @ sp.diags_array(shares))
    bending = sp.csr_array(weighed @ hinges.operator)
    touching = surface.contact
    contact = None if touching is None else CONTACT_WEIGHT * sp.csr_array(touching.T @ touching)
    areas = vertex_areas(surface.rest, surface.triangles)
    anchors = FREE_VERTEX_WEIGHT + surface.anchor * areas / areas.sum()
    vertices = surface.rest.copy() if start is None else np.asarray(start, np.float64).copy()
    free = np.ones(len(vertices), np.bool_) if surface.held is None else ~surface.held
    system = _SameSparsity()
    trust = surface.trust
    for number, step in enumerate(steps):
        if np.isfinite(surface.point_sigma).any() and number >= len(steps) - WEIGHED_STEPS:
            matched = np.asarray(surface.triangles)[surface.matched]
            scatter = point_noise(vertices, matched, points, normals, MIN_MATCH_NORMAL_COSINE)
            trust = surface.trust / (1 + (scatter / surface.point_sigma) ** 2)
        for _ in range(ROUNDS_PER_STEP):
            matrix, right = _matched_points(surface, trust, vertices, points, normals, step.gate)
            if landmarks is not None:
                drawn, towards = landmarks.pulls()
                matrix = matrix + step.landmarks * drawn
                right = right + step.landmarks * towards
            elif not matrix.nnz:
                raise ValueError("no point of the cloud is near the surface")
            bent = weighed @ hinges.turned(hinges.rotations(vertices))
            whole = matrix + step.regularisation * bending + sp.diags_array(anchors)
            whole = sp.csr_array(whole if contact is None else whole + contact)[free]
            right = right + step.regularisation * bent + anchors[:, None] * surface.rest
            vertices[free] = system.solve(sp.csc_array(whole[:, free]), right[free] - whole[:, ~free] @ vertices[~free])
    return vertices


def _matched_points(
    surface: ElasticSurface,
    trust: NDArray[np.float64],
    vertices: NDArray[np.float64],
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    gate: float,
) -> tuple[sp.csr_array, NDArray[np.float64]]:
    """The normal equations of the closeness term: (V, V) sparse, and (V, 3); `trust` (V,): what points near a vertex count now."""
    candidates = np.asarray(surface.triangles)[surface.matched]
    nearest = closest_points(points, vertices, candidates)
    corners = candidates[nearest.triangle]
    own = vertex_normals(vertices, surface.triangles)[corners]
    facing = np.einsum("nk,nkc,nc->n", nearest.barycentrics, own, normals) > MIN_MATCH_NORMAL_COSINE
    weights = facing * np.maximum(1 - (nearest.distance / gate) ** 2, 0) ** 2
    total = (weights * np.einsum("nk,nk->n", nearest.barycentrics, surface.trust[corners])).sum()
    weights *= np.einsum("nk,nk->n", nearest.barycentrics, trust[corners])
    used = weights > 0
    count = len(vertices)
    if not total:
        return sp.csr_array((count, count)), np.zeros((count, 3))
    rows = surface_points(candidates, nearest.triangle[used], nearest.barycentrics[used], count)
    weighed = sp.csr_array(rows.T @ sp.diags_array(weights[used] / total))
    return sp.csr_array(weighed @ rows), np.asarray(weighed @ np.asarray(points, np.float64)[used])


class _SameSparsity:
    """Systems with one pattern, one after the other: the order in which they are factorised is sought for the first."""

    def __init__(self) -> None:
        self._order: NDArray[np.intp] | None = None

    def solve(self, matrix: sp.csc_array, right: NDArray[np.float64]) -> NDArray[np.float64]:
        options = {"SymmetricMode": True}
        if self._order is None:
            factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
            self._order = np.argsort(factors.perm_c)
            return np.asarray(factors.solve(right))
        order = self._order
        factors = splu(
            sp.csc_array(matrix[order][:, order]), permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options
        )
        solved = np.empty_like(right)
        solved[order] = factors.solve(right[order])
        return solved
