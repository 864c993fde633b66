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
from engine.body.fitting.contour import CONTOUR_POINTS, SkinPoints, match_contour
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.fitting.observation import DIRECTED_LIMBS, LANDMARK_SIGMA, Crossing, Observation
from engine.body.fitting.pose_prior import joint_limits, pose_prior
from engine.body.fitting.posing import BodyPoser, PosedBodies, rotation_matrices
from engine.body.landmarks import LandmarkModel
from engine.geometry.camera import Camera
from engine.geometry.joint_names import SIDES

LANDMARK_CUTOFF = 4.0
"""Deviations at which a landmark's pull is at its strongest (Geman-McClure)."""
DIRECTION_SIGMA = np.array([[0.25, 0.25, 0.35]] * 4 + [[0.25, 0.25, 1.2]] * 4)
"""How far the directions of `DIRECTED_LIMBS` are off, usually (the difference of unit vectors). Perception has legs lean away from
the viewer, by half a right angle at times: only where they bend much is it to be believed."""
TRUNK_LEAN_SIGMA = 0.12
"""How much trunks lean towards the viewer or away, usually (the z of unit vectors): cameras look level at people who stand.
From one picture alone somebody who leans is somebody with shorter legs."""
LEGS_LEAN_SIGMA = 0.14
"""How much both legs together lean towards the viewer or away, usually (the z of unit vectors)."""
LEGS_APART_SIGMA = 0.2
"""How far perception is off, usually, in how much one leg leads before the other (the difference of their z): what it has both
lean too much cancels out."""
BALANCE_SIGMA = 0.07
"""Metres by which the ankles' middle is before or behind the hips, usually: else one would fall."""
CLOTHED_SIGMA = 0.02
"""How far the body stays behind the contour, usually, as a share of its height: clothes."""
SKIN_SIGMA = 0.01
"""How far the body stands out of the contour, usually, as a share of its height."""
CONTOUR_CUTOFF = 2.0
"""Deviations at which the pull of a contour is at its strongest: skirts and coats say little about who wears them."""
INDEPENDENT_CONTOUR_POINTS = 60.0
"""Independent measurements that all points of a contour count as together."""
CROSSING_DEPTH = 0.09
"""Metres by which the middle of one forearm is before that of another that it crosses, at least."""
CROSSING_SIGMA = 0.01
"""Metres by which it may fall short of that, usually."""
CONTOUR_ROUNDS = 4
"""How often contours are matched anew."""
STEPS_PER_ROUND = 4
"""Steps of the search for each match of the contours, at most."""
MIN_DEPTH = 0.1
"""Metres from a camera at which bodies end: a search may lead through it."""


@dataclass(frozen=True)
class Fit:
    """The template fitted to a person.

    `coefficients` (K,) of the body space.
    `rotations` (J, 3, 3): each joint's turn in its parent's axes (the world's, at rest).
    `root_translation` (3,) metres: the root joint in the world of the cameras. A single camera at the origin sees it there:
    x right, y up, -z away.
    `reprojection`: the root mean square distance in pixels of the landmarks that were believed.
    `parameters` (P,): all of it as it was sought.
    """

    coefficients: NDArray[np.float32]
    rotations: NDArray[np.float32]
    root_translation: NDArray[np.float32]
    reprojection: float
    parameters: NDArray[np.float64]


@dataclass(frozen=True)
class ContourMatches:
    """Points of the body's surface and what they should lie on.

    `skin`: R points of the surface.
    `points` (R, 2): the points of the contour that they meet, pixels.
    `normals` (R, 2): the contour's there, outwards.
    """

    skin: SkinPoints
    points: NDArray[np.float64]
    normals: NDArray[np.float64]


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
    rough = tuple(replace(view, landmark_sigma=max(LANDMARK_SIGMA, view.landmark_sigma)) for view in views)
    unmatched = (None,) * len(views)
    parameters = levenberg_marquardt(
        partial(_residuals, poser, landmarks, rough, unmatched), np.asarray(start, np.float64)
    )
    if any(view.landmark_sigma < LANDMARK_SIGMA for view in views):
        # near the end only: robust penalties pull no more at what is many deviations off
        parameters = levenberg_marquardt(partial(_residuals, poser, landmarks, views, unmatched), parameters)
    if skin is not None and any(view.contour is not None and len(view.contour.points) for view in views):
        for _ in range(CONTOUR_ROUNDS):
            posed = poser(parameters[None])
            matches = tuple(_match(posed, view, skin) for view in views)
            parameters = levenberg_marquardt(
                partial(_residuals, poser, landmarks, views, matches), parameters, STEPS_PER_ROUND
            )
    return _fit(poser, landmarks, views, parameters)


def _match(posed: PosedBodies, view: Observation, skin: SkinPoints) -> ContourMatches | None:
    """The parts of the skin that a contour's points ask for, as the body stands now."""
    if view.contour is None or not len(view.contour.points):
        return None
    pixels = _project(posed.carry(skin), view.camera)[0]
    normals = (posed.world_rotations[0, skin.joints] @ skin.normals[..., None])[..., 0]
    which, at = match_contour(view.contour, pixels, _seen_from(view.camera, normals) * [1, -1, 1], view.height)
    return ContourMatches(skin.subset(at), view.contour.points[which], view.contour.normals[which])


def _fit(
    poser: BodyPoser, landmarks: LandmarkModel, views: Sequence[Observation], parameters: NDArray[np.float64]
) -> Fit:
    root_translation, rotation_vectors, coefficients = poser.split(parameters)
    rotations = np.broadcast_to(np.eye(3), (len(poser.space.names), 3, 3)).copy()
    rotations[poser.fitted] = rotation_matrices(rotation_vectors)
    points = poser(parameters[None]).carry(landmarks)
    off = np.concatenate([
        (_project(points, view.camera)[0] - view.points)[view.confidence > 0.5] for view in views
    ])  # fmt: skip
    error = float(np.sqrt((off**2).sum(-1).mean())) if len(off) else 0.0
    return Fit(
        coefficients.astype(np.float32),
        rotations.astype(np.float32),
        root_translation.astype(np.float32),
        error,
        parameters,
    )


def _project(points: NDArray[np.float64], camera: Camera) -> NDArray[np.float64]:
    """(..., 3) metres to (..., 2) pixels."""
    return camera.project(points, np.float64, MIN_DEPTH)[..., :2]


def _seen_from(camera: Camera, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (..., 3) of the world in the camera's axes: x right, y up, z to the viewer."""
    return np.asarray(vectors @ np.array(camera.axes).T)


def _residuals(
    poser: BodyPoser,
    landmarks: LandmarkModel,
    views: Sequence[Observation],
    matches: Sequence[ContourMatches | None],
    parameters: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(N, R): what is to be small, in standard deviations."""
    posed = poser(parameters)
    points = posed.carry(landmarks)
    _, rotation_vectors, coefficients = poser.split(parameters)
    data: list[NDArray[np.float64]] = []
    for view, matched in zip(views, matches, strict=True):
        data += _data_terms(view, posed.joints, points, poser.space.names)
        if matched is not None:
            data.append(_contour_term(matched, posed, view))
    share = 1 / np.sqrt(len(views))  # one prior for one body, however often it is seen
    stands = [share * term for view in views for term in _stance_terms(view, posed.joints, poser.space.names)]
    prior = [pose_prior(rotation_vectors), joint_limits(rotation_vectors), coefficients]
    return np.concatenate([*data, *stands, *prior], axis=1)


def _data_terms(
    view: Observation, joints: NDArray[np.float64], points: NDArray[np.float64], names: Sequence[str]
) -> list[NDArray[np.float64]]:
    """Each (N, R): landmarks, directions of limbs and crossed forearms as a view has them."""
    count = len(joints)
    off = (_project(points, view.camera) - view.points) / (view.landmark_sigma * view.height)
    squared = (off**2).sum(-1, keepdims=True)
    off = off * np.sqrt(view.confidence[:, None] / (1 + squared / LANDMARK_CUTOFF**2))
    limbs = (_limbs(view, joints, names) - view.directions) * np.sqrt(view.direction_confidence)[:, None]
    data = [off.reshape(count, -1), (limbs / DIRECTION_SIGMA).reshape(count, -1)]
    if view.crossing is not None:
        data.append(_crossing_term(view.crossing, -view.camera.depth(joints), names))
    return data


def _stance_terms(view: Observation, joints: NDArray[np.float64], names: Sequence[str]) -> list[NDArray[np.float64]]:
    """Each (N, R): what one view does not show, how people stand along its axis."""
    legs = _limbs(view, joints, names)[:, 4:, 2].reshape(-1, 2, 2)  # sides, thigh and shin
    believed = np.minimum(view.direction_confidence[4:6], view.direction_confidence[6:])
    apart = (legs[:, 0] - legs[:, 1] - (view.directions[4:6, 2] - view.directions[6:, 2]) * believed) / LEGS_APART_SIGMA
    trunk = joints[:, names.index("Neck")] - joints[:, names.index("Hips")]
    lean = _seen_from(view.camera, trunk)[:, 2] / np.linalg.norm(trunk, axis=-1) / TRUNK_LEAN_SIGMA
    nearness = -view.camera.depth(joints)
    ankles = [names.index(f"{side}Foot") for side in SIDES]
    stance = (nearness[:, ankles].mean(1) - nearness[:, names.index("Hips")]) / BALANCE_SIGMA
    return [lean[:, None], stance[:, None], legs.mean(1) / LEGS_LEAN_SIGMA, apart]


def _limbs(view: Observation, joints: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, M, 3) the directions of `DIRECTED_LIMBS` in the camera's axes."""
    starts, ends = ([names.index(limb[end]) for limb in DIRECTED_LIMBS] for end in (0, 1))
    limbs = joints[:, ends] - joints[:, starts]
    limbs /= np.linalg.norm(limbs, axis=-1, keepdims=True)
    return _seen_from(view.camera, limbs)


def _crossing_term(crossing: Crossing, nearness: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, 1 or 2) how far the arm that is before the other is from being so, in standard deviations: its forearm before the
    other, and its upper arm before the other's hand if that is tucked. `nearness` (N, J) of joints, metres."""
    front, back = (("Left", "Right")[side] for side in (crossing.front, 1 - crossing.front))

    def along(side: str, start: str, share: float) -> NDArray[np.float64]:
        ends = ("Arm", "ForeArm", "Hand")
        near, far = (nearness[:, names.index(f"{side}{end}")] for end in (start, ends[ends.index(start) + 1]))
        return np.asarray(near + share * (far - near))

    gaps = [along(front, "ForeArm", crossing.front_at) - along(back, "ForeArm", crossing.back_at)]
    if crossing.tucked_at is not None:
        gaps.append(along(front, "Arm", crossing.tucked_at) - along(back, "ForeArm", 1.0))
    return np.asarray(np.maximum(CROSSING_DEPTH - np.stack(gaps, 1), 0) / CROSSING_SIGMA)


def _contour_term(matches: ContourMatches, posed: PosedBodies, view: Observation) -> NDArray[np.float64]:
    """(N, R) how far the skin is from the contour that it meets, in standard deviations: of clothes, or of skin."""
    across = ((_project(posed.carry(matches.skin), view.camera) - matches.points) * matches.normals).sum(-1)
    off = across / (np.where(across > 0, SKIN_SIGMA, CLOTHED_SIGMA) * view.height)
    return np.asarray(off * np.sqrt(INDEPENDENT_CONTOUR_POINTS / CONTOUR_POINTS / (1 + off**2 / CONTOUR_CUTOFF**2)))
