"""Rigged people in known poses photographed in places that are real, and what is true of each picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, Person, draw_into, level_camera, telephone_camera
from benchmarks.known_truth.known_places import places
from benchmarks.known_truth.scanned_bodies import texture_painter
from benchmarks.scan_studio.people.pictured_moments import PICTURED_NAMES, pictured
from benchmarks.scan_studio.people.rigged_people import T_POSE_HEIGHT_METRES, read_rigged
from benchmarks.shared_media import media
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms

PHOTOGRAPHED_PEOPLE = ("readyplayer.me", "soldier")
"""The rigged people who have human proportions."""
NAMED_CAMERAS: Mapping[str, Callable[[Person, tuple[int, int]], Camera]] = {
    "afar": level_camera,
    "near": telephone_camera,
}
NEAR_CAMERA_POSES = ("arms down", "A-pose", "stride", "one foot before the other", "walking")
"""Poses that a telephone near by takes, too."""


@dataclass(frozen=True)
class Truth:
    """Where a rigged person truly is in a picture.

    joints : (3,) by name, metres as the camera has them (x right, y up, z backwards).
    alpha : (H, W) of their coverage.
    soles : the lowest row at which each foot is seen, left and right.
    camera : the picture's.
    """

    joints: Mapping[str, NDArray[np.float64]]
    alpha: NDArray[np.float32]
    soles: tuple[float, float]
    camera: Camera


def cases(only: str) -> Iterator[tuple[str, str, str, str]]:
    """Who, how, by which camera and where."""
    spots = list(places(PERSON_PICTURE_SIZE))
    for who in PHOTOGRAPHED_PEOPLE:
        for number, how in enumerate(PICTURED_NAMES):
            for camera in NAMED_CAMERAS if how in NEAR_CAMERA_POSES else ("afar",):
                if only in f"{who}: {how}, {camera}":
                    yield who, how, camera, spots[number % len(spots)]


def photograph(who: str, how: str, camera: str, where: str) -> tuple[NDArray[np.uint8], Truth]:
    """A picture of a rigged person, and what is true of it."""
    mesh = read_rigged(who, media("scans3d"))
    clip = pictured(mesh.skeleton, how, media("mocap"))
    transforms = pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0]
    vertices = skin(mesh.vertices, mesh.bones, mesh.weights, transforms).astype(np.float64)
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], mesh.skeleton.heads) + transforms[:, :3, 3]
    ground = np.array([0, vertices[:, 1].min(), 0])
    vertices, joints = vertices - ground, joints - ground
    painter = texture_painter(mesh.uv, mesh.triangles, [mesh.texture], [len(mesh.triangles)])
    person = Person(f"{who}: {how}, {camera}", vertices, mesh.triangles, T_POSE_HEIGHT_METRES, painter)
    picture = draw_into(
        person, places(PERSON_PICTURE_SIZE)[where], camera=NAMED_CAMERAS[camera](person, PERSON_PICTURE_SIZE)
    )
    strongest = mesh.bones[np.arange(len(mesh.bones)), mesh.weights.argmax(1)]
    rows = picture.camera.project(vertices, np.float64)[:, 1]
    left, right = (float(rows[foot].max()) for foot in feet(mesh.skeleton.names, strongest))
    seen = (joints - np.array(picture.camera.eye)) @ np.array(picture.camera.axes).T
    named = dict(zip(mesh.skeleton.names, seen, strict=True))
    return picture.rgb, Truth(named, picture.alpha, (left, right), picture.camera)


def feet(names: Sequence[str], strongest: NDArray[np.integer]) -> list[NDArray[np.bool_]]:
    """Which vertices (V,) are of the left foot, and which of the right, by the joint that moves each most."""
    return [
        np.array([name.startswith((f"{side}Foot", f"{side}Toe")) for name in names])[strongest] for side in SIDE_NAMES
    ]
