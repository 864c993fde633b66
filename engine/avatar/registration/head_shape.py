"""The head's shape in the space of heads: the "30-dimensional statistical head model" of section 3.4."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from engine.avatar.registration.fine import FIRST_INNER_FACE_POINT
from engine.avatar.registration.template_skin.skin import Skin, grown
from engine.body.face.head_space import HeadSpace
from engine.geometry.deformation.handles import handles
from engine.geometry.deformation.laplacian_deformation import LaplacianDeformation
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.registration.rigid import fit_similarity

GATE_METRES = (*[0.02] * 5, *[0.008] * 7)
"""Metres within which points are of the surface of the head, by rounds."""
POINTS_PER_ROUND = 5000
"""Points of the cloud that are looked at in each round."""
HEAD_POINT_SIGMA_METRES = 0.002
"""Metres by which the head's points are off, usually."""
BELIEVED_GATE_SHARE = 0.25
"""Of a round's gate, how far off across the surface a point counts a quarter (Geman-McClure): what lies farther is hair."""
INDEPENDENT_HEAD_POINTS = 1000.0
"""As how many independent measurements all points of the head count."""
HEAD_LANDMARK_SIGMA_METRES = 0.004
"""Metres by which face landmarks are off, usually."""
MIN_HEAD_NORMAL_COSINE = 0.5
"""Between the normals of a point and of the surface there."""
MAX_HEAD_DEVIATIONS = 5.5
"""How far a head is from the mean at most, in standard deviations over all coefficients together: as far as most people's (the root of
30). Hair is no part of a head of the space: drawn to it, all else becomes a caricature, with ears of a third of their height."""
MAX_PRIOR_LOGARITHM = 40.0
"""Natural logarithm of what the prior counts at most: against it no data are anything."""
NECK_RINGS = 6
"""Rings of vertices at the edge of the head that go over into the neck."""


@dataclass(frozen=True)
class _Head:
    """A head of the space.

    mean : (H, 3) metres.
    basis : (H, 3, K) metres.
    turn : (3, 3) by which it is turned about the mean's middle.
    shift : (3,) metres by which it is shifted then.
    coefficients : (K,).
    """

    mean: NDArray[np.float64]
    basis: NDArray[np.float64]
    turn: NDArray[np.float64]
    shift: NDArray[np.float64]
    coefficients: NDArray[np.float64]

    def vertices(self) -> NDArray[np.float64]:
        """(H, 3) metres."""
        middle = self.mean.mean(0)
        return (self.mean + self.basis @ self.coefficients - middle) @ self.turn.T + middle + self.shift

    def slopes(self) -> NDArray[np.float64]:
        """(H, 3, 6 + K) how the vertices move as they are turned about x, y and z and shifted, and with each coefficient."""
        away = self.vertices() - self.mean.mean(0) - self.shift
        turned = np.cross(np.eye(3)[None], away[:, None]).transpose(0, 2, 1)
        shifted = np.broadcast_to(np.eye(3), (len(away), 3, 3))
        return np.concatenate([turned, shifted, self.turn @ self.basis], 2)

    def moved(self, step: NDArray[np.float64]) -> _Head:
        """After a step (6 + K,) along `slopes`."""
        turn = Rotation.from_rotvec(step[:3]).as_matrix() @ self.turn
        return replace(self, turn=turn, shift=self.shift + step[3:6], coefficients=self.coefficients + step[6:])


def head_shape(
    skin: Skin, space: HeadSpace, fitted: NDArray[np.float64], cloud: PointCloud, face: NDArray[np.floating]
) -> NDArray[np.float64]:
    """The skin (S, 3) with the head that the space has for a cloud and `face` (68, 3) landmarks, in the body's world.

    Turn, place and coefficients are sought; the scale stays as the body's fit has it.
    """
    own = skin.index_of(space.vertices)
    place = fit_similarity(space.mean.astype(np.float64), fitted[own])
    basis = np.ascontiguousarray(place.offsets(space.basis).transpose(1, 2, 0))
    head = _Head(place(space.mean), basis, np.eye(3), np.zeros(3), np.zeros(basis.shape[2]))
    known = np.flatnonzero(np.isfinite(face).all(1))
    known = known[known >= FIRST_INNER_FACE_POINT]
    marks = np.searchsorted(own, skin.face_points[known])
    corners = _counted_triangles(skin, own)
    random = np.random.default_rng(0)
    for gate in GATE_METRES:
        picked = cloud[random.choice(len(cloud), min(POINTS_PER_ROUND, len(cloud)), replace=False)]
        rows, off = _point_rows(head, corners, picked, gate)
        if not len(rows):
            break
        slopes = head.slopes()[marks].reshape(-1, rows.shape[1]) / HEAD_LANDMARK_SIGMA_METRES
        marks_off = (head.vertices()[marks] - face[known]).ravel() / HEAD_LANDMARK_SIGMA_METRES
        head = head.moved(_step(head, rows.T @ rows + slopes.T @ slopes, rows.T @ off + slopes.T @ marks_off))
    return _grafted(skin, fitted, own, head.vertices())


def _step(head: _Head, normal: NDArray[np.float64], gradient: NDArray[np.float64]) -> NDArray[np.float64]:
    """(6 + K,) the step to where data, of a `normal` matrix and a `gradient`, and the prior cost least, among heads within
    `MAX_HEAD_DEVIATIONS`: the prior counts as much more as it takes."""
    prior = np.concatenate([np.zeros(6), np.ones(len(head.coefficients))])
    own = np.concatenate([np.zeros(6), head.coefficients])

    def step(strength: float) -> NDArray[np.float64]:
        solved = np.linalg.solve(normal + np.diag(strength * prior + 1e-6), gradient + strength * own)
        return np.asarray(-solved, np.float64)

    def beyond(logarithm: float) -> float:
        return float(np.linalg.norm(own[6:] + step(np.exp(logarithm))[6:])) - MAX_HEAD_DEVIATIONS

    if beyond(0.0) <= 0:
        return step(1.0)
    return step(float(np.exp(brentq(beyond, 0.0, MAX_PRIOR_LOGARITHM))))


def _point_rows(
    head: _Head, corners: NDArray[np.intp], picked: PointCloud, gate: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The Jacobian (M, 6 + K) and how far (M,) points are off across the surface, in standard deviations, each as far as it is
    believed."""
    vertices = head.vertices()
    nearest = closest_points(picked.points, vertices, corners)
    normals = face_normals(vertices, corners)[nearest.triangle]
    used = (nearest.distance < gate) & ((normals * picked.normals).sum(1) > MIN_HEAD_NORMAL_COSINE)
    at, shares, across = corners[nearest.triangle[used]], nearest.barycentrics[used], normals[used]
    scale = np.sqrt(INDEPENDENT_HEAD_POINTS / max(int(used.sum()), 1)) / HEAD_POINT_SIGMA_METRES
    off = np.einsum("mk,mkc->mc", shares, vertices[at]) - picked.points[used]
    moved = np.einsum("mk,mkcp->mcp", shares, head.slopes()[at])
    away = (off * across).sum(1)
    believed = scale / (1 + (away / (BELIEVED_GATE_SHARE * gate)) ** 2)
    return believed[:, None] * np.einsum("mc,mcp->mp", across, moved), believed * away


def _counted_triangles(skin: Skin, own: NDArray[np.intp]) -> NDArray[np.intp]:
    """The visible triangles of the head, but for the lips', into its vertices `own` (H,)."""
    chosen = skin.visible & np.isin(skin.triangles, own).all(1) & ~skin.regions["lips"][skin.triangles].all(1)
    return np.searchsorted(own, skin.triangles[chosen]).astype(np.intp)


def _grafted(
    skin: Skin, fitted: NDArray[np.float64], own: NDArray[np.intp], head: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The skin with another head (H, 3), going over smoothly at its edge."""
    rest = ~skin.regions["head"]
    edge = grown(rest, skin.triangles, NECK_RINGS)
    kept = ~grown(skin.regions["head"], skin.triangles, NECK_RINGS)
    targets = fitted.copy()
    targets[own] = head
    held = np.flatnonzero(kept | ~edge)
    return LaplacianDeformation(fitted, skin.triangles, handles(len(fitted), held))(targets[held])
