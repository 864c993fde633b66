"""The avatar seen from all around: one turn of the camera about it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms
from engine.render.lighting.ground_shadow import GroundShadow
from engine.render.scene.character import Actor, film_cast, prepare_character

FIELD_OF_VIEW_RADIANS = np.radians(28.0)
"""Along the picture's height: a long lens, as for portraits, so that what is near is not large."""
FRAMING_MARGIN_RATIO = 1.12
"""By how much more than the avatar the picture holds, in height and in width."""
CAMERA_HEIGHT_SHARE = 0.6
"""Of the avatar's height: where the camera is; it looks at the middle."""
BACKGROUND_COLOURS = ((232, 234, 236), (178, 182, 187))
"""Colours (sRGB) at the top and at the bottom of what is behind it."""


def turntable(
    mesh: SkinnedMesh, pose: Clip, size: tuple[int, int], seconds: float, fps: float
) -> Iterator[NDArray[np.uint8]]:
    """Frames (h, w, 3) of a camera that goes once round the avatar, which stands in the first pose of `pose`. The first
    frame shows it from the front, and the one after the last would be the first. `size` (width, height) in pixels."""
    count = max(1, round(seconds * fps))
    standing = Clip(
        pose.name,
        fps,
        np.repeat(pose.rotations[:1], count, axis=0),
        np.repeat(pose.root[:1], count, axis=0),
    )
    shadow = GroundShadow(strength=0.35, softness=0.06)
    background = backdrop(size)
    transforms = pose_transforms(mesh.skeleton, standing.rotations[:1], standing.root[:1])[0]
    posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    return film_cast(
        [Actor(prepare_character(mesh), standing)],
        lambda second: orbit_camera(posed, size, 2 * np.pi * second / seconds),
        lambda camera: background,
        shadow,
    )


def orbit_camera(posed: NDArray[np.floating], size: tuple[int, int], angle: float) -> Camera:
    """The camera of a picture (width, height) that holds all of the vertices `posed` (V, 3), `angle` radians about them
    counter-clockwise seen from above: 0 before the avatar, a quarter turn on its left."""
    width, height = size
    low, high = posed.min(0), posed.max(0)
    middle = (low + high) / 2
    tall, wide = float(high[1] - low[1]), float(2 * np.hypot(*(posed - middle)[:, [0, 2]].T).max())
    focal = height / 2 / np.tan(FIELD_OF_VIEW_RADIANS / 2)
    distance = FRAMING_MARGIN_RATIO * focal * max(tall / height, wide / width) + wide / 2
    away = np.array([distance * np.sin(angle), (CAMERA_HEIGHT_SHARE - 0.5) * tall, distance * np.cos(angle)])
    lens = Camera((0.0, 0.0, 0.0), focal, ((width - 1) / 2, (height - 1) / 2), (height, width))
    return lens.aimed(middle + away, middle)


def backdrop(size: tuple[int, int]) -> NDArray[np.uint8]:
    """What is behind the avatar: a plain wall, a little darker below. (h, w, 3) uint8 for `size` (width, height)."""
    width, height = size
    top, bottom = np.array(BACKGROUND_COLOURS, np.float32)
    rows = top + (bottom - top) * np.linspace(0, 1, height, dtype=np.float32)[:, None]
    return np.repeat(rows[:, None].round().astype(np.uint8), width, axis=1)
