"""Hands and feet as people have them in pictures: hands that are not seen closely are relaxed, and feet wear shoes.

The template's own are flat hands with fingers spread, and bare toes. The outline says little of either.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.cache import cached_arrays
from engine.body.garments.shoes import shod
from engine.body.garments.toe_cap import ToeCap, toe_cap
from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.parts.label_map import Labels
from engine.character.shell.template_mesh import TemplateMesh, template_mesh
from engine.geometry.rigging.joint_names import FINGER_NAMES
from engine.imaging.histogram_matching import to_lab
from engine.perception.face.landmarks import fiducials

FINGER_CURL_DEGREES = (12.0, 20.0, 24.0, 28.0, 32.0)
"""Degrees by which each joint of thumb, index, middle, ring and little finger bends in a hand at rest."""
FIRST_JOINT_CURL_SHARE = 0.6
"""Share of a finger's bend by which the first of its three joints bends."""
MIN_FOOT_WEIGHT = 0.6
"""Share of foot and toes in what moves a vertex that is of a foot; and metres above the sole up to which the shin is, too."""
ANKLE_HEIGHT_METRES = 0.1
NOSE_FIDUCIALS = slice(27, 36)
"""Of the fiducials: about them there is skin."""
MAX_BARE_FOOT_HUE_DISTANCE, MIN_FOOT_LIGHTNESS_RATIO, MAX_FOOT_LIGHTNESS_RATIO, MIN_BARE_FOOT_SHARE = 9.0, 0.6, 1.5, 0.6
"""When a foot is bare: by how much its skin differs from the face's in CIELAB's a and b at most, how light it may be,
in the face's lightness, and of how much of the foot that must hold."""
MIN_SHIN_WEIGHT = 0.9
"""Share of the shin's joint in what moves a vertex that is of a shin."""
MIN_COLOUR_PIXELS = 25
"""Pixels of skin and of feet with which either is known."""


def with_relaxed_hands(fitted: FittedBody) -> FittedBody:
    """The fit with those hands' fingers a little curled of which nothing was found; they stay so at rest."""
    human = load_human()
    rotations, kept = fitted.fit.rotations.copy(), fitted.kept.copy()
    for model in human.hands:
        joints = np.array(
            [[human.rig.index(f"{model.side}Hand{finger}{k}") for k in (1, 2, 3)] for finger in FINGER_NAMES]
        )
        if not np.allclose(rotations[joints], np.eye(3), atol=1e-4):
            continue
        for finger, axis, degrees in zip(joints, model.bend, FINGER_CURL_DEGREES, strict=True):
            for joint, share in zip(finger, (FIRST_JOINT_CURL_SHARE, 1.0, 1.0), strict=True):
                rotations[joint] = Rotation.from_rotvec(share * degrees * axis, degrees=True).as_matrix()
        kept[joints] = True
    return replace(fitted, fit=replace(fitted.fit, rotations=rotations), kept=kept)


def in_shoes(straight: NDArray[np.floating]) -> NDArray[np.float64]:
    """The mesh in T-pose (V, 3) with both feet in shoes."""
    mesh = template_mesh()
    skin = ~mesh.eye
    masks, caps = shoe_shapes()
    shoes = np.array(straight, np.float64)
    shoes[skin] = shod(shoes[skin], _skin_triangles(mesh), masks, caps)
    return shoes


@cache
def shoe_shapes() -> tuple[tuple[NDArray[np.bool_], ...], tuple[ToeCap, ...]]:
    """Masks of both feet among the vertices of the skin, and the caps in which shoes end; the first time caps are made."""
    mesh, mean = template_mesh(), load_human().space.mean
    places, own = mean[mesh.ids[~mesh.eye]], mesh.foot[~mesh.eye]
    low = places[:, 1] < places[:, 1].min() + ANKLE_HEIGHT_METRES
    masks = tuple((low | (own > MIN_FOOT_WEIGHT)) & (side * places[:, 0] > 0) for side in (1, -1))

    def convert() -> dict[str, np.ndarray]:
        made = [toe_cap(places, _skin_triangles(mesh), mask) for mask in masks]
        return {f"{name}_{k}": getattr(cap, name) for k, cap in enumerate(made) for name in ("rim", "inside", "disk")}

    stored = cached_arrays("character-shoe-caps", convert)
    return masks, tuple(ToeCap(*(stored[f"{name}_{k}"] for name in ("rim", "inside", "disk"))) for k in (0, 1))


def _skin_triangles(mesh: TemplateMesh) -> NDArray[np.int32]:
    """The triangles of the skin, its vertices counted without the eyes'."""
    number = np.cumsum(~mesh.eye) - 1
    return np.asarray(number[mesh.triangles[~mesh.eye[mesh.triangles[:, 0]]]], np.int32)


def nose_colours(figure: Figure, silhouette: Silhouette) -> NDArray[np.uint8]:
    """(M, 3) the grid's colours about the nose, which are skin; none where no face is seen."""
    if figure.face is None:
        return np.zeros((0, 3), np.uint8)
    nose = fiducials(figure.face[:, :2])[NOSE_FIDUCIALS] @ silhouette.to_grid[:, :2].T + silhouette.to_grid[:, 2]
    hull = cv2.convexHull(np.rint(nose).astype(np.int32))
    return silhouette.rgb[cv2.fillConvexPoly(np.zeros(silhouette.mask.shape, np.uint8), hull, (1,)) > 0]


def barefoot(figure: Figure, silhouette: Silhouette, labels: Labels, template: NDArray[np.float64]) -> bool:
    """Whether feet and shins have the colour of the face: brown shoes have it, too, but seldom below bare shins. Whose face, feet or
    shins are not seen is not. `template` (V, 3): the fitted one in the grid's picture space."""
    mesh = template_mesh()
    lab = cv2.cvtColor(silhouette.rgb.astype(np.float32) / 255, cv2.COLOR_RGB2LAB)
    height, width = labels.labels.shape
    legs = np.isin(labels.labels, [BODY_PARTS.index(name) for name in ("left_leg", "right_leg")])
    skin = nose_colours(figure, silhouette)
    if len(skin) < MIN_COLOUR_PIXELS:
        return False
    own = np.median(to_lab(skin), axis=0)

    def alike(vertices: NDArray[np.bool_]) -> bool:
        near = np.zeros((height, width), np.uint8)
        x, y = np.rint(template[vertices, :2]).astype(int).T
        inside = (x >= 0) & (y >= 0) & (x < width) & (y < height)
        near[y[inside], x[inside]] = 1
        seen = lab[legs & (cv2.dilate(near, np.ones((5, 5), np.uint8)) > 0)]
        if len(seen) < MIN_COLOUR_PIXELS:
            return False
        same = np.linalg.norm(seen[:, 1:] - own[1:], axis=1) < MAX_BARE_FOOT_HUE_DISTANCE
        same &= (seen[:, 0] > MIN_FOOT_LIGHTNESS_RATIO * own[0]) & (seen[:, 0] < MAX_FOOT_LIGHTNESS_RATIO * own[0])
        return bool(same.mean() > MIN_BARE_FOOT_SHARE)

    return alike(mesh.foot > 0.9) and alike(mesh.share("LeftLeg", "RightLeg") > MIN_SHIN_WEIGHT)
