"""The head turned as the face says it is: the paper's head pose correction (section 5, first half).

The 68 fiducials are known on the template's face (`engine.body.face.face_points`); where they are seen in the picture, the head's
turn follows by PnP. Skipped where no face is seen.
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
from engine.perception.landmarks import fiducials

MAX_FIDUCIAL_ERROR_EYE_DISTANCES = 0.2
"""Distances of the eyes by which fiducials may be off on the average; beyond, the face is not believed."""
MAX_HEAD_CORRECTION_DEGREES = 70.0
"""Degrees by which the face may correct what the body's fit says."""


def turn_head(fitted: FittedBody, figure: Figure) -> FittedBody:
    """The fit with its head turned as the figure's face is. It is as it was where there is no face, or none to be
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
    rotations = fit.rotations.copy()
    rotations[head] = worlds[human.rig.parents[head]].T @ turned
    return replace(fitted, fit=replace(fit, rotations=rotations))


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
