"""Pose and shape from landmarks, then from the points nearest to the template: the coarse fit of section 3.4.

All parameters are sought at once by Gauss and Newton's method, where the paper alternates. Lengths are metres and stay so:
scale and shape are never free together, for then bodies of one and a half metres' scale explain any cloud.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.body_model import BodyModel
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.fitting.pose_prior import MEAN_LOWERED_ARMS_RADIANS, joint_limits, pose_prior
from engine.body.fitting.posing import FITTED_JOINTS
from engine.body.landmarks import LandmarkModel
from engine.errors import InputError
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals
from engine.geometry.point_clouds.point_cloud import PointCloud

COARSE_SHAPE_COEFFICIENTS = 20
"""Directions of the body space in which a body may differ from the mean."""
SHAPE_WEIGHT = 3.0
"""By how much more a coefficient counts than its standard deviation: of the bodies sampled, the few are as odd as clothes are."""
STIFF_JOINTS, STIFF_WEIGHT = ("Spine", "Spine1", "Spine2", "Neck", "Head"), 1 / 0.3
"""Joints that turn less than in other pictures while one stands for a scan, and by how much less."""
LANDMARK_SIGMAS = {
    **dict.fromkeys(("Elbow", "Wrist", "Index", "Pinky"), 0.012),
    **dict.fromkeys(("Knee", "Ankle", "Heel", "FootIndex", "Ear"), 0.04),
    "Hip": 0.06,
}
"""Metres by which landmarks are off, usually, by their names without a side: under clothes, in shoes, and where
perception sees them elsewhere than the template has them."""
USUAL_SIGMA = 0.02
"""Metres by which landmarks without an own entry in `LANDMARK_SIGMAS` are off, usually."""
ROUGH_SIGMA = 0.03
"""What is assumed of landmarks at first, at least."""
COARSE_LANDMARK_CUTOFF_SIGMAS = 6.0
"""Deviations at which a landmark's pull is at its strongest (Geman-McClure)."""
MAX_LANDMARK_RESIDUAL_METRES = 0.12
"""Metres from the fit beyond which a landmark is wrong: right ones come within 0.03, those of another limb are 0.4 off."""
MAX_SIGMAS = 2.5
"""Standard deviations from the fit beyond which a landmark is wrong, where that is more than
`MAX_LANDMARK_RESIDUAL_METRES`."""
MIN_LANDMARKS = 8
SOLE_SIGMA = 0.01
"""Metres by which soles usually reach below the ground. Of feet that the cloud lacks nothing else says where they
are."""
CLOTHED_POINT_SIGMA_METRES = 0.006
"""Metres by which points are off, usually, for clothes."""
INDEPENDENT_CLOUD_POINTS = 500.0
"""As how many independent measurements all points count: clothes are off alike, and sleeves slide arms along, against what landmarks say of hands."""
TANGENTIAL_SHARE = 0.15
"""What an offset along the surface counts of one across it."""
HAND_LANDMARK_WEIGHT = 0.4


@dataclass(frozen=True)
class Round:
    """So many `points` of the cloud are matched within a `gate` (metres) where the normals' cosine is above `facing`."""

    gate: float
    facing: float
    points: int


COARSE_ROUNDS = (*[Round(0.06, 0.3, 4000)] * 5, *[Round(0.04, 0.4, 6000)] * 4, *[Round(0.03, 0.5, 8000)] * 5)
"""The rounds of closest points: gates close and more points are looked at as the body comes nearer."""


@dataclass(frozen=True)
class CoarseFit:
    """parameters : (P,) of `engine.avatar.registration.body_model.BodyModel`.
    residuals : metres from each landmark of the body to where the fit to landmarks alone has it.
    dropped : the names of those that were too far off.
    """

    parameters: NDArray[np.float64]
    residuals: dict[str, float]
    dropped: frozenset[str]


def fit_to_landmarks(model: BodyModel, carried: LandmarkModel, landmarks: SpatialLandmarks) -> CoarseFit:
    """Place, pose and shape by landmarks of the body alone.

    Raises `InputError` with the code `landmarks_needed` where too few landmarks are there or agree.
    """
    names = [name for name in carried.names if name in landmarks.body]
    dropped: set[str] = set()
    for _ in range(3):
        kept = [name for name in names if name not in dropped]
        if len(kept) < MIN_LANDMARKS or len(kept) < len(names) / 2:
            raise InputError(
                "landmarks_needed",
                "Too few landmarks of the body were found or agree: point at them in some frames (`landmarks`).",
                ("landmarks",),
                {"landmarks": sorted(names), "doubtful": sorted(dropped)},
            )
        places = np.stack([landmarks.body[name] for name in kept])
        chosen = np.array([carried.names.index(name) for name in kept])
        parameters = _first_guess(model, carried, chosen, places)
        for least in (ROUGH_SIGMA, 0.0):
            sigmas = np.maximum(_sigmas(kept), least)
            parameters = levenberg_marquardt(partial(_residuals, model, carried, chosen, places, sigmas), parameters)
        at = model.poser(parameters[None]).carry(carried)[0]
        off = {name: float(np.linalg.norm(at[carried.names.index(name)] - landmarks.body[name])) for name in names}
        most = np.maximum(MAX_LANDMARK_RESIDUAL_METRES, MAX_SIGMAS * _sigmas(kept))
        wrong = {name for name, limit in zip(kept, most, strict=True) if off[name] > limit}
        if not wrong:
            break
        dropped |= wrong
    return CoarseFit(parameters, off, frozenset(dropped))


def fit_to_points(
    model: BodyModel,
    carried: LandmarkModel,
    landmarks: SpatialLandmarks,
    cloud: PointCloud,
    start: NDArray[np.float64],
    rounds: Sequence[Round] = COARSE_ROUNDS,
) -> NDArray[np.float64]:
    """The parameters (P,), from `start` (P,), for which the skin is near the cloud as well."""
    names = [name for name in carried.names if name in landmarks.body]
    places = np.stack([landmarks.body[name] for name in names])
    chosen = np.array([carried.names.index(name) for name in names])
    random = np.random.default_rng(0)
    parameters = start
    for turn in rounds:
        picked = random.choice(len(cloud), min(turn.points, len(cloud)), replace=False)
        jacobian, off = _point_term(model, parameters, cloud[picked], turn)
        others = partial(_residuals, model, carried, chosen, places, _sigmas(names))
        now = others(parameters[None])[0]
        slopes = (others(parameters + 1e-4 * np.eye(len(parameters))) - now).T / 1e-4
        hessian = jacobian.T @ jacobian + slopes.T @ slopes
        gradient = jacobian.T @ off + slopes.T @ now
        parameters = parameters - np.linalg.solve(hessian + 1e-3 * np.diag(np.diag(hessian) + 1e-9), gradient)
    return parameters


def _sigmas(names: Sequence[str]) -> NDArray[np.float64]:
    """(L,) metres by which landmarks are off, usually."""
    bare = [name.removeprefix("Left").removeprefix("Right") for name in names]
    return np.array([LANDMARK_SIGMAS.get(name, USUAL_SIGMA) for name in bare])


def _first_guess(
    model: BodyModel, carried: LandmarkModel, chosen: NDArray[np.intp], places: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Arms half lowered, the whole body turned and placed as the landmarks are."""
    rotation_vectors = np.zeros((len(FITTED_JOINTS), 3))
    for side, sign in (("Left", -1), ("Right", 1)):
        rotation_vectors[FITTED_JOINTS.index(f"{side}Arm"), 2] = sign * MEAN_LOWERED_ARMS_RADIANS
    parameters = np.concatenate([np.zeros(3), rotation_vectors.ravel(), np.zeros(model.coefficients)])
    at = model.poser(parameters[None]).carry(carried)[0, chosen]
    turn = Rotation.align_vectors(places - places.mean(0), at - at.mean(0))[0]
    parameters[3:6] = turn.as_rotvec()
    at = model.poser(parameters[None]).carry(carried)[0, chosen]
    parameters[:3] = places.mean(0) - at.mean(0)
    return parameters


def _residuals(
    model: BodyModel,
    carried: LandmarkModel,
    chosen: NDArray[np.intp],
    places: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    parameters: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(N, R) landmarks, priors and the ground in standard deviations, for parameters (N, P)."""
    posed = model.poser(parameters)
    off = (posed.carry(carried)[:, chosen] - places) / sigmas[:, None]
    off = off / np.sqrt(1 + (off**2).sum(-1, keepdims=True) / COARSE_LANDMARK_CUTOFF_SIGMAS**2)
    _, rotation_vectors, coefficients = model.poser.split(parameters)
    stiff = np.array([STIFF_WEIGHT if name in STIFF_JOINTS else 1.0 for name in FITTED_JOINTS[1:]]).repeat(3)
    heights = posed.carry(model.soles)[..., 1]
    return np.concatenate(
        [
            off.reshape(len(off), -1),
            pose_prior(rotation_vectors) * stiff,
            joint_limits(rotation_vectors),
            SHAPE_WEIGHT * coefficients,
            np.minimum(heights, 0) / SOLE_SIGMA,
        ],
        axis=1,
    )


def _point_term(
    model: BodyModel, parameters: NDArray[np.float64], cloud: PointCloud, turn: Round
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The Jacobian (3 M, P) and the residuals (3 M,) of the points that are matched, in standard deviations."""
    skin = model.skin
    vertices = model.vertices(parameters)
    candidates = skin.triangles[skin.visible]
    nearest = closest_points(cloud.points, vertices, candidates)
    normals = face_normals(vertices, candidates)[nearest.triangle]
    used = (nearest.distance < 2 * turn.gate) & ((normals * cloud.normals).sum(1) > turn.facing)
    corners, shares = candidates[nearest.triangle[used]], nearest.barycentrics[used]
    between = normals[used] + cloud.normals[used]
    between /= np.linalg.norm(between, axis=1, keepdims=True)
    weights = 1 / (1 + (nearest.distance[used] / turn.gate) ** 2)
    weights *= np.where(skin.regions["hands"][corners].all(1), HAND_LANDMARK_WEIGHT, 1.0)
    scale = np.sqrt(weights * INDEPENDENT_CLOUD_POINTS / max(len(weights), 1)) / CLOTHED_POINT_SIGMA_METRES
    across = np.hypot(1, TANGENTIAL_SHARE) - TANGENTIAL_SHARE
    metric = TANGENTIAL_SHARE * np.eye(3) + across * between[:, :, None] * between[:, None, :]
    metric *= scale[:, None, None]
    chosen, at = np.unique(corners, return_inverse=True)
    slopes = model.derivatives(parameters, chosen)[at.reshape(-1, 3)]
    moved = np.einsum("mk,mkap->map", shares, slopes)
    off = np.einsum("mk,mka->ma", shares, vertices[corners]) - cloud.points[used]
    jacobian = metric @ moved
    return jacobian.reshape(-1, len(parameters)), np.einsum("mab,mb->ma", metric, off).ravel()
