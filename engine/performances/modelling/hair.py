"""The actor's hair: a short crop, brows and lashes, grown strand by strand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.geometry.mesh.surface import triangle_areas, triangulate, vertex_normals
from engine.performances.modelling.chart import AXIS_DEPTH, CHART_RADIUS_METRES, smooth_curve, smooth_step
from engine.performances.modelling.figure import Figure

HAIRLINE_POINTS = [
    *((0.0, 0.8565), (0.018, 0.8575), (0.034, 0.8580), (0.047, 0.8550), (0.057, 0.8465), (0.0635, 0.8360)),
    *((0.071, 0.8270), (0.0795, 0.8180), (0.087, 0.8080), (0.0920, 0.7960), (0.0965, 0.7830), (0.1000, 0.7720)),
    *((0.1080, 0.7700), (0.1120, 0.7850), (0.1200, 0.8000), (0.1400, 0.8120), (0.1620, 0.8100), (0.1740, 0.7900)),
    *((0.1800, 0.7600), (0.1850, 0.7300), (0.2100, 0.7150), (0.3142, 0.7130)),
]
"""The border of the hair on the map of the head, sitter's left, from the middle of the forehead around the ear to
the nape (u, v)."""


@dataclass(frozen=True)
class Haircut:
    """Hair that moves with the skull.

    points : (S, K, 3) of the rest pose.
    normals : (S, 3) of the scalp at their roots.
    widths : (S, K) metres.
    tone : (S,) each hair's brightness.
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    widths: NDArray[np.float32]
    tone: NDArray[np.float32]


def hair_cover(chart: NDArray[np.floating]) -> NDArray[np.float32]:
    """How far inside the hair's border points of the map (N, 2) lie, metres; negative outside."""
    curve = smooth_curve(HAIRLINE_POINTS, 1200)
    curve[:, 0] = np.clip(curve[:, 0], 0, None)
    place = np.stack([np.abs(chart[:, 0]), chart[:, 1]], 1)
    distance, nearest = cKDTree(curve).query(place)
    ahead = np.gradient(curve, axis=0)[nearest]
    offset = place - curve[nearest]
    side = np.sign(ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0])
    return (distance * side).astype(np.float32)


def grow_crop(figure: Figure, chart: NDArray[np.floating], count: int = 34000, seed: int = 11) -> Haircut:
    """Grow the hair of the head over the fine skin's rest pose; `chart` (N, 2) are its vertices on the map."""
    rng = np.random.default_rng(seed)
    rest = (figure.fine @ figure.rest).astype(np.float32)
    triangles = triangulate(figure.quads)
    cover = hair_cover(chart)
    hairy = triangles[(cover[triangles].max(1) > -0.002) & (rest[triangles, 1].min(1) > 0.70)]
    roots, normals = _scatter(rng, rest, vertex_normals(rest, triangles), hairy, int(count * 1.3))
    inside = hair_cover(_chart_of(roots)) + rng.normal(0, 0.0018, len(roots))
    sparse = np.clip(inside / 0.009, 0, 1)
    kept = np.flatnonzero(rng.uniform(size=len(roots)) < sparse)[:count]
    roots, normals, inside = roots[kept], normals[kept], inside[kept]
    points = _comb(rng, roots, normals, inside)
    points = _clump(rng, points)
    widths = np.linspace(1, 0.35, points.shape[1])[None] * rng.normal(1.0e-4, 1.2e-5, (len(points), 1))
    tone = np.exp(rng.normal(0, 0.22, len(points)))
    return Haircut(points.astype(np.float32), normals, widths.astype(np.float32), tone.astype(np.float32))


def _comb(
    rng: np.random.Generator, roots: NDArray[np.float32], normals: NDArray[np.float32], inside: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Let each hair rise along the normal and lie down where it is combed to: up and to his left in front, forward
    on the crown, down and back at the sides. Returns (S, 8, 3)."""
    top = smooth_step(roots[:, 1], 0.835, 0.880)[:, None]
    front = smooth_step(roots[:, 2], 0.075, 0.125)[:, None] * top
    side = np.sign(roots[:, :1]) * np.array([1.0, 0.0, 0.0])
    crown = np.array([0.30, 0.10, 0.75])
    quiff = np.array([0.42, 0.78, 0.10])
    flank = np.array([0.0, -0.85, -0.35]) + 0.1 * side
    comb = flank + top * (crown - flank) + front * (quiff - crown)
    comb = comb + rng.normal(0, 0.16, comb.shape)
    lying = comb - (comb * normals).sum(1, keepdims=True) * normals * (0.85 - 0.45 * front)
    lying /= np.linalg.norm(lying, axis=1, keepdims=True)
    rising = normals * (0.75 + 0.35 * front) + 0.65 * lying + rng.normal(0, 0.14, comb.shape)
    rising /= np.linalg.norm(rising, axis=1, keepdims=True)
    length = 0.0065 + 0.019 * top[:, 0] + 0.010 * front[:, 0]
    length = length * np.clip(0.35 + inside / 0.012, 0.35, 1) * np.exp(rng.normal(0, 0.16, len(roots)))
    pieces = 8
    points = [roots.astype(np.float64)]
    for k in range(1, pieces):
        t = (k - 0.5) / (pieces - 1)
        ahead = rising * (1 - t) + (lying + 0.22 * (1 - t) * normals) * t
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        points.append(points[-1] + ahead * (length / (pieces - 1))[:, None])
    return np.stack(points, 1)


def _clump(rng: np.random.Generator, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Draw hairs together towards their tips, in tufts of some dozens, loosely tufted again."""
    t = np.linspace(0, 1, points.shape[1])[None, :, None]
    for every, pull in ((260, 0.30), (34, 0.48)):
        leaders = points[rng.choice(len(points), len(points) // every, replace=False)]
        _, mine = cKDTree(leaders[:, 0]).query(points[:, 0])
        reach = rng.uniform(0.5, 1.0, (len(points), 1, 1))
        points = points + pull * reach * t**1.4 * (leaders[mine] - points)
    return points


def _scatter(
    rng: np.random.Generator,
    vertices: NDArray[np.float32],
    normals: NDArray[np.float32],
    triangles: NDArray[np.int32],
    count: int,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Random points on triangles, evenly by area, and the normals there."""
    area = triangle_areas(vertices, triangles)
    chosen = triangles[rng.choice(len(triangles), count, p=area / area.sum())]
    u, v = np.sqrt(rng.uniform(size=(count, 1))), rng.uniform(size=(count, 1))
    share = np.stack([1 - u, u * (1 - v), u * v], 1)
    found = [(values[chosen] * share).sum(1).astype(np.float32) for values in (vertices, normals)]
    return found[0], found[1] / np.linalg.norm(found[1], axis=1, keepdims=True)


def _chart_of(points: NDArray[np.floating]) -> NDArray[np.floating]:
    return np.stack([CHART_RADIUS_METRES * np.arctan2(points[:, 0], points[:, 2] - AXIS_DEPTH), points[:, 1]], 1)
