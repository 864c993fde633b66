"""The face's contour, and what lies beside it.

Where a face's surface goes out of sight its points lie close to the contour in the picture and far behind each other in
space. A turn of the head, an expression or a second look then moves neighbours apart, or past the contour, and the
outline gets notches. So beside the contour of the cheeks its own points alone carry the picture. Where others would
pass it, it goes out with them as an even curve. Those nearest to it are stretched no more than those further in.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import FACE_OVAL, eye_distance, eyes_and_chin

CHEEK_CONTOUR_EDGES = (*range(8, 14), *range(22, 28))
"""Edges of `FACE_OVAL` from the ears to the chin, by where they begin; forehead and chin stay in sight."""
CONTOUR_MARGIN_EYE_DISTANCES = 0.08
"""Within this distance, in eye distances, a point lies beside the contour."""

CONTOUR_WEIGHTS = np.interp(np.arange(len(FACE_OVAL)), (6, 8, 13, 15, 21, 23, 28, 30), (0, 1, 1, 0, 0, 1, 1, 0))
"""How far each vertex of `FACE_OVAL` takes part in keeping points inside: fully from the ears to the jaw."""
KEPT_INSIDE_EYE_DISTANCES = 0.4
"""Eye distances from the contour up to which points are kept inside it."""
FADE_OUT_EYE_DISTANCES = 0.6
"""Eye distances from the contour up to which points beyond those say how far their side of the face is stretched."""
MIN_KEPT_SHARE = 0.1
"""Share of its distance from the contour that a point inside it keeps, at least."""
MAX_DISTANCE_GAIN = 1.5
"""By how many times a point's distance from the contour grows over that of its side of the face, at most."""
CONTOUR_FALLOFF_EYE_DISTANCES = 0.3
"""Eye distances along the contour over which a point takes it along."""
CONTOUR_SMOOTHING_ROUNDS = 2
"""How often the way that the contour goes out is evened out along it."""

EVEN_BAND_EYE_DISTANCES = 0.5
"""Eye distances inside the contour up to which what the face does beside the head's motion is evened out along it."""
DEPTH_BAND_EYE_DISTANCES = 0.15
"""Eye distances inside the contour up to which the face's depth is evened out along it."""
EVEN_SPREAD_EYE_DISTANCES = 0.25
"""Eye distances along the contour over which it is evened out: about those between its vertices."""
JAW_CHIN_LENGTHS = (0.4, 0.9)
"""Lengths from eyes to chin below the eyes between which the contour becomes the jaw's, which expressions move."""

EAR_VERTICES = (234, 454)
"""The contour beside the ears, right one first."""


@dataclass(frozen=True)
class _Band:
    """`vertices` (K,) inside the contour, and the spot of it next to each at rest: `share` (K,) of the way along `edge` (K,)
    of `FACE_OVAL`."""

    vertices: NDArray[np.int64]
    edge: NDArray[np.int64]
    share: NDArray[np.float64]

    def at_spots(self, values: NDArray[np.floating]) -> NDArray[np.floating]:
        """Values (N, 36, D) at the vertices of `FACE_OVAL`, at the spots: (N, K, D)."""
        share = self.share[:, None]
        return (1 - share) * values[:, self.edge] + share * np.roll(values, -1, axis=1)[:, self.edge]

    def inward(self, faces: NDArray[np.floating]) -> NDArray[np.floating]:
        """(N, K, 2) the way into faces (N, 478, 2) at the spots, of length 1."""
        way = self.at_spots(_inward(faces[:, list(FACE_OVAL)]))
        return np.asarray(way / np.linalg.norm(way, axis=2, keepdims=True))

    def depth(self, faces: NDArray[np.floating], inward: NDArray[np.floating]) -> NDArray[np.floating]:
        """(N, K) how far inside their spots the vertices of faces (N, 478, 2) lie, pixels."""
        apart = faces[:, self.vertices] - self.at_spots(faces[:, list(FACE_OVAL)])
        return np.asarray((apart * inward).sum(axis=2))


def rim_distance(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how far points lie outside the contour of a face (478, 2 or 3), pixels; negative inside."""
    oval = mesh[list(FACE_OVAL), :2].astype(np.float32)
    return np.array([-cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in points])


def contour_spots(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P, 36) weights of the contour's vertices that give the spot of a face's contour (478, 2 or 3) next to each of points (P, 2): two of
    each row."""
    everywhere = np.ones(len(mesh), bool)
    edge, share, _ = _nearest(mesh, everywhere, everywhere[: len(FACE_OVAL)], points)
    weights = np.zeros((len(points), len(FACE_OVAL)))
    rows = np.arange(len(points))
    weights[rows, edge] = 1 - share
    weights[rows, (edge + 1) % len(FACE_OVAL)] = share
    return weights


def beside_contour(mesh: NDArray[np.floating], seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(478,) whether each vertex of a mesh (478, 2 or 3) lies beside the cheeks' contour and is none of its own. That
    is so only where the contour's vertices are `seen` (478,): elsewhere others are the picture's outline."""
    cheeks = np.isin(np.arange(len(FACE_OVAL)), CHEEK_CONTOUR_EDGES)
    beside = _nearest(mesh, seen, cheeks)[2] < CONTOUR_MARGIN_EYE_DISTANCES * eye_distance(mesh[:, :2])
    beside[list(FACE_OVAL)] = False
    return np.asarray(beside)


def even_depth(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """Depth (478,) of a face's vertices (478, 3); beside the contour and outside of it the contour's own, evened out along it.

    Where the surface goes out of sight it is steep: neighbours in the picture differ much in depth, and turned they would part
    into a serrated edge.
    """
    share = _even_band(mesh, DEPTH_BAND_EYE_DISTANCES)[:, 0]
    contour = _neighbours(mesh, np.isin(np.arange(len(mesh)), FACE_OVAL)) @ mesh[:, 2]
    return np.asarray(share * contour + (1 - share) * mesh[:, 2])


def even_expression(mesh: NDArray[np.floating], usable: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(478, 478) evens what a face's vertices do beside the motion of their head out: products with (478, ...).

    Where a face goes out of sight its tracked vertices slide along the contour, each by itself; carried over as they are, the
    outline gets teeth. So there each of them does what its neighbours in the picture do together: nothing from the forehead to
    the cheekbones, which belong to the skull, all of it at the jaw. `usable` (478,) are those that count.
    """
    share = _even_band(mesh, EVEN_BAND_EYE_DISTANCES)
    eyes, chin = eyes_and_chin(mesh)
    below = (mesh[:, :2] - eyes) @ (chin - eyes) / float((chin - eyes) @ (chin - eyes))
    jaw = smoothstep(below, *JAW_CHIN_LENGTHS)[:, None]
    return np.asarray(share * jaw * _neighbours(mesh, usable) + (1 - share) * np.eye(len(mesh)))


def _neighbours(mesh: NDArray[np.floating], usable: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(478, 478) means over the usable vertices around each."""
    apart = np.linalg.norm(mesh[:, None, :2].astype(float) - mesh[None, :, :2], axis=2) / eye_distance(mesh[:, :2])
    near = np.exp(-0.5 * (apart / EVEN_SPREAD_EYE_DISTANCES) ** 2) * usable
    return np.asarray(near / near.sum(axis=1, keepdims=True))


def _even_band(mesh: NDArray[np.floating], band: float) -> NDArray[np.float64]:
    """(478, 1) how far each vertex lies beside the contour, within `band` eye distances, or outside of it."""
    unit = float(eye_distance(mesh[:, :2]))
    return 1 - smoothstep(-rim_distance(mesh, mesh[:, :2]) / unit, 0, band)[:, None]


def keep_inside(faces: NDArray[np.floating], rest: NDArray[np.floating], seen: NDArray[np.bool_]) -> None:
    """Keep vertices of faces (N, 478, 2) beside the cheeks' contour inside it, evenly, in place.

    `rest` (478, 2 or 3) is the same face at rest: a vertex's distance there, from the same spot of the contour, tells how
    far from it it may lie, where that is `seen` (478,). The contour first goes out to where it leaves room for all.
    """
    oval, unit, at_rest = list(FACE_OVAL), float(eye_distance(rest[:, :2])), rest[None, :, :2].astype(float)
    edge, share, apart = _nearest(rest, seen, (CONTOUR_WEIGHTS + np.roll(CONTOUR_WEIGHTS, -1)) > 0)
    band = _Band(np.arange(len(rest)), edge, share)
    own = band.depth(at_rest, band.inward(at_rest))[0]
    inside = np.flatnonzero((own > 0) & (apart < FADE_OUT_EYE_DISTANCES * unit))
    band, own, near = (
        _Band(inside, edge[inside], share[inside]),
        own[inside],
        apart[inside] < KEPT_INSIDE_EYE_DISTANCES * unit,
    )

    inward = band.inward(faces)
    past = np.maximum(MIN_KEPT_SHARE * own - band.depth(faces, inward), 0) * near
    along = np.linalg.norm(at_rest[0, oval, None] - band.at_spots(at_rest[:, oval])[0], axis=2) / (
        CONTOUR_FALLOFF_EYE_DISTANCES * unit
    )
    out = (past[:, None] * np.exp(-(along**2))).max(axis=2, initial=0)
    for _ in range(CONTOUR_SMOOTHING_ROUNDS):
        out = (np.roll(out, 1, axis=1) + 2 * out + np.roll(out, -1, axis=1)) / 4
    faces[:, oval] -= (out * CONTOUR_WEIGHTS * seen[oval])[..., None] * _inward(faces[:, oval])

    depth = band.depth(faces, inward)
    right = np.linalg.norm(at_rest[0, inside, None] - at_rest[0, list(EAR_VERTICES)], axis=2).argmin(axis=1) == 0
    stretch = np.where(right, *(_stretch(depth / own, side & ~near) for side in (right, ~right)))
    way = np.clip(depth, MIN_KEPT_SHARE * own, MAX_DISTANCE_GAIN * stretch * own) - depth
    faces[:, inside] += (way * near * band.at_spots(CONTOUR_WEIGHTS[None, :, None])[0, :, 0])[..., None] * inward


def _stretch(ratios: NDArray[np.floating], chosen: NDArray[np.bool_]) -> NDArray[np.floating]:
    """(N, 1) the mean of the chosen (K,) among ratios (N, K), at least 1."""
    return np.maximum(ratios[:, chosen].sum(axis=1, keepdims=True) / max(int(chosen.sum()), 1), 1)


def outward(ring: NDArray[np.floating]) -> NDArray[np.floating]:
    """(N, 36, 2) the way out of faces at their contour's vertices (N, 36, 2), of length 1."""
    return -_inward(ring)


def _inward(ring: NDArray[np.floating]) -> NDArray[np.floating]:
    """(N, 36, 2) the way into faces at their contour's vertices (N, 36, 2), of length 1."""
    forward = np.roll(ring, -1, axis=1) - np.roll(ring, 1, axis=1)
    return np.asarray(forward[..., ::-1] * (-1, 1) / np.linalg.norm(forward, axis=2, keepdims=True))


def _nearest(
    mesh: NDArray[np.floating],
    seen: NDArray[np.bool_],
    edges: NDArray[np.bool_],
    points: NDArray[np.floating] | None = None,
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Which spot of some seen edges (36,) of the contour is next to each of points (P, 2), or to each vertex. Returns
    its edge (P,), its share of the way along that, and how far away it is, pixels; nowhere if none is seen."""
    places = mesh[:, :2] if points is None else points
    oval = list(FACE_OVAL)
    ring = mesh[oval, :2].astype(float)
    way = np.roll(ring, -1, axis=0) - ring
    to = places[:, None] - ring
    along = np.clip((to * way).sum(axis=2) / (way**2).sum(axis=1), 0, 1)
    apart = np.linalg.norm(to - along[..., None] * way, axis=2)
    apart[:, ~(edges & seen[oval] & np.roll(seen[oval], -1))] = np.inf
    edge = apart.argmin(axis=1)
    spots = np.arange(len(places)), edge
    return edge, along[spots], apart[spots]
