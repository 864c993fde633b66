"""The head turned as the face says it is: the paper's head pose correction (section 5, first half).

The 68 fiducials are known on the template's face by laying a canonical face mesh on it; where they are seen in the picture,
the head's turn follows by PnP. Skipped where no face is seen.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.body import load_template
from engine.body.landmarks import surface_points
from engine.character.figure import Figure
from engine.character.template_fit import FittedBody, load_human
from engine.perception.head_pose import canonical_face
from engine.perception.landmarks import fiducials

FLIP = np.diag([1.0, -1.0, -1.0])
"""From axes with y up and z to the viewer to those of a camera, and back."""
ROUNDS = 12
"""Rounds in which the canonical face is laid on the template's."""
OFF = 0.2
"""Distances of the eyes by which fiducials may be off on the average; beyond, the face is not believed."""
TURN = 70.0
"""Degrees by which the face may correct what the body's fit says."""


@cache
def face_vertices() -> NDArray[np.intp]:
    """(68,) the template's vertices at which the fiducials are."""
    human = load_human()
    template = load_template()
    mesh = human.space.mean.astype(np.float64)
    points = surface_points(template, human.space, human.rig)
    left, right = (mesh[points[f"{side}Eye"]].mean(0) for side in ("Left", "Right"))
    middle, unit = (left + right) / 2, float(np.linalg.norm(left - right))
    body = template.vertices_of("body")
    near = body[np.linalg.norm(mesh[body] - middle, axis=1) < 2.5 * unit]
    face = near[mesh[near, 2] > middle[2] - 0.6 * unit]
    laid = canonical_face().astype(np.float64) @ FLIP * unit + middle
    laid += mesh[points["Nose"]].mean(0) - laid[1]
    tree = cKDTree(mesh[face])
    for _ in range(ROUNDS):
        laid = _similar(laid, mesh[face][tree.query(laid)[1]])
    return np.asarray(face[tree.query(fiducials(laid))[1]])


def _similar(points: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points moved, turned and scaled so as to come as near as they can to their targets (S. Umeyama, 1991)."""
    a, b = points - points.mean(0), target - target.mean(0)
    turn = Rotation.align_vectors(b, a)[0]
    scale = np.sqrt((b**2).sum() / (a**2).sum())
    return np.asarray(scale * turn.apply(a) + target.mean(0))


def turn_head(fitted: FittedBody, figure: Figure) -> FittedBody:
    """The fit with its head turned as the figure's face is; as it was where there is no face, or none to be believed."""
    if figure.face is None:
        return fitted
    fit, human = fitted.fit, load_human()
    rest, heads = human.space.vertices(fit.coefficients), human.space.joints(fit.coefficients)
    head = human.rig.index("Head")
    worlds, places = _worlds(human.rig.parents, fit.rotations, heads, fit.place)
    model = (rest[face_vertices()] - heads[head]).astype(np.float64)
    seen = fiducials(figure.face[:, :2]).astype(np.float64)
    camera = np.array([[fitted.focal, 0, fitted.centre[0]], [0, fitted.focal, fitted.centre[1]], [0, 0, 1]])
    start = cv2.Rodrigues(FLIP @ worlds[head])[0]
    found, vector, shift = cv2.solvePnP(
        model, seen, camera, np.zeros(4), start, (FLIP @ places[head])[:, None].copy(), True, cv2.SOLVEPNP_ITERATIVE
    )
    if not found:
        return fitted
    back = cv2.projectPoints(model, vector, shift, camera, np.zeros(4))[0][:, 0]
    eyes = float(np.linalg.norm(seen[36:42].mean(0) - seen[42:48].mean(0)))
    turned = FLIP @ cv2.Rodrigues(vector)[0]
    away = np.degrees(np.arccos(np.clip((np.trace(worlds[head].T @ turned) - 1) / 2, -1, 1)))
    if np.sqrt(((back - seen) ** 2).sum(1).mean()) > OFF * eyes or away > TURN or shift[2, 0] <= 0:
        return fitted
    rotations = fit.rotations.copy()
    rotations[head] = worlds[human.rig.parents[head]].T @ turned
    return replace(fitted, fit=replace(fit, rotations=rotations))


def _worlds(
    parents: NDArray[np.integer],
    rotations: NDArray[np.floating],
    heads: NDArray[np.floating],
    place: NDArray[np.floating],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Each joint's axes (J, 3, 3) and place (J, 3) in the world."""
    axes = np.empty((len(parents), 3, 3))
    places = np.empty((len(parents), 3))
    for joint, parent in enumerate(parents):
        if parent < 0:
            axes[joint], places[joint] = rotations[joint], place
        else:
            axes[joint] = axes[parent] @ rotations[joint]
            places[joint] = places[parent] + axes[parent] @ (heads[joint] - heads[parent])
    return axes, places
