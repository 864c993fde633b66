"""How far one surface lies from another: aligned by a similarity, point to surface, and by its normals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from trimesh.triangles import closest_point

from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.render.rasterisation.rasteriser import depth_map

SURFACE_SAMPLES = 40_000
"""Points drawn on a surface."""
ALIGNMENT_SAMPLES = 4_000
"""Points by which two surfaces are aligned."""
SURFACE_ALIGNMENT_ROUNDS = 40
"""Rounds in which two surfaces are aligned."""
VIEW_PIXELS = 500
"""Pixels of the views that tell what lies outside."""
SURFACE_TOLERANCE_METRES = 0.006
"""Metres, of a body 1.8 m high, that still count as the surface."""
CANDIDATE_TRIANGLE_COUNT = 6
"""Triangles, of the nearest samples, in which the nearest point of a surface is looked for."""


@dataclass(frozen=True)
class Sampled:
    """What is seen of a surface from outside: `points` (N, 3), `normals` (N, 3) of the triangles, `triangles` (N, 3, 3)."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.float64]

    def moved(self, move: Similarity) -> Sampled:
        """Moved by a similarity."""
        normals = self.normals @ move.rotation.T
        return Sampled(move(self.points), normals, move(self.triangles))


@dataclass(frozen=True)
class Distances:
    """chamfer : the mean over both directions.
    to_surface : from the true points to the surface that was made; both in the truth's unit.
    normals : degrees between a true point's normal and that of the nearest place made.
    """

    chamfer: float
    to_surface: float
    normals: float


def sample_outside(vertices: NDArray[np.floating], triangles: NDArray[np.integer], seed: int = 0) -> Sampled:
    """Random points of equal density on what can be seen of a body (1.8 m high) from all around: linings, mouths and
    limbs that lie in others do not count."""
    random = np.random.default_rng(seed)
    corners = np.asarray(vertices, np.float64)[triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(cross, axis=1)
    at = random.choice(len(corners), SURFACE_SAMPLES, p=areas / areas.sum())
    a, b = np.sqrt(random.random(SURFACE_SAMPLES)), random.random(SURFACE_SAMPLES)
    weights = np.stack([1 - a, a * (1 - b), a * b], 1)
    points = np.einsum("nk,nkd->nd", weights, corners[at])
    towards = _towards_views(np.asarray(vertices, np.float64), triangles, points)
    seen = towards.any(1)
    at, towards = at[seen], towards[seen]
    normals = cross[at] / areas[at, None]
    normals *= np.where((normals * towards).sum(1, keepdims=True) < 0, -1, 1)  # a single sheet is seen from both sides
    return Sampled(points[seen], normals, corners[at])


def _towards_views(
    vertices: NDArray[np.float64], triangles: NDArray[np.integer], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(N, 3) the sum of the directions, of 26 around, from which each point is seen; zero where it is hidden from all."""
    middle = (vertices.max(0) + vertices.min(0)) / 2
    reach = float(np.linalg.norm(vertices - middle, axis=1).max())
    scale = (VIEW_PIXELS - 2) / (2 * reach)
    towards = np.zeros((len(points), 3))
    # a little aside, so that no point is seen from opposite ways alike
    ways = np.array([w for w in np.ndindex(3, 3, 3) if w != (1, 1, 1)]) - [1.01, 1.02, 1.03]
    for way in ways:
        back = way / np.linalg.norm(way)
        right = np.cross([0.0, 1, 0] if abs(back[1]) < 0.9 else [1.0, 0, 0], back)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back])

        def view(places: NDArray[np.float64], axes: NDArray[np.float64] = axes) -> NDArray[np.float64]:
            x, y, z = (scale * (places - middle) @ axes.T).T
            return np.stack([x + (VIEW_PIXELS - 1) / 2, (VIEW_PIXELS - 1) / 2 - y, -z], 1)

        nearest = depth_map(view(vertices), triangles, (VIEW_PIXELS, VIEW_PIXELS))
        x, y, z = view(points).T
        seen = z < nearest[np.rint(y).astype(int), np.rint(x).astype(int)] + SURFACE_TOLERANCE_METRES * scale
        towards[seen] += back
    return towards


def align(made: Sampled, truth: Sampled) -> Similarity:
    """The similarity that brings what was made to the truth: from equal heights and middles, by closest points of both
    (P. Besl, N. McKay, A method for registration of 3-D shapes, PAMI 1992, with Umeyama's step)."""
    low, high = made.points.min(0), made.points.max(0)
    true_low, true_high = truth.points.min(0), truth.points.max(0)
    scale = float((true_high[1] - true_low[1]) / (high[1] - low[1]))
    move = Similarity(scale * np.eye(3), (true_low + true_high) / 2 - scale * (low + high) / 2)
    mine, theirs = made.points[:: max(1, len(made.points) // ALIGNMENT_SAMPLES)], truth.points[:: max(1, len(truth.points) // ALIGNMENT_SAMPLES)]  # fmt: skip
    fixed = cKDTree(theirs)
    for _ in range(SURFACE_ALIGNMENT_ROUNDS):
        moved = move(mine)
        _, there = fixed.query(moved)
        _, here = cKDTree(moved).query(theirs)
        move = fit_similarity(np.concatenate([mine, mine[here]]), np.concatenate([theirs[there], theirs]))
    return move


def compare(made: Sampled, truth: Sampled) -> Distances:
    """Distances of aligned surfaces."""
    there, normal = _to_surface(truth, made)
    back, _ = _to_surface(made, truth)
    return Distances(float(there.mean() + back.mean()) / 2, float(there.mean()), float(normal.mean()))


def _to_surface(samples: Sampled, surface: Sampled) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """From each point the distance to the nearest of the surface's triangles, and the angle of the normals there."""
    near = np.asarray(cKDTree(surface.points).query(samples.points, k=CANDIDATE_TRIANGLE_COUNT)[1])
    away = np.stack([
        np.linalg.norm(closest_point(surface.triangles[near[:, k]], samples.points) - samples.points, axis=1)
        for k in range(CANDIDATE_TRIANGLE_COUNT)
    ])  # fmt: skip
    best: NDArray[np.intp] = np.argmin(away, axis=0)
    each = np.arange(len(best))
    cosine = (samples.normals * surface.normals[near[each, best]]).sum(1)
    return away[best, each], np.degrees(np.arccos(np.clip(cosine, -1, 1)))
