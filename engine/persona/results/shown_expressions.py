"""Which expressions a collection shows, and how strongly: by what its photographs' points do, in terms of face units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.optimize import nnls

from engine.perception.face.landmarks import FACE_OVAL
from engine.persona.collection.coverage import MIN_PHOTOS_OF_EXPRESSION
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits
from engine.persona.texture.expression_weights import expression_points

MIN_EXPRESSION_STRENGTH = 0.4
"""Of an expression as `EXPRESSION_UNITS` has it, that a photograph near it does."""
MIN_EXPRESSION_COSINE = 0.4
"""Cosine, at least, between what the points of a photograph near an expression do and what the expression does."""
MIN_BEST_LIKENESS_SHARE = 0.6
"""Share of a photograph's likeness to what it is most like: who smiles with narrow eyes is not angry."""
MIN_SAME_EXPRESSION_COSINE = 0.8
"""Cosine from which on two expressions are of a kind, as surprise and an open mouth are."""
EXPRESSION_FACE_POINTS = (slice(0, 10), slice(31, 51))
"""Brows and lips, of the points: an expression that moves both is done by both."""
MIN_REGION_MOTION_EYE_DISTANCES = 0.02
"""Eye distances by which an expression moves the points of a region, in the mean square's root, if it moves it."""
UNIT_COST_EYE_DISTANCES = 0.02
"""Eye distances of all points together, that a unit at its full costs: what one unit tells is not told by many."""
SPLINE_BENDING = 1e-3
"""How smooth the spline is: upper and lower lip touch, and are moved apart."""
MAX_EXPRESSION_PHOTOS = 16
"""Photographs near an expression that say what it is, at most, the strongest first."""


@dataclass(frozen=True)
class ShownExpression:
    """name : of `EXPRESSION_UNITS`.
    photos : those near it, the strongest first.
    face : (478, 3) float64, in eye distances.
    weights : (N,) how much each photograph counts in its texture.
    """

    name: str
    photos: tuple[int, ...]
    face: NDArray[np.float64]
    weights: NDArray[np.float32]


def photos_near(persona: Persona, units: FaceUnits) -> Mapping[str, tuple[int, ...]]:
    """The photographs near each of `EXPRESSION_UNITS`, the strongest first."""
    share, likeness, _ = _done(persona, units, persona.points)
    most = likeness.max(axis=0)
    near = (share > MIN_EXPRESSION_STRENGTH) & (
        likeness > np.maximum(MIN_EXPRESSION_COSINE, MIN_BEST_LIKENESS_SHARE * most)
    )
    return {
        name: tuple(sorted(np.flatnonzero(one).tolist(), key=lambda photo: -strong[photo]))
        for name, one, strong in zip(EXPRESSION_UNITS, near, share, strict=True)
    }


def shown_expressions(persona: Persona, units: FaceUnits) -> list[ShownExpression]:
    """Those that enough photographs come near: each as the strongest of these have it in the mean, if that is then more like it than
    like any other: who frowns in smiling photographs alone is not shown angry."""
    out = []
    for name, photos in photos_near(persona, units).items():
        if len(photos) < MIN_PHOTOS_OF_EXPRESSION:
            continue
        points = persona.points[list(photos[:MAX_EXPRESSION_PHOTOS])].astype(np.float64).mean(axis=0)
        _, likeness, alike = _done(persona, units, points[None])
        own = list(EXPRESSION_UNITS).index(name)
        if likeness[alike[own] < MIN_SAME_EXPRESSION_COSINE, 0].max() > likeness[own, 0]:
            continue
        face = fitted_face(persona, units, points)
        out.append(ShownExpression(name, photos, face, persona.weights_of_points(points[None])[0]))
    return out


def _done(
    persona: Persona, units: FaceUnits, points: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """How faces with `points` (N, 51, 2) do each of `EXPRESSION_UNITS`. Returns three arrays. (E, N) is how much of it
    they do in that of its regions in which they do least. (E, N) is the cosine between what their points do and what it
    does. (E, E) is the cosine between expressions."""
    rest = expression_points(persona.neutral[None])[0]
    faces = np.array([persona.neutral + units.doing(mixture) for mixture in EXPRESSION_UNITS.values()])
    wanted = expression_points(faces) - rest
    done = points.astype(np.float64) - rest
    share = np.full((len(wanted), len(done)), np.inf)
    for region in EXPRESSION_FACE_POINTS:
        own = np.einsum("epk,npk->en", wanted[:, region], done[:, region])
        size = (wanted[:, region] ** 2).sum(axis=(1, 2))
        moved = np.sqrt(size / wanted[:, region].shape[1]) > MIN_REGION_MOTION_EYE_DISTANCES
        share[moved] = np.minimum(share[moved], own[moved] / size[moved, None])
    across = [_directions(one.reshape(len(one), -1)) for one in (wanted, done)]
    return share, across[0] @ across[1].T, across[0] @ across[0].T


def _directions(moved: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(moved / np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), 1e-9))


def fitted_face(persona: Persona, units: FaceUnits, points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) the face whose points are `points` (51, 2): the units that come nearest, bent by what they leave; the oval is theirs."""
    face = persona.neutral + units.doing(fitted_units(persona, units, points))
    own = expression_points(face[None])[0]
    known = np.concatenate([own, face[list(FACE_OVAL), :2]])
    left = np.concatenate([points - own, np.zeros((len(FACE_OVAL), 2))])
    bend = RBFInterpolator(known, left, kernel="thin_plate_spline", smoothing=SPLINE_BENDING)
    face[:, :2] += bend(face[:, :2])
    return np.asarray(face)


def fitted_units(persona: Persona, units: FaceUnits, points: NDArray[np.floating]) -> dict[str, float]:
    """The mixture of units, none above its full, that moves the neutral face's points nearest to `points` (51, 2)."""
    rest = expression_points(persona.neutral[None])
    basis = (expression_points(persona.neutral + units.moved) - rest).reshape(len(units.names), -1)
    system = np.concatenate([basis.T, UNIT_COST_EYE_DISTANCES * np.eye(len(basis))])
    wanted = np.concatenate([(points - rest[0]).ravel(), np.zeros(len(basis))])
    weights = np.minimum(nnls(system, wanted)[0], 1)
    return {name: float(weight) for name, weight in zip(units.names, weights, strict=True) if weight > 0}
