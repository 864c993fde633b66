"""Fitting the template to a person in one picture or several: pose, shape and place from landmarks.

The role of F. Bogo et al., Keep it SMPL: Automatic Estimation of 3D Human Pose and Shape from a Single Image, ECCV 2016,
with other data terms. Besides the landmarks in the picture (their equation 2, with the same robust penalty) these are the
directions of limbs in space as perception believes them, and the contour of the person's mask. The directions settle what
lies in front and what behind. Priors keep joints within what bodies can do (their 3.2) and the shape near the mean
(equation 6). Several views add up their data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.body.fitting.contour import SkinPoints, match_contour
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.fitting.observation import LANDMARK_SIGMA_SHARE, Observation
from engine.body.fitting.posing import BodyPoser, PosedBodies, rotation_matrices
from engine.body.fitting.residuals import ContourMatches, project, residuals, seen_from
from engine.body.landmarks import LandmarkModel

CONTOUR_ROUNDS = 4
"""How often contours are matched anew."""
STEPS_PER_ROUND = 4
"""Steps of the search for each match of the contours, at most."""


@dataclass(frozen=True)
class Fit:
    """The template fitted to a person.

    coefficients : (K,) of the body space.
    rotations : (J, 3, 3) each joint's turn in its parent's axes (the world's, at rest).
    root_translation : (3,) metres, the root joint in the world of the cameras. A single camera at the origin sees it there:
        x right, y up, -z away.
    reprojection : the root mean square distance in pixels of the landmarks that were believed.
    parameters : (P,) all of it as it was sought.
    """

    coefficients: NDArray[np.float32]
    rotations: NDArray[np.float32]
    root_translation: NDArray[np.float32]
    reprojection: float
    parameters: NDArray[np.float64]


def fit_body(
    space: BodySpace,
    landmarks: LandmarkModel,
    views: Observation | Sequence[Observation],
    start: NDArray[np.floating],
    skin: SkinPoints | None = None,
) -> Fit:
    """Fit pose, shape and place to what is seen of a person, who stands still while all `views` are taken.

    `start` (P,): first guess (`engine.body.fitting.first_guess.first_guess`), from any of the views. `skin`: what is to meet the
    contours of those views that have one.
    """
    views = (views,) if isinstance(views, Observation) else tuple(views)
    if not views:
        raise ValueError("a body is fitted to one view at least")
    poser = BodyPoser(space)
    rough = tuple(replace(view, landmark_sigma=max(LANDMARK_SIGMA_SHARE, view.landmark_sigma)) for view in views)
    unmatched = (None,) * len(views)
    parameters = levenberg_marquardt(
        partial(residuals, poser, landmarks, rough, unmatched), np.asarray(start, np.float64)
    )
    if any(view.landmark_sigma < LANDMARK_SIGMA_SHARE for view in views):
        # near the end only: robust penalties pull no more at what is many deviations off
        parameters = levenberg_marquardt(partial(residuals, poser, landmarks, views, unmatched), parameters)
    if skin is not None and any(view.contour is not None and len(view.contour.points) for view in views):
        for _ in range(CONTOUR_ROUNDS):
            posed = poser(parameters[None])
            matches = tuple(_match(posed, view, skin) for view in views)
            parameters = levenberg_marquardt(
                partial(residuals, poser, landmarks, views, matches), parameters, STEPS_PER_ROUND
            )
    return _fit(poser, landmarks, views, parameters)


def _match(posed: PosedBodies, view: Observation, skin: SkinPoints) -> ContourMatches | None:
    """The parts of the skin that a contour's points ask for, as the body stands now."""
    if view.contour is None or not len(view.contour.points):
        return None
    pixels = project(posed.carry(skin), view.camera)[0]
    normals = (posed.world_rotations[0, skin.joints] @ skin.normals[..., None])[..., 0]
    which, at = match_contour(
        view.contour, pixels, seen_from(view.camera, normals) * [1, -1, 1], skin.inside, view.height
    )
    return ContourMatches(skin.subset(at), view.contour.points[which], view.contour.normals[which])


def _fit(
    poser: BodyPoser, landmarks: LandmarkModel, views: Sequence[Observation], parameters: NDArray[np.float64]
) -> Fit:
    root_translation, rotation_vectors, coefficients = poser.split(parameters)
    rotations = np.broadcast_to(np.eye(3), (len(poser.space.names), 3, 3)).copy()
    rotations[poser.fitted] = rotation_matrices(rotation_vectors)
    points = poser(parameters[None]).carry(landmarks)
    off = np.concatenate([
        (project(points, view.camera)[0] - view.points)[view.confidence > 0.5] for view in views
    ])  # fmt: skip
    error = float(np.sqrt((off**2).sum(-1).mean())) if len(off) else 0.0
    return Fit(
        coefficients.astype(np.float32),
        rotations.astype(np.float32),
        root_translation.astype(np.float32),
        error,
        parameters,
    )
