"""Fitting the template to a person in a picture: pose, shape and place from landmarks.

The role of F. Bogo et al., Keep it SMPL: Automatic Estimation of 3D Human Pose and Shape from a Single Image, ECCV 2016,
with other data terms: besides the landmarks in the picture (their equation 2, with the same robust penalty), the
directions of limbs in space as perception believes them, which settle what lies in front and what behind, and the
outline of the person's mask. Priors keep joints within what bodies can do (their 3.2) and the shape near the mean
(equation 6).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.body_space import BodySpace
from engine.body.landmarks import LandmarkModel
from engine.body.least_squares import descend
from engine.body.outline import POINTS, Outline, Skin, meet

TURNED = (
    *("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
    *(f"{side}{name}" for side in ("Left", "Right") for name in ("Shoulder", "Arm", "ForeArm", "Hand")),
    *(f"{side}{name}" for side in ("Left", "Right") for name in ("UpLeg", "Leg", "Foot")),
)
"""The joints whose turns are sought; the others stay as at rest."""

LIMBS = (
    *((f"{side}{a}", f"{side}{b}") for side in ("Left", "Right") for a, b in (("Arm", "ForeArm"), ("ForeArm", "Hand"))),
    *((f"{side}{a}", f"{side}{b}") for side in ("Left", "Right") for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))),
)
"""Limbs whose direction in space is believed, as joints."""

COEFFICIENTS = 12
LOOSENESS = {
    "Spine": (0.25, 0.2, 0.15),
    "Spine1": (0.25, 0.2, 0.15),
    "Spine2": (0.25, 0.2, 0.15),
    "Neck": (0.3, 0.4, 0.25),
    "Head": (0.3, 0.4, 0.25),
    "Shoulder": (0.1, 0.2, 0.2),
    "Arm": (0.8, 1.5, 1.5),
    "ForeArm": (0.6, 1.2, 0.15),
    "Hand": (0.3, 0.4, 0.4),
    "UpLeg": (0.5, 0.4, 0.4),
    "Leg": (0.6, 0.1, 0.1),
    "Foot": (0.4, 0.2, 0.2),
}
"""Radians by which joints turn about x, y and z, usually: their prior's standard deviation."""

BEYOND = 0.05
"""Radians beyond a joint's limit that weigh as much as one standard deviation."""

NOISE = 0.012
"""How far perception's landmarks are off, usually, as a share of the body's height in the picture."""
ROBUST = 4.0
"""Deviations at which a landmark's pull is at its strongest (Geman-McClure)."""
DIRECTION = np.array([[0.25, 0.25, 0.35]] * 4 + [[0.25, 0.25, 1.2]] * 4)
"""How far the directions of `LIMBS` are off, usually (the difference of unit vectors). Perception has legs lean away from
the viewer, by half a right angle at times: only where they bend much is it to be believed."""
UPRIGHT, LEVEL = 0.12, 0.14
"""How much trunks, and both legs together, lean towards the viewer or away, usually (the z of unit vectors): cameras look
level at people who stand. From the picture alone somebody who leans is somebody with shorter legs."""
APART = 0.2
"""How far perception is off, usually, in how much one leg leads before the other (the difference of their z): what it has both
lean too much cancels out."""
BALANCE = 0.07
"""Metres by which the ankles' middle is before or behind the hips, usually: else one would fall."""
WORN, BARE = 0.02, 0.01
"""How far the body stays behind the outline, usually, and stands out of it, as shares of the body's height."""
CLOTHES = 2.0
"""Deviations at which the pull of an outline is at its strongest: skirts and coats say little about who wears them."""
INDEPENDENT = 60.0
"""As how many independent measurements all points of an outline count."""
BEFORE, SURELY = 0.09, 0.01
"""Metres by which the middle of one forearm is before that of another that it crosses, at least, and how far it may be off that."""
ROUNDS, STEPS = 4, 4
"""How often the outline's points are met anew, and the most steps of the search each time."""


@dataclass(frozen=True)
class Crossing:
    """One forearm before the other: that of the `front` side (0 left, 1 right). Both are seen in one place, which is so far along
    from the elbow, as a share of the forearm: `front_at` and `back_at`. `tucked_at`: how far
    along from the shoulder the other's hand is behind the front side's upper arm, too; None where it is not."""

    front: int
    front_at: float
    back_at: float
    tucked_at: float | None = None


@dataclass(frozen=True)
class Seen:
    """What is known of the person. `points` (L, 2) pixels and `confidence` (L,) of the model's landmarks; `directions`
    (M, 3) of `LIMBS` in space (x right, y up, z to the viewer) and their `sureness` (M,); `focal` pixels and `centre`
    (2,) of the camera; `noise`: how far the points are off, usually, as a share of the body's height; `crossing`: of forearms, if they do."""

    points: NDArray[np.float32]
    confidence: NDArray[np.float32]
    directions: NDArray[np.float32]
    sureness: NDArray[np.float32]
    focal: float
    centre: tuple[float, float]
    noise: float = NOISE
    crossing: Crossing | None = None


@dataclass(frozen=True)
class Fit:
    """The template fitted to a person.

    `coefficients` (K,) of the body space; `rotations` (J, 3, 3) each joint's turn in its parent's axes (the world's, at
    rest); `place` (3,) metres: the root joint seen from the camera, x right, y up, -z away. `reprojection`: the root
    mean square distance in pixels of the landmarks that were believed. `parameters` (P,): all of it as it was sought.
    """

    coefficients: NDArray[np.float32]
    rotations: NDArray[np.float32]
    place: NDArray[np.float32]
    reprojection: float
    parameters: NDArray[np.float64]


@dataclass(frozen=True)
class Met:
    """Points of the body's surface, `skin`, and the points (R, 2) of the outline that they meet, with normals (R, 2)."""

    skin: Skin
    points: NDArray[np.float64]
    normals: NDArray[np.float64]


class _Body:
    """The model's joints, landmarks and points of the surface for many parameters at once."""

    def __init__(self, space: BodySpace, landmarks: LandmarkModel, met: Met | None = None):
        self.space, self.landmarks, self.met = space, landmarks, met
        self.turned = [space.names.index(name) for name in TURNED]
        self.count = 3 + 3 * len(TURNED) + COEFFICIENTS

    def split(
        self, parameters: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Places (N, 3), turns (N, T, 3) as rotation vectors, coefficients (N, K)."""
        place, turns, shape = np.split(parameters, [3, 3 + 3 * len(TURNED)], axis=-1)
        return place, turns.reshape(*turns.shape[:-1], len(TURNED), 3), shape

    def __call__(self, parameters: NDArray[np.float64]) -> Posed:
        """Posed by parameters (N, P)."""
        place, turns, shape = self.split(parameters)
        own = rotation_matrices(turns)
        rest = self.space.joints(shape).astype(np.float64)
        world = np.empty((len(parameters), len(self.space.names), 3, 3))
        joints = np.empty_like(rest)
        for joint, parent in enumerate(self.space.parents):
            if parent < 0:
                world[:, joint], joints[:, joint] = np.eye(3), place
            else:
                offset = rest[:, joint] - rest[:, parent]
                joints[:, joint] = joints[:, parent] + np.einsum("nij,nj->ni", world[:, parent], offset)
                world[:, joint] = world[:, parent]
            if joint in self.turned:
                world[:, joint] = world[:, joint] @ own[:, self.turned.index(joint)]
        return Posed(shape, rest, joints, world)


@dataclass(frozen=True)
class Posed:
    """N bodies: coefficients `shape` (N, K), joints at `rest` (N, J, 3), `joints` (N, J, 3) in the pose, and the turns of
    their axes in the `world` (N, J, 3, 3)."""

    shape: NDArray[np.float64]
    rest: NDArray[np.float64]
    joints: NDArray[np.float64]
    world: NDArray[np.float64]

    def carried(self, model: LandmarkModel | Skin) -> NDArray[np.float64]:
        """Where points (L) that joints carry are, (N, L, 3)."""
        marks = model.mean + np.tensordot(self.shape, model.basis[: self.shape.shape[1]], 1)
        at = model.joints
        turned = self.world[:, at] @ (marks - self.rest[:, at])[..., None]
        return np.asarray(self.joints[:, at] + turned[..., 0])


def forward(
    space: BodySpace, landmarks: LandmarkModel, parameters: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Joints (J, 3) and landmarks (L, 3), metres from the camera, for the parameters (P,) of a fit."""
    posed = _Body(space, landmarks)(np.asarray(parameters, np.float64)[None])
    return posed.joints[0], posed.carried(landmarks)[0]


def rotation_matrices(vectors: NDArray[np.floating]) -> NDArray[np.float64]:
    """Rotation vectors (..., 3) to matrices (..., 3, 3)."""
    found = Rotation.from_rotvec(np.asarray(vectors, np.float64).reshape(-1, 3)).as_matrix()
    return np.asarray(found.reshape(*np.shape(vectors), 3))


def fit_body(
    space: BodySpace,
    landmarks: LandmarkModel,
    seen: Seen,
    start: NDArray[np.floating],
    outline: Outline | None = None,
    skin: Skin | None = None,
) -> Fit:
    """Fit pose, shape and place to what is seen of a person.

    `start` (P,): first guess (`engine.body.first_guess.first_guess`). `outline` of the person's mask, and the `skin` that
    is to meet it.
    """
    body = _Body(space, landmarks)
    height = max(float(np.ptp(seen.points[seen.confidence > 0.3, 1], axis=0)), 1.0)
    rough = replace(seen, noise=max(NOISE, seen.noise))
    parameters = descend(partial(_residuals, body, rough, height), np.asarray(start, np.float64))
    if seen.noise < NOISE:  # near the end only: robust penalties pull no more at what is many deviations off
        parameters = descend(partial(_residuals, body, seen, height), parameters)
    if outline is not None and skin is not None and len(outline.points):
        for _ in range(ROUNDS):
            met = _meet(body, seen, height, parameters, outline, skin)
            parameters = descend(partial(_residuals, _Body(space, landmarks, met), seen, height), parameters, STEPS)
    return _fit(body, seen, parameters)


def _meet(body: _Body, seen: Seen, height: float, parameters: NDArray[np.float64], outline: Outline, skin: Skin) -> Met:
    """The parts of the skin that the outline's points ask for, as the body stands now."""
    posed = body(parameters[None])
    pixels = _project(posed.carried(skin), seen)[0]
    normals = (posed.world[0, skin.joints] @ skin.normals[..., None])[..., 0] * [1, -1, 1]
    which, at = meet(outline, pixels, normals, height)
    return Met(skin.some(at), outline.points[which], outline.normals[which])


def _fit(body: _Body, seen: Seen, parameters: NDArray[np.float64]) -> Fit:
    place, turns, shape = body.split(parameters)
    rotations = np.broadcast_to(np.eye(3), (len(body.space.names), 3, 3)).copy()
    rotations[body.turned] = rotation_matrices(turns)
    off = _project(body(parameters[None]).carried(body.landmarks), seen)[0] - seen.points
    believed = seen.confidence > 0.5
    error = float(np.sqrt((off[believed] ** 2).sum(-1).mean())) if believed.any() else 0.0
    return Fit(shape.astype(np.float32), rotations.astype(np.float32), place.astype(np.float32), error, parameters)


def _project(points: NDArray[np.float64], seen: Seen) -> NDArray[np.float64]:
    """(..., 3) metres from the camera to (..., 2) pixels."""
    distance = np.maximum(-points[..., 2:], 0.1)
    return points[..., :2] * [seen.focal, -seen.focal] / distance + seen.centre


def _residuals(body: _Body, seen: Seen, height: float, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, R): what is to be small, in standard deviations."""
    posed = body(parameters)
    joints, points = posed.joints, posed.carried(body.landmarks)
    _, turns, shape = body.split(parameters)
    off = (_project(points, seen) - seen.points) / (seen.noise * height)
    squared = (off**2).sum(-1, keepdims=True)
    off = off * np.sqrt(seen.confidence[:, None] / (1 + squared / ROBUST**2))
    names = body.space.names
    starts, ends = ([names.index(limb[end]) for limb in LIMBS] for end in (0, 1))
    limbs = joints[:, ends] - joints[:, starts]
    limbs /= np.linalg.norm(limbs, axis=-1, keepdims=True)
    legs = limbs[:, 4:, 2].reshape(-1, 2, 2)  # sides, thigh and shin
    seen_apart = (seen.directions[4:6, 2] - seen.directions[6:, 2]) * np.minimum(seen.sureness[4:6], seen.sureness[6:])
    apart = (legs[:, 0] - legs[:, 1] - seen_apart) / APART
    limbs = (limbs - seen.directions) * np.sqrt(seen.sureness)[:, None] / DIRECTION
    trunk = joints[:, names.index("Neck")] - joints[:, names.index("Hips")]
    lean = trunk[:, 2] / np.linalg.norm(trunk, axis=-1) / UPRIGHT
    ankles = [names.index(f"{side}Foot") for side in ("Left", "Right")]
    stance = (joints[:, ankles, 2].mean(1) - joints[:, names.index("Hips"), 2]) / BALANCE
    count = len(parameters)
    data = [off.reshape(count, -1), limbs.reshape(count, -1)]
    if seen.crossing is not None:
        data.append(_crossed(seen.crossing, joints, names))
    if body.met is not None:
        data.append(_behind_the_outline(body.met, posed, seen, height))
    stands = [lean[:, None], stance[:, None], legs.mean(1) / LEVEL, apart]
    return np.concatenate([*data, *stands, _prior(turns), _beyond(turns), shape], axis=1)


def _crossed(crossing: Crossing, joints: NDArray[np.float64], names: Sequence[str]) -> NDArray[np.float64]:
    """(N, 1 or 2) how far the arm that is before the other is from being so, in standard deviations: its forearm before the other,
    and its upper arm before the other's hand if that is tucked."""
    front, back = (("Left", "Right")[side] for side in (crossing.front, 1 - crossing.front))

    def depth(side: str, start: str, share: float) -> NDArray[np.float64]:
        ends = ("Arm", "ForeArm", "Hand")
        near, far = (joints[:, names.index(f"{side}{end}"), 2] for end in (start, ends[ends.index(start) + 1]))
        return np.asarray(near + share * (far - near))

    gaps = [depth(front, "ForeArm", crossing.front_at) - depth(back, "ForeArm", crossing.back_at)]
    if crossing.tucked_at is not None:
        gaps.append(depth(front, "Arm", crossing.tucked_at) - depth(back, "ForeArm", 1.0))
    return np.asarray(np.maximum(BEFORE - np.stack(gaps, 1), 0) / SURELY)


def _behind_the_outline(met: Met, posed: Posed, seen: Seen, height: float) -> NDArray[np.float64]:
    """(N, R) how far the skin is from the outline that it meets, in standard deviations: of clothes, or of skin."""
    across = ((_project(posed.carried(met.skin), seen) - met.points) * met.normals).sum(-1)
    off = across / (np.where(across > 0, BARE, WORN) * height)
    return np.asarray(off * np.sqrt(INDEPENDENT / POINTS / (1 + off**2 / CLOTHES**2)))


def _prior(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turns in standard deviations; arms rest half lowered, and the hips turn as they like."""
    usual = np.array([LOOSENESS[_kind(name)] for name in TURNED[1:]])
    rest = np.zeros_like(usual)
    for side, sign in (("Left", -1), ("Right", 1)):
        rest[TURNED.index(f"{side}Arm") - 1, 2] = sign * 0.8
    return np.asarray(((turns[:, 1:] - rest) / usual).reshape(len(turns), -1))


def _beyond(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far elbows and knees are bent the wrong way, legs stretched behind, and necks and heads twisted beyond what they can."""
    at = TURNED.index
    wrong = [
        turns[:, at("LeftForeArm"), 1],
        -turns[:, at("RightForeArm"), 1],
        -turns[:, at("LeftLeg"), 0],
        -turns[:, at("RightLeg"), 0],
        turns[:, at("LeftUpLeg"), 0] - 0.15,
        turns[:, at("RightUpLeg"), 0] - 0.15,
        np.abs(turns[:, at("Neck"), 1] + turns[:, at("Head"), 1]) - 1.4,
        np.abs(turns[:, at("Neck"), 0] + turns[:, at("Head"), 0]) - 1.0,
    ]
    return np.asarray(np.maximum(np.stack(wrong, 1), 0) / BEYOND)


def _kind(name: str) -> str:
    return name.removeprefix("Left").removeprefix("Right")
