"""The template fitted to the figure: what perception saw, as `engine.body.fitting.body_fitting` takes it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body import load_template
from engine.body.body_space import BodySpace, load_body_space
from engine.body.face.face_points import face_points
from engine.body.fitting.body_fitting import Fit, fit_body
from engine.body.fitting.contour import SkinPoints, skin_points, trace_contour
from engine.body.fitting.first_guess import facing, first_guess
from engine.body.fitting.observation import DIRECTED_LIMBS, Observation
from engine.body.hands import HandModel, hand_model
from engine.body.landmarks import LIMB_LANDMARKS, LandmarkModel, landmark_model
from engine.body.rig import Rig
from engine.body.template import load_rig
from engine.character.figure.crossed_arms import CrossedArms, crossed_arms, without_hidden_hand
from engine.character.figure.figure import Figure
from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.posed_template import PosedTemplate
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.perception.pose.body import BODY_LANDMARKS
from engine.render.rasterisation.rasteriser import rasterise

RIG_NAME = "mixamo"
"""The rig of a character, who is one surface: the joints of `engine.body.rig.FACE_JOINTS` would move nothing that opens or turns."""
FIGURE_FOCAL_LENGTH_SIDES = 2.2
"""Focal length in longer sides of the picture: a moderate telephoto lens, as people are photographed."""
LANDMARK_WEIGHTS = {
    "Nose": 4.0,
    "Eye": 4.0,
    "Pinky": 0.3,
    "Index": 0.3,
    "Thumb": 0.2,
    "Heel": 0.5,
    "FootIndex": 0.6,
    "Ear": 1.0,
    "Hip": 0.5,
} | dict.fromkeys(("EyeInner", "EyeOuter", "MouthLeft", "MouthRight"), 0.0)
"""How much these landmarks count; the others count 1. Nose and eyes are found best of all; with ears they say enough of the
head, whose turn is found by all of its face points."""
ARM_FORWARD_METRES, TRUNK_CORE_SHARE, FREE_ARM_JOINT_CONFIDENCE = 0.2, 0.9, 0.5
"""Metres from the trunk's middle to an arm before it, the share of the trunk's outline that is surely the trunk's, and
the confidence from which on a joint is seen and not hidden."""
FOREARM_DEPTH_BIAS = 0.25
"""How much nearer to the viewer than the elbow perception has wrists, more than they are, per length of the forearm: of
straight arms in A-pose, rendered and photographed."""
LEG_DEPTH_GAIN, MIN_LEG_DEPTH_DIFFERENCE = 3.0, 0.12
"""How much further one leg is before the other than perception has it, measured on renders; and the difference (of unit
vectors) below which what it has is rather noise."""
LANDMARK_ERROR_WEIGHT = 2.0
"""How much more a share of the height by which landmarks are off counts than a share of overlap, where one of several fits is
chosen: front and back have one outline."""
MASK_COPY_SIZE_PIXELS = 480
"""Pixels of the picture's longer side at which templates are held against a mask."""


@dataclass(frozen=True)
class FittedBody:
    """The fit, and the picture's `camera`, which stands at the origin. `kept` (J,): the joints that stay turned as they are in
    the picture when the character stands in T-pose. `crossed`: the arms, if they are."""

    fit: Fit
    camera: Camera
    kept: NDArray[np.bool_]
    crossed: CrossedArms | None = None

    def picture_camera(self) -> PictureCamera:
        """The camera of the picture, with the person's distance."""
        return PictureCamera(self.camera, -float(self.fit.root_translation[2]))


@dataclass(frozen=True)
class Human:
    """The template's data that a character is made of. `face` (68,): the vertices at the face points."""

    space: BodySpace
    rig: Rig
    triangles: NDArray[np.int32]
    landmarks: LandmarkModel
    skin: SkinPoints
    face: NDArray[np.intp]
    hands: tuple[HandModel, HandModel]


@cache
def load_human() -> Human:
    """Load the template, its rig and its space of bodies, once for the process."""
    template, rig = load_template(), load_rig(RIG_NAME)
    space = load_body_space().with_joints_of(rig)
    return Human(
        space,
        rig,
        triangulate(template.quads[template.faces("body")]),
        landmark_model(template, space, rig),
        skin_points(template, space, rig),
        face_points(template, space),
        (hand_model(template, space, rig, "Left"), hand_model(template, space, rig, "Right")),
    )


def fit_figure(figure: Figure, mask: NDArray[np.bool_]) -> FittedBody:
    """Fit pose, shape and place to landmarks and mask (H, W)."""
    human = load_human()
    landmarks = human.landmarks
    at = [BODY_LANDMARKS.index(name) for name in landmarks.names]
    trust = np.array([LANDMARK_WEIGHTS.get(_part(name), 1.0) for name in landmarks.names], np.float32)
    height, width = figure.rgb.shape[:2]
    centre = (width - 1) / 2, (height - 1) / 2
    camera = Camera((0.0, 0.0, 0.0), FIGURE_FOCAL_LENGTH_SIDES * max(height, width), centre, (height, width))
    places = {
        f"{side}{joint}": BODY_LANDMARKS.index(f"{side}{mark}")
        for joint, mark in LIMB_LANDMARKS.items()
        for side in ("Left", "Right")
    }
    world = arms_before_the_trunk(figure) if figure.spatial else _in_the_plane(figure.points)
    limbs = np.stack([world[places[b]] - world[places[a]] for a, b in DIRECTED_LIMBS])
    trunk = {joint: world[place] for joint, place in places.items()}
    limbs = limbs / np.maximum(np.linalg.norm(limbs, axis=1, keepdims=True), 1e-6)
    if figure.spatial:
        limbs = forearms_back(limbs)
    limbs = legs_apart(limbs, facing(trunk)[:, 2])
    sure = np.array([min(figure.confidence[places[a]], figure.confidence[places[b]]) for a, b in DIRECTED_LIMBS])
    crossed = crossed_arms(figure, mask)
    confidence = without_hidden_hand(figure, crossed).confidence
    seen = Observation(
        figure.points[at],
        confidence[at] * trust,
        limbs.astype(np.float32),
        sure.astype(np.float32),
        camera,
        crossing=None if crossed is None else crossed.crossing,
        contour=trace_contour(mask),
    )
    start = first_guess(human.space, landmarks, seen, trunk)
    fit = fit_body(human.space, landmarks, seen, start, human.skin)
    kept = np.zeros(len(human.space.names), np.bool_)
    return FittedBody(fit, camera, kept, crossed)


def fit_best(figures: Sequence[Figure], mask: NDArray[np.bool_]) -> FittedBody:
    """Fit to each of several looks at one person (`engine.character.fit.repeated_detection`); the fit that agrees best with its
    landmarks and covers the mask (H, W) best."""
    fits = [fit_figure(figure, mask) for figure in figures]
    if len(fits) == 1:
        return fits[0]
    height = float(np.ptp(np.flatnonzero(mask.any(1))))
    return max(
        fits, key=lambda fitted: _overlap(fitted, mask) - LANDMARK_ERROR_WEIGHT * fitted.fit.reprojection / height
    )


def _overlap(fitted: FittedBody, mask: NDArray[np.bool_]) -> float:
    """Intersection over union of the bare template and the mask (H, W)."""
    scale = min(1.0, MASK_COPY_SIZE_PIXELS / max(mask.shape))
    size = max(1, round(mask.shape[0] * scale)), max(1, round(mask.shape[1] * scale))
    small = cv2.resize(mask.astype(np.uint8), size[::-1], interpolation=cv2.INTER_NEAREST_EXACT) > 0
    template = pose_template(fitted, fitted.picture_camera(), load_human())
    half = np.array([0.5, 0.5, 0.0])
    vertices = (template.vertices + half) * scale - half
    covered = rasterise(vertices, template.triangles, size).triangle >= 0
    return float((covered & small).sum() / (covered | small).sum())


def pose_template(fitted: FittedBody, camera: PictureCamera, human: Human) -> PosedTemplate:
    """The fitted template in the picture space of a camera: that of the picture, or of a grid on it."""
    fit = fitted.fit
    rest, heads = human.space.vertices(fit.coefficients), human.space.joints(fit.coefficients)
    transforms = bone_transforms(human.rig.parents, heads, fit.rotations, fit.root_translation - heads[0])
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    vertices = skin(rest, human.rig.bones, human.rig.weights, transforms)
    return PosedTemplate(
        camera.to_picture(vertices), rest, human.triangles, camera.to_picture(joints), heads, camera.pixels_per_metre
    )


def arms_before_the_trunk(figure: Figure) -> NDArray[np.float32]:
    """Perception's places in space (33, 3), with what is seen before the trunk before it: an arm behind it would be
    hidden. `ARM_FORWARD_METRES` metres are those between the middle of a body and an arm that lies on it."""
    world = figure.world.copy()
    corners = ("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")
    trunk = np.stack([figure.point(name) for name in corners])
    middle = trunk.mean(0)
    trunk = np.asarray(middle + TRUNK_CORE_SHARE * (trunk - middle), np.float32)
    depths = world[[BODY_LANDMARKS.index(name) for name in corners], 2]
    for side in ("Left", "Right"):
        for joint in ("Elbow", "Wrist"):
            at = BODY_LANDMARKS.index(f"{side}{joint}")
            x, y = (float(value) for value in figure.points[at])
            if figure.confidence[at] > FREE_ARM_JOINT_CONFIDENCE and cv2.pointPolygonTest(trunk, (x, y), False) > 0:
                world[at, 2] = max(world[at, 2], float(depths.mean()) + ARM_FORWARD_METRES)
    return world


def forearms_back(limbs: NDArray[np.floating]) -> NDArray[np.floating]:
    """Directions (8, 3) of `DIRECTED_LIMBS` with forearms as far back as perception has them too near the viewer."""
    forearms = limbs[1:4:2] - [0, 0, FOREARM_DEPTH_BIAS]
    forearms = forearms / np.maximum(np.linalg.norm(forearms, axis=1, keepdims=True), 1e-6)
    return np.concatenate([limbs[:1], forearms[:1], limbs[2:3], forearms[1:], limbs[4:]])


def legs_apart(limbs: NDArray[np.floating], front: NDArray[np.floating]) -> NDArray[np.floating]:
    """Directions (8, 3) of `DIRECTED_LIMBS` with one leg as far before the other, along the trunk's `front` (3,), as it is where
    perception sees it so: it has strides too short. What both legs have in common stays, and how far they are spread."""
    legs = limbs[4:].reshape(2, 2, 3)  # sides, thigh and shin
    before = (legs[0] - legs[1]) @ front
    power = before @ before
    more = (LEG_DEPTH_GAIN * power / (power + MIN_LEG_DEPTH_DIFFERENCE**2) - 1) * before / 2
    moved = legs + np.array([1, -1])[:, None, None] * more[:, None] * front
    return np.concatenate([limbs[:4], moved.reshape(4, 3)])


def _in_the_plane(points: NDArray[np.float32]) -> NDArray[np.float32]:
    """Places in space where only the picture is known: all limbs lie across the view."""
    return np.stack([points[:, 0], -points[:, 1], np.zeros(len(points))], 1).astype(np.float32)


def _part(name: str) -> str:
    return name.removeprefix("Left").removeprefix("Right")
