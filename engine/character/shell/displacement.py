"""The template displaced across the view, as smoothly as the outlines permit.

The energy is biharmonic, as for example in M. Botsch, L. Kobbelt, An intuitive framework for real-time freeform modeling,
SIGGRAPH 2004, with matches of points to lines, which are found anew while it is made softer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, cg, splu

from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS
from engine.character.shell.matching import match_outlines
from engine.character.shell.outlines import Outlines
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.mesh.surface import vertex_areas, vertex_normals

STIFFNESS_SCHEDULE = ((400.0, 0.05), (100.0, 0.06), (25.0, 0.07), (6.0, 0.07), (2.0, 0.06), (0.5, 0.05))
"""How stiff the surface is in each round, and how far within the outline its rim may be, as a share of the person's height."""
EXTREMITY_STIFFNESS_FACTOR, HEAD_STIFFNESS_FACTOR = 25.0, 3.0
"""By how much more hands and feet, and the head, are stiff."""
STRETCHED_EXTREMITY_COST = 6.0
"""What a stretched hand or foot costs: without it both are drawn out linearly for nothing."""
FINAL_STIFFNESS, FINAL_ROUNDS = (1.0, 0.6), 2
"""By how much more hands and feet, and the head, are stiff in some last rounds, and how many these are. What is left to
go is the shape of shoes, cuffs and fingers, not where they are."""
PIXEL_ANCHOR_WEIGHT, EAR_ANCHOR_WEIGHT, HAND_ANCHOR_WEIGHT, FOOT_ANCHOR_WEIGHT = 1e-5, 0.02, 5e-4, 1e-4
"""What a square pixel of surface costs for staying not where it was: everywhere, and of ears, hands and feet."""
DOUBTED_MATCH_SHARE = 0.035
"""Share of the height from which on a match is doubted."""
KNOWN_POINT_WEIGHT = 3.0
"""What a known point counts, in points of an outline."""
CONJUGATE_GRADIENT_STEPS, CONJUGATE_GRADIENT_TOLERANCE = 40, 1e-3
"""Of conjugate gradients, at most; and the share of the error that may be left."""


@dataclass(frozen=True)
class KnownPoints:
    """Vertices (N,) whose places (N, 2) in the picture are known."""

    vertices: NDArray[np.intp]
    places: NDArray[np.float64]


@dataclass(frozen=True)
class Displaced:
    """`vertices` (V, 3) after displacement across the view, and which of them (N,) lie on the points (N,) of the outlines."""

    vertices: NDArray[np.float64]
    matched: NDArray[np.intp]
    points: NDArray[np.intp]


def displace(mesh: TemplateMesh, template: NDArray[np.float64], outlines: Outlines, known: KnownPoints) -> Displaced:
    """Displace `template` (V, 3) in picture space, so that the rims of its parts come to lie on their outlines."""
    tight, loose = (
        _Energy(mesh, template, EXTREMITY_STIFFNESS_FACTOR, STRETCHED_EXTREMITY_COST),
        _Energy(mesh, template, *FINAL_STIFFNESS),
    )
    pictured = template.copy()
    move = np.zeros((len(template), 2))
    vertex = point = np.zeros(0, np.intp)
    for energy, stiffness, inwards in (
        *((tight, *each) for each in STIFFNESS_SCHEDULE),
        *((loose, *STIFFNESS_SCHEDULE[-1]),) * FINAL_ROUNDS,
    ):
        normals = -vertex_normals(pictured, mesh.triangles).astype(np.float64)
        vertex, point = match_outlines(mesh, template, pictured, normals, outlines, inwards)
        outward = outlines.normals[point]
        off = ((outlines.points[point] - pictured[vertex, :2]) * outward).sum(1)
        weight = outlines.weight[point] / (1 + (off / (DOUBTED_MATCH_SHARE * GRID_HEIGHT_PIXELS)) ** 2)
        goal = ((outlines.points[point] - template[vertex, :2]) * outward).sum(1)
        move = energy.least(stiffness, _Lines(vertex, outward, goal, weight), known, move)
        pictured[:, :2] = template[:, :2] + move
    return Displaced(pictured, vertex, point)


@dataclass(frozen=True)
class _Lines:
    """Displacements of vertices along one normal each.

    vertices : (N,) which.
    normals : (N, 2) along which.
    goals : (N,) how far they should go.
    weights : (N,) what that counts.
    """

    vertices: NDArray[np.intp]
    normals: NDArray[np.float64]
    goals: NDArray[np.float64]
    weights: NDArray[np.float64]


class _Energy:
    """What a displacement of the template costs."""

    def __init__(self, mesh: TemplateMesh, template: NDArray[np.float64], stiffer: float, held: float) -> None:
        self.template, count = template, len(template)
        laplacian = cotangent_laplacian(template, mesh.triangles)
        area = vertex_areas(template, mesh.triangles)
        area = np.maximum(area, 0.02 * np.median(area))
        extremity = np.clip(1.5 * mesh.hand, 0, 1) + np.clip(1.5 * mesh.foot, 0, 1)
        stiff = np.where(mesh.head > 0.5, HEAD_STIFFNESS_FACTOR, 1.0) * (1 + stiffer * extremity)
        self.bending = sp.csc_array(laplacian @ sp.diags_array(stiff / area) @ laplacian)
        own = extremity[mesh.triangles].min(1) > 0.5
        stays = (
            PIXEL_ANCHOR_WEIGHT
            + EAR_ANCHOR_WEIGHT * mesh.ear
            + HAND_ANCHOR_WEIGHT * (mesh.hand > 0.5)
            + FOOT_ANCHOR_WEIGHT * (mesh.foot > 0.5)
        )
        self.staying = sp.csc_array(
            held * cotangent_laplacian(template, mesh.triangles[own]) + sp.diags_array(stays * area)
        )
        self.count = count

    def least(
        self, stiffness: float, lines: _Lines, known: KnownPoints, start: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """The displacement (V, 2) of the least cost, from a `start` (V, 2).

        Only matches of points to lines couple x and y, and they lie on few vertices: the system with these matches' mean over all
        directions is factored, for both at once, and preconditions conjugate gradients on the true one.
        """
        count = self.count
        alone = np.bincount(known.vertices, np.full(len(known.vertices), KNOWN_POINT_WEIGHT), count).astype(np.float64)
        fixed = stiffness * self.bending + self.staying + sp.diags_array(alone)
        mean = np.bincount(lines.vertices, lines.weights / 2, count).astype(np.float64)
        factor = splu(
            sp.csc_array(fixed + sp.diags_array(mean)), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
        )

        def times(flat: NDArray[np.float64]) -> NDArray[np.float64]:
            move = flat.reshape(count, 2)
            along = lines.weights * (move[lines.vertices] * lines.normals).sum(1)
            return np.asarray(fixed @ move + self._gathered(lines, along)).ravel()

        right = self._gathered(lines, lines.weights * lines.goals)
        for axis in range(2):
            shift = known.places[:, axis] - self.template[known.vertices, axis]
            right[:, axis] += np.bincount(known.vertices, KNOWN_POINT_WEIGHT * shift, count)
        size = (2 * count, 2 * count)
        solved, _ = cg(
            LinearOperator(size, times, dtype=np.float64),
            right.ravel(),
            start.ravel(),
            rtol=CONJUGATE_GRADIENT_TOLERANCE,
            maxiter=CONJUGATE_GRADIENT_STEPS,
            M=LinearOperator(size, lambda flat: factor.solve(flat.reshape(count, 2)).ravel(), dtype=np.float64),
        )
        return np.asarray(solved).reshape(count, 2)

    def _gathered(self, lines: _Lines, along: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V, 2) the sum of values (N,) along the lines' normals, at their vertices."""
        columns = [np.bincount(lines.vertices, along * lines.normals[:, axis], self.count) for axis in range(2)]
        return np.stack(columns, 1).astype(np.float64)  # of no lines at all they are counts
