"""The head turned as the face says it is: the paper's head pose correction (section 5, first half).

The 68 fiducials are known on the template's face (`engine.body.face.face_points`); where they are seen in the picture, the head's
turn and place follow by PnP. Beyond the paper, the neck is bent so that the head is there. Skipped where no face is seen.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.face.face_points import PICTURE_TO_TEMPLATE
from engine.character.figure.face_region import in_profile
from engine.character.figure.figure import Figure
from engine.character.fit.template_fit import FittedBody, load_human
from engine.perception.face.landmarks import fiducials

MAX_FIDUCIAL_ERROR_EYE_DISTANCES = 0.2
"""Distances of the eyes by which fiducials may be off on the average; beyond, the face is not believed."""
MAX_HEAD_CORRECTION_DEGREES = 70.0
"""Degrees by which the face may correct what the body's fit says."""
MAX_NECK_CORRECTION_DEGREES = 25.0
"""Degrees by which the neck is bent at most, so that the head is where the face is seen."""


def turn_head(fitted: FittedBody, figure: Figure) -> FittedBody:
    """The fit with its head turned and placed as the figure's face is. It is as it was where there is no face, or none to be
    believed: of one in profile the network makes up the half that is not seen."""
    if figure.face is None or in_profile(figure):
        return fitted
    fit, human = fitted.fit, load_human()
    rest, heads = human.space.vertices(fit.coefficients), human.space.joints(fit.coefficients)
    head = human.rig.index("Head")
    worlds, places = joint_axes(human.rig.parents, fit.rotations, heads, fit.root_translation)
    model = (rest[human.face] - heads[head]).astype(np.float64)
    seen = fiducials(figure.face[:, :2]).astype(np.float64)
    camera = fitted.camera.intrinsics
    start = cv2.Rodrigues(PICTURE_TO_TEMPLATE @ worlds[head])[0]
    found, vector, shift = cv2.solvePnP(
        model,
        seen,
        camera,
        np.zeros(4),
        start,
        (PICTURE_TO_TEMPLATE @ places[head])[:, None].copy(),
        True,
        cv2.SOLVEPNP_ITERATIVE,
    )
    if not found:
        return fitted
    back = cv2.projectPoints(model, vector, shift, camera, np.zeros(4))[0][:, 0]
    eyes = float(np.linalg.norm(seen[36:42].mean(0) - seen[42:48].mean(0)))
    turned = PICTURE_TO_TEMPLATE @ cv2.Rodrigues(vector)[0]
    away = np.degrees(np.arccos(np.clip((np.trace(worlds[head].T @ turned) - 1) / 2, -1, 1)))
    if (
        np.sqrt(((back - seen) ** 2).sum(1).mean()) > MAX_FIDUCIAL_ERROR_EYE_DISTANCES * eyes
        or away > MAX_HEAD_CORRECTION_DEGREES
        or shift[2, 0] <= 0
    ):
        return fitted
    seen_at = PICTURE_TO_TEMPLATE.T @ (shift[:, 0] * ((PICTURE_TO_TEMPLATE @ places[head])[2] / shift[2, 0]))
    neck = human.rig.index("Neck")
    bent = _turn_towards(places[head] - places[neck], seen_at - places[neck]) @ worlds[neck]
    rotations = fit.rotations.copy()
    rotations[neck] = worlds[human.rig.parents[neck]].T @ bent
    rotations[head] = bent.T @ turned
    return replace(fitted, fit=replace(fit, rotations=rotations))


def _turn_towards(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smallest turn (3, 3) that takes the direction of `one` (3,) to that of the `other` (3,), up to `MAX_NECK_CORRECTION_DEGREES`."""
    axis = np.cross(one, other)
    sine, cosine = float(np.linalg.norm(axis)), float(one @ other)
    angle = min(np.arctan2(sine, cosine), np.radians(MAX_NECK_CORRECTION_DEGREES))
    return np.asarray(cv2.Rodrigues(axis / max(sine, 1e-12) * angle)[0])


def joint_axes(
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
