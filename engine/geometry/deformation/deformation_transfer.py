"""How one surface is deformed, done to another: a face's expressions for a face of another shape.

Source: R. Sumner, J. Popovic, Deformation transfer for triangle meshes, SIGGRAPH 2004. Their fourth vertices, which only
stand for the normals, drop out, and triangles are weighted by their areas: M. Botsch, R. Sumner, M. Pauly, M. Gross,
Deformation transfer for detail-preserving surface editing, VMV 2006 (it is Poisson's equation then).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.geometry.deformation.handles import HeldSystem, handles
from engine.geometry.mesh.surface import area_vectors, triangle_areas

MIN_SINE = 1e-6
"""Twice a triangle's area as a share of its longest edge squared; one with less says nothing of how it is deformed."""


class DeformationTransfer:
    """Made ready once for two surfaces at rest, and then called with each deformation of the first.

    Triangles of the target are deformed as their counterparts are, as far as they hold together: by least squares, each
    weighted by its area. Triangles without area, on either side, are left out. A piece of which no vertex is held moves on
    average as its counterparts do, times the ratio of the surfaces' sizes.
    """

    def __init__(
        self,
        source: NDArray[np.floating],
        source_triangles: NDArray[np.integer],
        target: NDArray[np.floating],
        target_triangles: NDArray[np.integer],
        matches: NDArray[np.integer] | None = None,
        held: NDArray[np.integer] | None = None,
        screening: float | None = None,
    ):
        """Make ready.

        Parameters
        ----------
        source, source_triangles : the surface whose deformations are known, at rest: (V, 3) and (T, 3).
        target, target_triangles : the one that is to be deformed, at rest: (W, 3) and (U, 3); any unit, turned as
            the source is. Vertices of no triangle stay where they are.
        matches : (U,) the triangle of the source that each of the target follows, its corners in the same order;
            by default the same number, both having the same triangles.
        held : (H,) vertices of the target that stay where they are, or go where they are told; none by default.
        screening : a length, in the target's unit: over more than about so much vertices go where they are `drawn_to`, and only
            over less as their triangles say (a screened Poisson equation: P. Bhat and others, Fourier analysis of the 2D
            screened Poisson equation for gradient domain problems, ECCV 2008). By default nothing is drawn.

        Raises ValueError where triangles do not match, places are not finite, or a vertex of the target has only
        triangles without area: weld it or leave it out.
        """
        self._source, self._faces = np.asarray(source, np.float64), np.asarray(source_triangles, np.intp)
        self._target = np.asarray(target, np.float64)
        corners = np.asarray(target_triangles, np.intp)
        if matches is None and len(corners) != len(self._faces):
            raise ValueError("the surfaces have different triangles: say which match")
        follows = np.arange(len(corners)) if matches is None else np.asarray(matches, np.intp)
        if follows.shape != (len(corners),) or (
            len(follows) and not 0 <= follows.min() <= follows.max() < len(self._faces)
        ):
            raise ValueError("each triangle of the target needs one of the source")
        if not (np.isfinite(self._source).all() and np.isfinite(self._target).all()):
            raise ValueError("a surface has places that are not finite")
        sound = _has_area(self._source, self._faces)[follows] & _has_area(self._target, corners)
        unsaid = np.setdiff1d(corners, corners[sound])
        if held is not None:
            unsaid = np.setdiff1d(unsaid, held)
        if len(unsaid):
            raise ValueError(f"{len(unsaid)} vertices, the first {unsaid[0]}, have only triangles without area")
        corners, self._follows = corners[sound], follows[sound]
        count = len(self._target)
        gradient, areas = _gradients(self._target, corners)
        self._divergence = sp.csr_array(gradient.T @ sp.diags_array(areas.repeat(3)))
        stiffness = sp.csr_array(self._divergence @ gradient)
        self._held = np.zeros(0, np.intp) if held is None else np.asarray(held, np.intp).ravel()
        self._piece, unheld, self._shares = _unheld_pieces(corners, areas, stiffness, self._held)
        self._middles = sp.csr_array(self._shares @ _corner_means(corners, count))
        sizes = areas.sum(), triangle_areas(self._source, self._faces[self._follows]).sum()
        self._ratio = float(np.sqrt(sizes[0] / sizes[1])) if len(corners) else 1.0
        # a piece that floats is held by one of its vertices, and moved as a whole afterwards
        anchors = np.concatenate([self._held, unheld])
        free = np.zeros(0, np.intp) if screening is None else np.setdiff1d(corners, anchors)
        of_vertex = np.bincount(corners.ravel(), areas.repeat(3) / 3, count)
        weights = of_vertex[free] / (screening or 1.0) ** 2
        self._system = HeldSystem(self._target, stiffness, handles(count, anchors, free, weights))

    def __call__(
        self,
        deformed: NDArray[np.floating],
        held_at: NDArray[np.floating] | None = None,
        drawn_to: NDArray[np.floating] | None = None,
    ) -> NDArray[np.float64]:
        """The target (W, 3) float64, deformed as the source is whose vertices are `deformed` (V, 3).

        `held_at` (H, 3): where the held vertices go; by default they stay. `drawn_to` (W, 3): where vertices are drawn, if there is
        a `screening`. Raises ValueError where places do not fit, or are not finite.
        """
        moved = np.asarray(deformed, np.float64)
        if moved.shape != self._source.shape or not np.isfinite(moved).all():
            raise ValueError("the deformed source has other vertices, or places that are not finite")
        changes = deformation_gradients(self._source, moved, self._faces[self._follows])
        force = self._divergence @ changes.transpose(0, 2, 1).reshape(-1, 3)
        system = self._system
        stays = self._target[self._held] if held_at is None else np.asarray(held_at, np.float64)
        anchored = self._target[system.handles.held[len(self._held) :]]
        towards = None if drawn_to is None else system.handles.drawn @ np.asarray(drawn_to, np.float64)
        hard, soft = system.targets(np.concatenate([stays, anchored]), towards)
        out = system.solve(force, hard, soft, self._target)
        steps = (moved - self._source)[self._faces[self._follows]].mean(1)
        away = self._middles @ (self._target - out) + self._ratio * (self._shares @ steps)
        return np.asarray(out + np.concatenate([away, np.zeros((1, 3))])[self._piece])


def deformation_gradients(
    rest: NDArray[np.floating], deformed: NDArray[np.floating], triangles: NDArray[np.integer]
) -> NDArray[np.float64]:
    """(T, 3, 3) what each triangle (T, 3) of vertices (V, 3) went through. It takes edges at rest to edges deformed,
    and the normal to the normal, as long as the root of twice the area (Sumner and Popovic, section 3)."""
    frames = []
    for vertices in (rest, deformed):
        places = np.asarray(vertices, np.float64)
        a, b, c = (places[triangles[:, k]] for k in range(3))
        normal = area_vectors(places, triangles)
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        frames.append(np.stack([b - a, c - a, normal / np.sqrt(np.maximum(length, 1e-300))], 2))
    return np.asarray(frames[1] @ np.linalg.inv(frames[0]))


def _gradients(vertices: NDArray[np.float64], triangles: NDArray[np.intp]) -> tuple[sp.csr_array, NDArray[np.float64]]:
    """(3 T, V) sparse: the gradient in each triangle of a function that is linear there; and the areas (T,)."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = area_vectors(vertices, triangles)
    squared = (normal**2).sum(1, keepdims=True)
    slopes = np.stack([np.cross(normal, side) / squared for side in (c - b, a - c, b - a)], 2)  # (T, 3, corner)
    rows = np.arange(3 * len(triangles)).repeat(3)
    columns = triangles.repeat(3, axis=0).ravel()
    matrix = sp.csr_array((slopes.ravel(), (rows, columns)), (3 * len(triangles), len(vertices)))
    return matrix, np.sqrt(squared[:, 0]) / 2


def _unheld_pieces(
    corners: NDArray[np.intp], areas: NDArray[np.float64], stiffness: sp.csr_array, held: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp], sp.csr_array]:
    """The P pieces of which no vertex is held. Returns (V,) which of them each vertex belongs to, P for others; (P,) a
    vertex of each; and (P, T) sparse, the share that each triangle has in the area of each."""
    _, piece = connected_components(stiffness, directed=False)
    of_triangle = piece[corners[:, 0]]
    unheld = np.setdiff1d(of_triangle, piece[held])
    inside = np.flatnonzero(np.isin(of_triangle, unheld))
    owner = np.searchsorted(unheld, of_triangle[inside])
    shares = areas[inside] / np.bincount(owner, areas[inside], len(unheld))[owner]
    number = np.full(int(piece.max(initial=-1)) + 1, len(unheld), np.intp)
    number[unheld] = np.arange(len(unheld))
    first = np.zeros(len(unheld), np.intp)
    first[owner[::-1]] = corners[inside[::-1], 0]
    return number[piece], first, sp.csr_array((shares, (owner, inside)), shape=(len(unheld), len(corners)))


def _corner_means(corners: NDArray[np.intp], count: int) -> sp.csr_array:
    """(T, V) sparse: the mean of each triangle's corners."""
    rows = np.arange(len(corners)).repeat(3)
    return sp.csr_array((np.full(len(rows), 1 / 3), (rows, corners.ravel())), shape=(len(corners), count))


def _has_area(vertices: NDArray[np.float64], triangles: NDArray[np.intp]) -> NDArray[np.bool_]:
    """(T,) whether a triangle says how it is deformed."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    longest = np.max([((b - a) ** 2).sum(1), ((c - b) ** 2).sum(1), ((a - c) ** 2).sum(1)], axis=0)
    return np.asarray(2 * triangle_areas(vertices, triangles) > MIN_SINE * longest)
