"""What pulls at a surface that is deformed: vertices that are held, and points of it that are drawn somewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import SuperLU, splu

from engine.geometry.nearest_rotations import nearest_rotations


@dataclass(frozen=True)
class Handles:
    """Hard and soft targets of a surface of V vertices; where they are to be is said later, many times if need be.

    held : (H,) int, vertices that reach their targets exactly, no vertex twice.
    drawn : (S, V) sparse, points of the surface that come near their targets, as weights of its vertices: each row sums to one.
    weights : (S,) >= 0, of the square of what is left, in the square of the vertices' unit, against the surface's own
        resistance.
    """

    held: NDArray[np.intp]
    drawn: sp.csr_array
    weights: NDArray[np.float64]


def handles(
    count: int,
    held: NDArray[np.integer] | None = None,
    drawn: NDArray[np.integer] | sp.csr_array | None = None,
    weights: NDArray[np.floating] | float = 1.0,
) -> Handles:
    """Handles of a surface of `count` vertices.

    Parameters
    ----------
    held : (H,) vertices with hard targets; none by default.
    drawn : points with soft targets: (S,) vertices, or (S, V) sparse as `surface_points` has it; none by default.
    weights : of the soft targets, one for all or (S,).

    Raises ValueError where a vertex is held twice or not there, or a weight is negative or not finite.
    """
    hard = np.zeros(0, np.intp) if held is None else np.asarray(held, np.intp).ravel()
    if len(np.unique(hard)) < len(hard):
        raise ValueError("a vertex is held twice")
    if isinstance(drawn, sp.csr_array):
        soft = drawn
    else:
        vertices = np.zeros(0, np.intp) if drawn is None else np.asarray(drawn, np.intp).ravel()
        if len(vertices) and not (vertices.min() >= 0 and vertices.max() < count):
            raise ValueError("a vertex that is drawn is not there")
        rows = np.arange(len(vertices))
        soft = sp.csr_array((np.ones(len(vertices)), (rows, vertices)), shape=(len(vertices), count))
    if soft.shape[1] != count or (len(hard) and not (hard.min() >= 0 and hard.max() < count)):
        raise ValueError("handles are not of this surface")
    strengths = np.broadcast_to(np.asarray(weights, np.float64), soft.shape[:1])
    if not (np.isfinite(strengths).all() and (strengths >= 0).all()):
        raise ValueError("weights are finite and not negative")
    return Handles(hard, soft, np.ascontiguousarray(strengths))


def surface_points(
    triangles: NDArray[np.integer], which: NDArray[np.integer], barycentrics: NDArray[np.floating], count: int
) -> sp.csr_array:
    """(S, V) sparse: points of a surface of `count` vertices that lie in the triangles `which` (S,) of `triangles` (T, 3),
    at `barycentrics` (S, 3) that sum to one."""
    corners = np.asarray(triangles)[which]
    rows = np.arange(len(corners)).repeat(3)
    return sp.csr_array((np.asarray(barycentrics, np.float64).ravel(), (rows, corners.ravel())), (len(corners), count))


class HeldSystem:
    """Where vertices v come to rest: v' K v / 2 - force' v + half of what soft targets cost is least, held ones being at their
    targets. K, the stiffness, is factorised once, for any force and targets.
    """

    def __init__(self, rest: NDArray[np.floating], stiffness: sp.sparray, handles: Handles):
        """`rest` (V, 3); `stiffness` (V, V) sparse, symmetric, positive semi-definite, blind to what all vertices of a
        piece have in common. A vertex that it connects with no other needs no handle.

        Raises ValueError where a piece of the surface has no handle: nothing says where it should go.
        """
        self.rest = np.asarray(rest, np.float64)
        self.handles = handles
        count = len(self.rest)
        pull = sp.csr_array(handles.drawn.T @ sp.diags_array(handles.weights))
        whole = sp.csr_array(stiffness + pull @ handles.drawn)
        whole.eliminate_zeros()
        _, self.piece = connected_components(whole, directed=False)
        handled = np.zeros(count, np.bool_)
        handled[handles.held] = True
        handled[sp.csr_array(handles.drawn[handles.weights > 0]).indices] = True
        pieces = int(self.piece.max(initial=-1)) + 1
        sizes = np.bincount(self.piece, minlength=pieces)
        pulled = np.bincount(self.piece, handled, pieces) > 0
        lost = np.flatnonzero(~pulled & (sizes > 1))
        if len(lost):
            first = int(np.flatnonzero(self.piece == lost[0])[0])
            raise ValueError(
                f"{len(lost)} of the surface's pieces have no target, the first the {sizes[lost[0]]} vertices about vertex "
                f"{first}: hold one of its vertices, or leave the piece out"
            )
        free = np.flatnonzero(pulled[self.piece])
        self._free = free[~np.isin(free, handles.held)]
        self._pull = pull
        self._from_held = sp.csr_array(whole[self._free][:, handles.held])
        self._solver: SuperLU | None = None
        if len(self._free):
            self._solver = splu(
                sp.csc_array(whole[self._free][:, self._free]),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )

    def targets(
        self, held_at: NDArray[np.floating] | None, drawn_to: NDArray[np.floating] | None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The targets (H, 3) and (S, 3) as they are used. Raises ValueError where they do not fit, or are not finite."""
        found = []
        for given, wanted in ((held_at, len(self.handles.held)), (drawn_to, self.handles.drawn.shape[0])):
            places = np.zeros((0, 3)) if given is None else np.asarray(given, np.float64)
            if places.shape != (wanted, 3):
                raise ValueError(f"{wanted} targets are needed, (N, 3): {places.shape}")
            if not np.isfinite(places).all():
                raise ValueError("a target is not finite")
            found.append(places)
        return found[0], found[1]

    def solve(
        self,
        force: NDArray[np.float64],
        held_at: NDArray[np.float64],
        drawn_to: NDArray[np.float64],
        idle: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """The vertices (V, 3) under a force (V, 3); those that nothing pulls are where `idle` (V, 3) has them."""
        out = idle.copy()
        out[self.handles.held] = held_at
        if self._solver is not None:
            right = (force + self._pull @ drawn_to)[self._free] - self._from_held @ held_at
            out[self._free] = self._solver.solve(right)
        return out

    def carried(
        self, held_at: NDArray[np.float64], drawn_to: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The surface at rest, each of its pieces moved as one to where its targets are, by least squares: vertices (V, 3)
        and the rotation of each, (V, 3, 3)."""
        points = np.concatenate([self.rest[self.handles.held], self.handles.drawn @ self.rest])
        wanted = np.concatenate([held_at, drawn_to])
        strengths = np.concatenate([np.ones(len(held_at)), self.handles.weights])
        told = strengths > 0
        inside = sp.csr_array(self.handles.drawn)
        members = np.concatenate([self.piece[self.handles.held], self.piece[_first_of_each_row(inside)]])
        points, wanted, strengths, members = points[told], wanted[told], strengths[told], members[told]
        out, turned = self.rest.copy(), np.tile(np.eye(3), (len(self.rest), 1, 1))
        for piece in np.unique(members):
            here, own = members == piece, self.piece == piece
            shares = strengths[here] / strengths[here].sum()
            before, after = shares @ points[here], shares @ wanted[here]
            spread = ((points[here] - before) * shares[:, None]).T @ (wanted[here] - after)
            rotation = nearest_rotations(spread[None])[0]
            out[own] = (self.rest[own] - before) @ rotation.T + after
            turned[own] = rotation
        return out, turned


def _first_of_each_row(matrix: sp.csr_array) -> NDArray[np.intp]:
    """(S,) the column of the first entry of each row; 0 of an empty one."""
    found = np.zeros(matrix.shape[0], np.intp)
    filled = np.diff(matrix.indptr) > 0
    found[filled] = matrix.indices[matrix.indptr[:-1][filled]]
    return found
