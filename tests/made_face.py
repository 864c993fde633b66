"""Faces and drivers made by the tests: meshes at known places, tracks of known motion, pictures painted on them."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarity
from engine.media.film_strip import FilmStripWriter
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import (
    FACE_OVAL,
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_EYE,
    RIGHT_IRIS,
)
from engine.perception.face_track.face_crop import CROP_EYES, CROP_SHAPE
from engine.perception.face_track.track import FaceTrack

SKIN, LIP, DARK, WHITE, BROWN = (205, 165, 140), (170, 90, 85), (70, 20, 20), (235, 232, 228), (60, 40, 25)


def turn(yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> NDArray[np.float64]:
    """(3, 3) rotation by degrees about y, x and z, for x right, y down, z away from the viewer."""
    y, p, r = np.deg2rad((yaw, pitch, roll))
    about_y = np.array([[np.cos(y), 0, -np.sin(y)], [0, 1, 0], [np.sin(y), 0, np.cos(y)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    about_z = np.array([[np.cos(r), -np.sin(r), 0], [np.sin(r), np.cos(r), 0], [0, 0, 1]])
    return about_y @ about_x @ about_z


def placed(
    unit: float = 40.0,
    centre: tuple[float, float] = (100.0, 100.0),
    yaw: float = 0.0,
    pitch: float = 0.0,
    roll: float = 0.0,
) -> NDArray[np.float32]:
    """(478, 3) the canonical face with an eye distance of `unit` pixels, the eyes' middle at `centre`."""
    return (unit * canonical_face() @ turn(yaw, pitch, roll).T + (*centre, 0)).astype(np.float32)


def opened(mesh: NDArray, gap: float) -> NDArray[np.float32]:
    """The face with its lower lip and chin moved down by `gap` eye distances."""
    out = mesh.copy()
    unit = float(np.linalg.norm(mesh[[33, 133], :2].mean(axis=0) - mesh[[263, 362], :2].mean(axis=0)))
    y = canonical_face()[:, 1]
    lower = set(LIPS_INNER[11:]) | set(LIPS_OUTER[11:])
    moves = np.array([i in lower for i in range(len(mesh))]) | (y > 1.3)
    out[moves, 1] += gap * unit
    return out


def shut(mesh: NDArray, share: float = 0.0) -> NDArray[np.float32]:
    """The face with its upper lids lowered until `share` of the gap is left."""
    from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS

    out = mesh.copy()
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    out[upper] = out[lower] + share * (out[upper] - out[lower])
    return out


def smiling(mesh: NDArray, amount: float = 0.12) -> NDArray[np.float32]:
    """The face with the corners of its mouth out and up by `amount` eye distances, falling off around them."""
    rest = canonical_face()
    unit = float(np.linalg.norm(mesh[[33, 133], :2].mean(axis=0) - mesh[[263, 362], :2].mean(axis=0)))
    out = mesh.copy()
    for corner, side in ((61, -1), (291, 1)):
        near = np.exp(-0.5 * (np.linalg.norm(rest[:, :2] - rest[corner, :2], axis=1) / 0.3) ** 2)
        out[:, :2] += unit * amount * near[:, None] * np.array([side, -0.8])
    return out.astype(np.float32)


def painted(mesh: NDArray, size: tuple[int, int], look: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.uint8]:
    """A plain drawing of a face: skin, lips, dark mouth, eyes with irises; `size` (width, height).

    `look` moves the irises by eye widths.
    """
    picture = np.full((size[1], size[0], 3), (120, 140, 160), np.uint8)

    def fill(ring: Sequence[int], colour: tuple[int, int, int]) -> None:
        points = np.round(mesh[list(ring), :2] * 16).astype(np.int32)
        cv2.fillPoly(picture, [points], colour, cv2.LINE_AA, 4)

    fill(FACE_OVAL, SKIN)
    fill(LIPS_OUTER, LIP)
    fill(LIPS_INNER, DARK)
    for contour, iris in ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS)):
        opening = np.zeros(picture.shape[:2], np.uint8)
        cv2.fillPoly(opening, [np.round(mesh[list(contour), :2] * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
        ball = np.empty_like(picture)
        ball[:] = WHITE
        radius = float(np.linalg.norm(mesh[list(iris[1:]), :2] - mesh[iris[0], :2], axis=1).mean())
        width = float(np.linalg.norm(mesh[contour[0], :2] - mesh[contour[8], :2]))
        centre = np.round((mesh[iris[0], :2] + width * np.array(look)) * 16).astype(int)
        cv2.circle(ball, centre.tolist(), round(radius * 16), BROWN, -1, cv2.LINE_AA, 4)
        alpha = opening[..., None] / 255.0
        picture = (picture + alpha * (ball.astype(float) - picture) + 0.5).astype(np.uint8)
    return picture


def in_crop(mesh: NDArray) -> NDArray[np.float32]:
    """The mesh as it lies in a driver's crop, (478, 3)."""
    place = fit_similarity(
        np.array([mesh[[33, 133], :2].mean(axis=0), mesh[[263, 362], :2].mean(axis=0)]), np.array(CROP_EYES)
    )
    return np.column_stack([place(mesh[:, :2]), place.scale * mesh[:, 2]]).astype(np.float32)


def driver(
    folder: Path,
    meshes: Sequence[NDArray[np.float32]],
    pictures: Sequence[NDArray[np.uint8]] | None = None,
    periphery: NDArray[np.float32] | None = None,
    size: tuple[int, int] = (200, 200),
) -> FaceTrack:
    """A driver's analysis with these meshes; `pictures` are its crops (uint8, (*CROP, 3)), plain skin if None."""
    eyes = np.array(CROP_EYES)
    places = [
        fit_similarity(np.array([m[[33, 133], :2].mean(axis=0), m[[263, 362], :2].mean(axis=0)]), eyes).matrix()
        for m in meshes
    ]
    plain = np.empty((*CROP_SHAPE, 3), np.uint8)
    plain[:] = SKIN
    with FilmStripWriter(quality=98) as crops:
        for picture in pictures if pictures is not None else [plain] * len(meshes):
            crops.write(picture)
        strip = crops.strip()
    folder.mkdir(parents=True, exist_ok=True)
    strip = replace(strip, file=Path(shutil.move(strip.file, folder / "crops.jpegs")))
    points = np.zeros((len(meshes), 0, 2), np.float32) if periphery is None else periphery
    stack = np.array(meshes, np.float32)
    return FaceTrack(
        size=size,
        fps=25.0,
        times=np.arange(len(meshes) + 1) / 25,
        has_sound=False,
        meshes=stack,
        found=np.ones(len(meshes), bool),
        periphery=points,
        trust=np.ones(points.shape[:2], np.float32),
        crops=strip,
        crop_places=np.array(places),
        faces=np.zeros((1, 4), np.float32),
    )
