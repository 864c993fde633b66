"""What a fit makes small: each of its terms in standard deviations, for many parameters at once.

See `engine.body.fitting.body_fitting` for where they come from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.contour import CONTOUR_POINTS, SEARCH_INSIDE_SHARE, SkinPoints
from engine.body.fitting.observation import DIRECTED_LIMBS, Crossing, Observation
from engine.body.fitting.pose_prior import joint_limits, pose_prior
from engine.body.fitting.posing import BodyPoser, PosedBodies
from engine.body.landmarks import LandmarkModel
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES

LANDMARK_CUTOFF_SIGMAS = 4.0
"""Deviations at which a landmark's pull is at its strongest (Geman-McClure)."""
LIMB_DIRECTION_SIGMA = np.array([[0.25, 0.25, 0.25]] * 4 + [[0.25, 0.25, 1.2]] * 4)
"""How far the directions of `DIRECTED_LIMBS` are off, usually (the difference of unit vectors). Perception has legs lean away from
the viewer, by half a right angle at times: only where they bend much is it to be believed."""
TRUNK_LEAN_SIGMA = 0.07
"""How much trunks lean towards the viewer or away, usually (the z of unit vectors): cameras look level at people who stand.
From one picture alone somebody who leans is somebody with shorter legs."""
LEGS_LEAN_SIGMA = 0.14
"""How much both legs together lean towards the viewer or away, usually (the z of unit vectors)."""
LEGS_APART_SIGMA = 0.2
"""How far perception is off, usually, in how much one leg leads before the other (the difference of their z): what it has both
lean too much cancels out."""
BALANCE_SIGMA = 0.07
"""Metres by which the ankles' middle is before or behind the hips, usually: else one would fall."""
FOOT_LANDMARKS = ("Ankle", "Heel", "FootIndex")
FOOT_SIGMA = 0.03
"""How far the landmarks of a foot are off together, usually, as a share of the body's height: perception has feet too high on legs
that are longer than it expects."""
CLOTHED_SIGMA = 0.012
"""How far the body stays behind the contour, usually, as a share of its height: clothes."""
SKIN_SIGMA = 0.01
"""How far the body stands out of the contour, usually, as a share of its height."""
CONTOUR_CUTOFF = 2.0
"""Deviations at which the pull of a contour is at its strongest: skirts and coats say little about who wears them."""
FEET_CUTOFF = 8.0
"""Deviations at which the pull of feet's contours is at its strongest: where their contour ends they end."""
INDEPENDENT_CONTOUR_POINTS = 200.0
"""Independent measurements that all points of a contour count as together."""
CROSSING_DEPTH_METRES = 0.09
"""Metres by which the middle of one forearm is before that of another that it crosses, at least."""
CROSSING_SIGMA = 0.01
"""Metres by which a forearm that crosses another may fall short of `CROSSING_DEPTH_METRES`, usually."""
MIN_DEPTH_METRES = 0.1
"""Metres from a camera at which bodies end: a search may lead through it."""


@dataclass(frozen=True)
class ContourMatches:
    """Points of the body's surface and what they should lie on.

    skin : R points of the surface.
    points : (R, 2) the points of the contour that they meet, pixels.
    normals : (R, 2) the contour's there, outwards.
    """

    skin: SkinPoints
    points: NDArray[np.float64]
    normals: NDArray[np.float64]


def residuals(
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
        data.append(_landmark_term(view, points, landmarks.names))
        data += _limb_terms(view, posed.joints, poser.space.names)
        if matched is not None:
            data.append(_contour_term(matched, posed, view))
    share = 1 / np.sqrt(len(views))  # one prior for one body, however often it is seen
    stands = [share * term for view in views for term in _stance_terms(view, posed.joints, poser.space.names)]
    prior = [pose_prior(rotation_vectors), joint_limits(rotation_vectors), coefficients]
    return np.concatenate([*data, *stands, *prior], axis=1)


def _landmark_term(view: Observation, points: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, R) how far landmarks are from where a view has them. What those of a foot have in common is one error, and a large
    one at times: it counts once, and less."""
    off = (project(points, view.camera) - view.points) / (view.landmark_sigma * view.height)
    for side in SIDE_NAMES:
        foot = [names.index(f"{side}{name}") for name in FOOT_LANDMARKS]
        share = 1 / np.sqrt(1 + len(foot) * (FOOT_SIGMA / view.landmark_sigma) ** 2)
        off[:, foot] += (share - 1) * off[:, foot].mean(1, keepdims=True)
    squared = (off**2).sum(-1, keepdims=True)
    off = off * np.sqrt(view.confidence[:, None] / (1 + squared / LANDMARK_CUTOFF_SIGMAS**2))
    return np.asarray(off.reshape(len(points), -1))


def _limb_terms(view: Observation, joints: NDArray[np.float64], names: Sequence[str]) -> list[NDArray[np.float64]]:
    """Each (N, R): directions of limbs and crossed forearms as a view has them."""
    limbs = (_limbs(view, joints, names) - view.directions) * np.sqrt(view.direction_confidence)[:, None]
    data = [(limbs / LIMB_DIRECTION_SIGMA).reshape(len(joints), -1)]
    if view.crossing is not None:
        data.append(_crossing_term(view.crossing, -view.camera.depth(joints), names))
    return data


def _stance_terms(view: Observation, joints: NDArray[np.float64], names: Sequence[str]) -> list[NDArray[np.float64]]:
    """Each (N, R): what one view does not show, how people stand along its axis."""
    legs = _limbs(view, joints, names)[:, 4:, 2].reshape(-1, 2, 2)  # sides, thigh and shin
    believed = np.minimum(view.direction_confidence[4:6], view.direction_confidence[6:])
    apart = (legs[:, 0] - legs[:, 1] - (view.directions[4:6, 2] - view.directions[6:, 2]) * believed) / LEGS_APART_SIGMA
    trunk = joints[:, names.index("Neck")] - joints[:, names.index("Hips")]
    lean = seen_from(view.camera, trunk)[:, 2] / np.linalg.norm(trunk, axis=-1) / TRUNK_LEAN_SIGMA
    nearness = -view.camera.depth(joints)
    ankles = [names.index(f"{side}Foot") for side in SIDE_NAMES]
    stance = (nearness[:, ankles].mean(1) - nearness[:, names.index("Hips")]) / BALANCE_SIGMA
    return [lean[:, None], stance[:, None], legs.mean(1) / LEGS_LEAN_SIGMA, apart]


def _limbs(view: Observation, joints: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, M, 3) the directions of `DIRECTED_LIMBS` in the camera's axes."""
    starts, ends = ([names.index(limb[end]) for limb in DIRECTED_LIMBS] for end in (0, 1))
    limbs = joints[:, ends] - joints[:, starts]
    limbs /= np.linalg.norm(limbs, axis=-1, keepdims=True)
    return seen_from(view.camera, limbs)


def _crossing_term(crossing: Crossing, nearness: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, 1 or 2) standard deviations by which the front arm fails to be in front. The first is of its forearm, before
    the other. The second, where the other's hand is tucked, is of its upper arm, before that hand. `nearness` (N, J) of
    joints, metres."""
    front, back = (("Left", "Right")[side] for side in (crossing.front, 1 - crossing.front))

    def along(side: str, start: str, share: float) -> NDArray[np.float64]:
        ends = ("Arm", "ForeArm", "Hand")
        near, far = (nearness[:, names.index(f"{side}{end}")] for end in (start, ends[ends.index(start) + 1]))
        return np.asarray(near + share * (far - near))

    gaps = [along(front, "ForeArm", crossing.front_at) - along(back, "ForeArm", crossing.back_at)]
    if crossing.tucked_at is not None:
        gaps.append(along(front, "Arm", crossing.tucked_at) - along(back, "ForeArm", 1.0))
    return np.asarray(np.maximum(CROSSING_DEPTH_METRES - np.stack(gaps, 1), 0) / CROSSING_SIGMA)


def _contour_term(matches: ContourMatches, posed: PosedBodies, view: Observation) -> NDArray[np.float64]:
    """(N, R) how far the skin is from the contour that it meets, in standard deviations: of clothes, or of skin."""
    across = ((project(posed.carry(matches.skin), view.camera) - matches.points) * matches.normals).sum(-1)
    off = across / (np.where(across > 0, SKIN_SIGMA, CLOTHED_SIGMA) * view.height)
    cutoff = np.where(matches.skin.inside > SEARCH_INSIDE_SHARE, FEET_CUTOFF, CONTOUR_CUTOFF)
    return np.asarray(off * np.sqrt(INDEPENDENT_CONTOUR_POINTS / CONTOUR_POINTS / (1 + off**2 / cutoff**2)))


def project(points: NDArray[np.float64], camera: Camera) -> NDArray[np.float64]:
    """(..., 3) metres to (..., 2) pixels."""
    return camera.project(points, np.float64, MIN_DEPTH_METRES)[..., :2]


def seen_from(camera: Camera, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (..., 3) of the world in the camera's axes: x right, y up, z to the viewer."""
    return np.asarray(vectors @ np.array(camera.axes).T)
