"""Feet as one stands on them: the template's own, bare or in shoes, flat on the ground, each laid on its points as a whole.

Points of feet are few and wrong in most films: carpets, shadows, the dark below trousers. Seven numbers a foot, its place and turn
on the ground and its length, width and height, cannot follow them into claws.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.footwear import in_shoes
from engine.avatar.registration.hand_pose import CoarseBody
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.part_outlines import PartSight, Silhouette, outline_points, part_sights
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.geometry.deformation.handles import handles
from engine.geometry.deformation.laplacian_deformation import LaplacianDeformation
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.rigging.joint_names import SIDE_NAMES

BENT_KNEE_HEIGHT_SHARE = 0.6
"""Of the height of the knee, up to which a leg is bent towards its foot."""
ANKLE_SIGMA = 0.015
"""Metres on the ground by which the ankle is off where the coarse fit has it, usually."""
FOOT_LANDMARK_SIGMA_METRES = 0.03
"""Metres by which heel and tip are off where landmarks have them, usually."""
GROUND_SIGMA = 0.002
"""Metres by which soles are off the ground, usually."""
TURN_SIGMA = 0.25
"""Radians by which a foot is turned otherwise than the coarse fit has it, usually."""
SIZE_SIGMAS = (0.05, 0.04, 0.08)
"""Shares by which a foot is longer, wider and higher than is usual for the body."""
FOOT_POINT_SIGMA_METRES = 0.004
"""Metres by which points are off, at least; they are as far as they lie from the foot, root mean square, and all alike."""
INDEPENDENT_FOOT_POINTS = 8.0
"""As how many independent measurements all points of a foot count, at most."""
FOOT_GATES_METRES = (0.04, 0.04, 0.03, 0.03, 0.025, 0.02, 0.015, 0.015, 0.012, 0.012)
"""Metres within which points are matched, from round to round."""
MIN_FOOT_NORMAL_COSINE = 0.4
"""The cosine between the normals of a point and of the foot there, at least."""
SOLE_FLOOR_REACH_METRES = 0.008
"""Metres above the sole up to which points may be the floor's."""
OUTLINE_SIGMA = 0.002
"""Metres by which outlines are off, at least."""
HIDDEN_SHARE, HIDDEN_GATE = 0.5, 0.5
"""Share of the way from the ankle to the tip that trousers may hide, and the share of the gate within which outlines are matched there, within the
person's silhouette."""
INDEPENDENT_OUTLINE_POINTS = 12.0
"""As how many independent measurements all points of outlines count: a few in each of the frames."""
MAX_MATCHED_POINTS = 1500
"""Of a foot, that are matched in one round."""

Residuals = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""From parameters (N, 7) to what is to be small, (N, R)."""


@dataclass(frozen=True)
class _Foot:
    """One foot at rest.

    numbers : (F,) of the skin's vertices.
    places : (F, 3) metres, where they are from the point of the ground below the ankle.
    triangles : (T, 3) of them.
    axes : (3, 3) its left, up and ahead as rows.
    marks : (3,) by name, in the same place.
    """

    numbers: NDArray[np.intp]
    places: NDArray[np.float64]
    triangles: NDArray[np.intp]
    axes: NDArray[np.float64]
    marks: dict[str, NDArray[np.float64]]

    def moved(self, places: NDArray[np.float64], parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, M, 3) where places (M, 3) of the foot at rest are in the world, for parameters (N, 7): where on the ground (x, y, z),
        turn about the vertical, logarithms of the relative length, width and height."""
        turn = parameters[:, 3]
        scale = np.exp(parameters[:, [5, 6, 4]])
        sized = ((places @ self.axes.T) * scale[:, None]) @ self.axes
        x = np.cos(turn)[:, None] * sized[..., 0] + np.sin(turn)[:, None] * sized[..., 2]
        z = -np.sin(turn)[:, None] * sized[..., 0] + np.cos(turn)[:, None] * sized[..., 2]
        return np.asarray(np.stack([x, sized[..., 1], z], -1) + parameters[:, None, :3])


def with_feet(
    models: HumanModels,
    body: CoarseBody,
    coefficients: NDArray[np.float64],
    landmarks: SpatialLandmarks,
    cloud: PointCloud,
    shoes: bool,
    silhouettes: Sequence[Silhouette] = (),
) -> CoarseBody:
    """The coarse fit `body`, of a person with these `coefficients` (K,), with its feet flat on the ground where landmarks, cloud and
    silhouettes have them, in `shoes` or bare; its legs follow."""
    skin = models.skin
    bare = np.asarray(models.space.vertices(coefficients)[skin.vertices], np.float64)
    rest = in_shoes(skin, models.feet, bare) if shoes else bare
    joints = np.asarray(models.space.joints(coefficients), np.float64)
    whole = skin.regions["lower_feet"]
    moved, places, rotations = body.vertices.copy(), body.joints.copy(), body.rotations.copy()
    for side, mask in zip(SIDE_NAMES, models.feet.masks, strict=True):
        foot = _foot(models, side, np.flatnonzero(mask & whole), rest, joints)
        ankle, toes = (models.space.names.index(f"{side}{name}") for name in ("Foot", "ToeBase"))
        start = _start(foot, places[ankle], rotations[ankle])
        elsewhere = skin.triangles[~np.isin(skin.triangles, foot.numbers).any(1)]
        sights = part_sights(silhouettes, foot.moved(foot.places, start[None])[0], body.vertices, elsewhere)
        found = _laid(foot, start, side, landmarks, cloud, sights)
        moved[foot.numbers] = foot.moved(foot.places, found[None])[0]
        ground = np.array([joints[ankle, 0], rest[mask, 1].min(), joints[ankle, 2]])
        places[[ankle, toes]] = foot.moved(joints[[ankle, toes]] - ground, found[None])[0]
        rotations[[ankle, toes]] = _about_vertical(found[3])
    knee = joints[models.space.names.index("LeftLeg"), 1]
    legs = np.isin(np.array(models.rig.names)[skin.bones[:, 0]], [f"{side}Leg" for side in SIDE_NAMES])
    bent = ((legs & (bare[:, 1] < BENT_KNEE_HEIGHT_SHARE * knee)) | skin.regions["feet"]) & ~whole
    deformation = LaplacianDeformation(body.vertices, skin.triangles, handles(len(moved), np.flatnonzero(~bent)))
    return replace(body, vertices=deformation(moved[~bent]), joints=places, rotations=rotations)


def _foot(
    models: HumanModels,
    side: str,
    numbers: NDArray[np.intp],
    rest: NDArray[np.float64],
    joints: NDArray[np.float64],
) -> _Foot:
    own = rest[numbers]
    ankle = joints[models.space.names.index(f"{side}Foot")]
    ground = np.array([ankle[0], own[:, 1].min(), ankle[2]])
    ends = {"Heel": own[np.argmin(own[:, 2])], "FootIndex": own[np.argmax(own[:, 2])]}
    ahead = (ends["FootIndex"] - ends["Heel"]) * [1, 0, 1]
    ahead /= np.linalg.norm(ahead)
    up = np.array([0.0, 1.0, 0.0])
    chosen = np.zeros(len(rest), np.bool_)
    chosen[numbers] = True
    triangles = np.searchsorted(numbers, models.skin.triangles[chosen[models.skin.triangles].all(1)])
    marks = {name: at - ground for name, at in ends.items()} | {"Ankle": np.zeros(3)}
    return _Foot(numbers, own - ground, triangles, np.stack([np.cross(up, ahead), up, ahead]), marks)


def _start(foot: _Foot, ankle: NDArray[np.float64], turned: NDArray[np.float64]) -> NDArray[np.float64]:
    """(7,) below an ankle, in the direction in which its axes are turned."""
    before, after = foot.axes[2], turned @ foot.axes[2]
    turn = np.arctan2(after[0], after[2]) - np.arctan2(before[0], before[2])
    return np.array([ankle[0], 0.0, ankle[2], turn, 0.0, 0.0, 0.0])


def _laid(
    foot: _Foot,
    start: NDArray[np.float64],
    side: str,
    landmarks: SpatialLandmarks,
    cloud: PointCloud,
    sights: Sequence[PartSight],
) -> NDArray[np.float64]:
    """The parameters (7,) for which the foot is where landmarks, ground, points and outlines have it."""
    named = [name for name in ("Heel", "FootIndex") if f"{side}{name}" in landmarks.body]
    seen = np.array([landmarks.body[f"{side}{name}"] for name in named]).reshape(-1, 3)
    at_rest = np.array([foot.marks[name] for name in named]).reshape(-1, 3)
    sigmas = np.array([ANKLE_SIGMA, GROUND_SIGMA, ANKLE_SIGMA, TURN_SIGMA, *SIZE_SIGMAS])

    def prior(parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        off = foot.moved(at_rest, parameters)[..., [0, 2]] - seen[:, [0, 2]]
        return np.concatenate(
            [(parameters - start) / sigmas, off.reshape(len(parameters), -1) / FOOT_LANDMARK_SIGMA_METRES], axis=1
        )

    found = levenberg_marquardt(prior, start)
    for gate in FOOT_GATES_METRES:
        terms = [
            term for term in (_points_term(foot, found, cloud, gate), _outlines_term(foot, found, sights, gate)) if term
        ]
        if terms:
            found = levenberg_marquardt(partial(_together, (prior, *terms)), found, steps=5)
    return found


def _together(terms: Sequence[Residuals], parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate([term(parameters) for term in terms], axis=1)


def _points_term(foot: _Foot, found: NDArray[np.float64], cloud: PointCloud, gate: float) -> Residuals | None:
    """How far the foot is off the cloud's points within a gate of where it was `found`; None where there are none."""
    matched = _matched(foot, found, cloud, gate)
    if matched is None:
        return None
    own, normals, points, scale = matched
    return lambda parameters: np.einsum("nmc,mc->nm", foot.moved(own, parameters) - points, normals) * scale


def _outlines_term(
    foot: _Foot, found: NDArray[np.float64], sights: Sequence[PartSight], gate: float
) -> Residuals | None:
    """How far a foot's outlines are off those of the person in the sights. Trousers may hide them,
    nothing can lay them bare."""
    vertices = foot.moved(foot.places, found[None])[0]
    outlines = [outline_points(sight, vertices, foot.triangles, foot.places) for sight in sights]
    outlines = [outline for outline in outlines if len(outline.places)]
    if not outlines:
        return None

    def off(parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.concatenate([outline.off(foot.moved, parameters) for outline in outlines], axis=1)

    now = off(found[None])[0]
    ahead = np.concatenate([outline.places for outline in outlines]) @ foot.axes[2]
    hidden = (now < 0) & (ahead < HIDDEN_SHARE * (foot.marks["FootIndex"] @ foot.axes[2]))
    reach = np.where(hidden, HIDDEN_GATE * gate, gate)
    weights = np.where(np.abs(now) < reach, (1 - (now / reach) ** 2) ** 2, 0.0)
    if not weights.any():
        return None
    sigma = max(float(np.sqrt((weights * now**2).sum() / weights.sum())), OUTLINE_SIGMA)
    scale = np.sqrt(weights * min(1.0, INDEPENDENT_OUTLINE_POINTS / weights.sum())) / sigma
    return lambda parameters: off(parameters) * scale


def _matched(
    foot: _Foot, parameters: NDArray[np.float64], cloud: PointCloud, gate: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]] | None:
    """Places (M, 3) of the foot at rest and the normals (M, 3) there in the world, the points (M, 3) they are matched with, and what
    a metre between them counts (M,); None where there are none."""
    vertices = foot.moved(foot.places, parameters[None])[0]
    near = ((cloud.points > vertices.min(0) - gate) & (cloud.points < vertices.max(0) + gate)).all(1)
    near &= (cloud.points[:, 1] > vertices[:, 1].min() + SOLE_FLOOR_REACH_METRES) & (
        cloud.points[:, 1] < vertices[:, 1].max()
    )
    numbers = np.flatnonzero(near)
    if not len(numbers):
        return None
    points = cloud[numbers[:: max(1, len(numbers) // MAX_MATCHED_POINTS)]]
    nearest = closest_points(points.points, vertices, foot.triangles)
    normals = face_normals(vertices, foot.triangles)[nearest.triangle]
    used = (nearest.distance < gate) & ((normals * points.normals).sum(1) > MIN_FOOT_NORMAL_COSINE)
    if not used.any():
        return None
    own = np.einsum("mk,mkc->mc", nearest.barycentrics, foot.places[foot.triangles[nearest.triangle]])[used]
    weights = (1 - (nearest.distance[used] / gate) ** 2) ** 2
    weights *= min(1.0, INDEPENDENT_FOOT_POINTS / weights.sum())
    sigma = max(float(np.sqrt((nearest.distance[used] ** 2).mean())), FOOT_POINT_SIGMA_METRES)
    return own, normals[used], points.points[used].astype(np.float64), np.sqrt(weights) / sigma


def _about_vertical(turn: float) -> NDArray[np.float64]:
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
