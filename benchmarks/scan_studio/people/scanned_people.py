"""The modelled people of the test media as subjects: 1.75 m high, in A-pose where they have a rig, with one texture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import trimesh
from numpy.typing import NDArray

from benchmarks.scan_studio.people.rigged_glb import TexturedPart, read_in_a_pose
from benchmarks.scan_studio.people.subject import Arm, Subject, room_light
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.mesh.welding import same_rows

SCANNED_HEIGHT_METRES = 1.75
"""Height to which scanned people are scaled."""
RIGGED_PEOPLE = {
    "readyplayer.me": ("body_rpm_man/readyplayer.me.glb", 1.0),
    "soldier": ("body_soldier/soldier.glb", -1.0),
    "michelle": ("body_michelle/michelle.glb", 1.0),
}
"""Files below the folder of scans, and 1 or -1: which way along z they look."""
UNRIGGED_PEOPLE = {"male02": "body_male02/male02.obj"}
"""Files of those who stand as they were made, looking along +z."""
MAX_IMAGE_TEXELS = 1024
"""Texels, at most, along the side of each image's place on the texture."""
IMAGE_GUTTER_TEXELS = 4
"""Texels around each image on the texture, which continue it."""


def read_subject(name: str, scans: Path) -> Subject:
    """One of `RIGGED_PEOPLE` or `UNRIGGED_PEOPLE` from the folder of scans."""
    if name in RIGGED_PEOPLE:
        file, facing = RIGGED_PEOPLE[name]
        parts, joints = read_in_a_pose(scans / file, facing)
    else:
        parts, joints = _read_obj(scans / UNRIGGED_PEOPLE[name]), {}
    return _joined(name, parts, joints)


def _read_obj(path: Path) -> list[TexturedPart]:
    scene: Any = trimesh.load_scene(path, process=False)
    return [
        TexturedPart(
            np.asarray(part.vertices, np.float64),
            np.asarray(part.faces, np.int64),
            np.asarray(part.visual.uv, np.float64) * [1, -1] + [0, 1],  # OBJ counts from the bottom
            np.asarray(part.visual.material.image.convert("RGB"), np.uint8),
            np.zeros((2, len(part.vertices))),
        )
        for part in scene.geometry.values()
    ]


def _joined(name: str, parts: Sequence[TexturedPart], joints: Mapping[str, NDArray[np.float64]]) -> Subject:
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    points = np.concatenate([part.vertices for part in parts])
    triangles = np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)])
    low, high = points.min(0), points.max(0)
    scale, ground = (
        SCANNED_HEIGHT_METRES / (high[1] - low[1]),
        np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]),
    )
    vertices = (points - ground) * scale
    placed = {joint: (place - ground) * scale for joint, place in joints.items()}
    uv, texture = one_texture(parts)
    point = same_rows(vertices)
    places = np.empty((int(point.max()) + 1, 3))
    places[point] = vertices
    normals = vertex_normals(places, point[triangles])[point]
    weights = np.concatenate([part.arms for part in parts], 1)
    arms = tuple(
        Arm(weights[k], placed[f"{side}Arm"], float(np.linalg.norm(placed[f"{side}Hand"] - placed[f"{side}Arm"])))
        for k, side in enumerate(("Left", "Right"))
        if placed
    )
    corners = np.arange(3 * len(triangles), dtype=np.int32).reshape(-1, 3)
    return Subject(name, vertices, triangles.astype(np.int32), uv, corners, texture, room_light(normals), placed, arms)


def one_texture(parts: Sequence[TexturedPart]) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """(3T, 2) the places of all corners on one texture, and that: the parts' images side by side, each once."""
    images: list[NDArray[np.uint8]] = []
    shown = []
    for part in parts:
        same = [k for k, image in enumerate(images) if np.array_equal(image, part.image)]
        shown.append(same[0] if same else len(images))
        if not same:
            images.append(part.image)
    side = min(MAX_IMAGE_TEXELS, max(max(image.shape[:2]) for image in images))
    across = int(np.ceil(np.sqrt(len(images))))
    cell = side + 2 * IMAGE_GUTTER_TEXELS
    texture = np.zeros((int(np.ceil(len(images) / across)) * cell, across * cell, 3), np.uint8)
    for k, image in enumerate(images):
        row, column = divmod(k, across)
        way = cv2.INTER_AREA if max(image.shape[:2]) > side else cv2.INTER_CUBIC
        resized = np.asarray(cv2.resize(image, (side, side), interpolation=way))
        padded = np.pad(
            resized,
            ((IMAGE_GUTTER_TEXELS, IMAGE_GUTTER_TEXELS), (IMAGE_GUTTER_TEXELS, IMAGE_GUTTER_TEXELS), (0, 0)),
            mode="edge",
        )
        texture[row * cell : (row + 1) * cell, column * cell : (column + 1) * cell] = padded
    corners = []
    for part, k in zip(parts, shown, strict=True):
        row, column = divmod(k, across)
        own = part.uv[part.triangles]  # (T, 3, 2)
        own = np.clip(own - np.floor(own.mean(1, keepdims=True)), 0, 1)  # images repeat
        at = own * side + [column * cell + IMAGE_GUTTER_TEXELS, row * cell + IMAGE_GUTTER_TEXELS]
        corners.append(at.reshape(-1, 2) / [texture.shape[1], texture.shape[0]])
    return np.concatenate(corners).astype(np.float32), texture
