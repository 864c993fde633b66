"""Which expressions a collection shows, and how strongly: by what its photographs' points do, in terms of face units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.optimize import nnls

from engine.perception.landmarks import FACE_OVAL
from engine.persona.collection.coverage import MIN_PHOTOS_OF_EXPRESSION
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSIONS, FaceUnits
from engine.persona.texture.expression_weights import expression_points

LEAST_DONE = 0.4
"""Of an expression as `EXPRESSIONS` has it, that a photograph near it does."""
LEAST_LIKENESS = 0.4
"""Cosine between what its points do and what the expression does, of a photograph near it."""
LEAST_OF_MOST = 0.6
"""Of its likeness to what it is most like: who smiles with narrow eyes is not angry."""
RIDGE = 0.02
"""Eye distances of all points together, that a unit at its full costs: what one unit tells is not told by many."""
BENDING = 1e-3
"""How smooth the spline is: upper and lower lip touch, and are moved apart."""
MOST_PHOTOS = 16
"""Of those near an expression that say what it is, the strongest first."""


@dataclass(frozen=True)
class ShownExpression:
    """name : of `EXPRESSIONS`. photos : those near it, the strongest first. face : (478, 3) float64, in eye distances. weights : (N,)
    how much each photograph counts in its texture."""

    name: str
    photos: tuple[int, ...]
    face: NDArray[np.float64]
    weights: NDArray[np.float32]


def photos_near(persona: Persona, units: FaceUnits) -> Mapping[str, tuple[int, ...]]:
    """The photographs near each of `EXPRESSIONS`, the strongest first."""
    rest = expression_points(persona.neutral[None])[0]
    faces = np.array([persona.neutral + units.doing(mixture) for mixture in EXPRESSIONS.values()])
    wanted = (expression_points(faces) - rest).reshape(len(faces), -1)
    done = (persona.points.astype(np.float64) - rest).reshape(len(persona), -1)
    along = wanted @ done.T
    share = along / (wanted**2).sum(axis=1)[:, None]
    likeness = along / (np.linalg.norm(wanted, axis=1)[:, None] * np.maximum(np.linalg.norm(done, axis=1), 1e-9))
    most = likeness.max(axis=0)
    near = (share > LEAST_DONE) & (likeness > np.maximum(LEAST_LIKENESS, LEAST_OF_MOST * most))
    return {
        name: tuple(sorted(np.flatnonzero(one).tolist(), key=lambda photo: -strong[photo]))
        for name, one, strong in zip(EXPRESSIONS, near, share, strict=True)
    }


def shown_expressions(persona: Persona, units: FaceUnits) -> list[ShownExpression]:
    """Those that enough photographs come near: each as the strongest of these have it in the mean."""
    out = []
    for name, photos in photos_near(persona, units).items():
        if len(photos) < MIN_PHOTOS_OF_EXPRESSION:
            continue
        points = persona.points[list(photos[:MOST_PHOTOS])].astype(np.float64).mean(axis=0)
        face = fitted_face(persona, units, points)
        out.append(ShownExpression(name, photos, face, persona.weights_of_points(points[None])[0]))
    return out


def fitted_face(persona: Persona, units: FaceUnits, points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) the face whose points are `points` (51, 2): the units that come nearest, bent by what they leave; the oval is theirs."""
    face = persona.neutral + units.doing(fitted_units(persona, units, points))
    own = expression_points(face[None])[0]
    known = np.concatenate([own, face[list(FACE_OVAL), :2]])
    left = np.concatenate([points - own, np.zeros((len(FACE_OVAL), 2))])
    bend = RBFInterpolator(known, left, kernel="thin_plate_spline", smoothing=BENDING)
    face[:, :2] += bend(face[:, :2])
    return np.asarray(face)


def fitted_units(persona: Persona, units: FaceUnits, points: NDArray[np.floating]) -> dict[str, float]:
    """The mixture of units, none above its full, that moves the neutral face's points nearest to `points` (51, 2)."""
    rest = expression_points(persona.neutral[None])
    basis = (expression_points(persona.neutral + units.moved) - rest).reshape(len(units.names), -1)
    system = np.concatenate([basis.T, RIDGE * np.eye(len(basis))])
    wanted = np.concatenate([(points - rest[0]).ravel(), np.zeros(len(basis))])
    weights = np.minimum(nnls(system, wanted)[0], 1)
    return {name: float(weight) for name, weight in zip(units.names, weights, strict=True) if weight > 0}
