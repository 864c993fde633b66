"""What a face looks like, in a few numbers by which a driver can be compared with a target.

A driver fits a target the better, the more alike they are. Proportions of the faces: equation 1 carries distances from one
to the other. Light: the mouth's inside and the creases come with the driver's shading. Palette: the mouth's inside is
recoloured by as much as it differs. And expression: differences are taken against the frame that shows what the target
shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.registration.rigid import fit_similarities
from engine.media.limits import Limits
from engine.media.video import read_video
from engine.perception.expression.features import frontalise, measure_expression
from engine.perception.face.head_pose import canonical_face, head_pose
from engine.perception.face.landmarks import RIGID_VERTICES, eye_distance
from engine.perception.face.one_face import OneFace

BARE_SKIN = (
    *(50, 101, 118, 205, 207, 36, 280, 330, 347, 425, 427, 266),  # cheeks
    *(151, 108, 337, 69, 299, 9),  # forehead
    *(6, 197, 195),  # ridge of the nose
)
"""Vertices on bare skin, on both sides alike: light and palette are read around them."""

SAMPLE_RADIUS_EYE_DISTANCES = 0.06
"""Eye distances around each of `BARE_SKIN` within which is averaged."""

SAMPLED_FPS = 6.0
"""Frames a second of a driver that are looked at."""
SAMPLED_SECONDS = 30.0
"""Seconds from its beginning up to which a driver is looked at."""


@dataclass(frozen=True)
class Appearance:
    """proportions : (R, 2) the rigid vertices of the face turned to the front, in eye distances around their mean.
    light : (2,) how the logarithm of the skin's luminance grows to the picture's right and downwards, by eye distance.
    palette : (3,) mean skin colour, CIE L*a*b*.
    expressions : (F, E) `EXPRESSION_FEATURES` of each frame looked at; one row for a picture.
    turn : degrees by which a driver's head turns at most against its usual direction, by which a picture's is turned.
    """

    proportions: NDArray[np.float32]
    light: NDArray[np.float32]
    palette: NDArray[np.float32]
    expressions: NDArray[np.float32]
    turn: float


def appearance_of_face(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> Appearance:
    """The appearance of one face in a picture; `mesh` (478, 3) pixels."""
    pose = head_pose(mesh, (rgb.shape[1], rgb.shape[0]))
    return replace(_gather([(rgb, mesh)]), turn=float(np.degrees(np.hypot(pose.yaw, pose.pitch))))


def appearance_of_driver(
    path: Path, limits: Limits, tick: Callable[[float], None] = lambda fraction: None
) -> Appearance:
    """The appearance of the face in a driving video, from some of its frames.

    Raises
    ------
    InputError : `no_face_in_driver`, and what reading the video may raise.
    """
    rows: list[tuple[NDArray[np.uint8], NDArray[np.floating]]] = []
    with OneFace() as follow:
        for index, frame in enumerate(
            read_video(path, fps=SAMPLED_FPS, trim=(0.0, SAMPLED_SECONDS), limits=limits, longest_side=640)
        ):
            tick(min(index / (SAMPLED_FPS * SAMPLED_SECONDS), 1.0))
            if (mesh := follow(frame.rgb)) is not None:
                rows.append(_small(frame.rgb, mesh))
    if not rows:
        raise InputError(
            "no_face_in_driver",
            "No face was found in the driving video: use one that shows a face from the front.",
            ("driver",),
        )
    return _gather(rows)


def _gather(rows: list[tuple[NDArray[np.uint8], NDArray[np.floating]]]) -> Appearance:
    meshes = np.array([mesh for _, mesh in rows], float)
    rigid = np.median(frontalise(meshes)[:, list(RIGID_VERTICES), :2], axis=0)
    light, palette = (np.median(values, axis=0) for values in zip(*(_shading(*row) for row in rows), strict=True))
    return Appearance(
        proportions=(rigid - rigid.mean(axis=0)).astype(np.float32),
        light=light.astype(np.float32),
        palette=palette.astype(np.float32),
        expressions=measure_expression(meshes),
        turn=_turn(meshes),
    )


def _shading(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> tuple[NDArray, NDArray]:
    """Light (2,) and palette (3,) of one face."""
    unit = float(eye_distance(mesh[:, :2]))
    linear = (rgb.astype(np.float32) / 255) ** 2.2
    places, colours = [], []
    for x, y in mesh[list(BARE_SKIN), :2]:
        reach = max(SAMPLE_RADIUS_EYE_DISTANCES * unit, 1.0)
        rows = slice(max(int(y - reach), 0), max(int(y + reach) + 1, 1))
        columns = slice(max(int(x - reach), 0), max(int(x + reach) + 1, 1))
        patch = linear[rows, columns]
        if patch.size:
            places.append((x, y))
            colours.append(patch.mean(axis=(0, 1)))
    if len(places) < 6:  # the face lies mostly outside of the picture
        return np.zeros(2), np.array([50.0, 0.0, 0.0])
    at = (np.array(places) - mesh[list(BARE_SKIN), :2].mean(axis=0)) / unit
    seen = np.array(colours, np.float32)
    bright = np.log(np.maximum(seen @ np.array([0.2126, 0.7152, 0.0722], np.float32), 1e-3))
    slope = np.linalg.lstsq(np.c_[at, np.ones(len(at))], bright, rcond=None)[0][:2]
    mean = np.median(seen, axis=0) ** (1 / 2.2)
    lab = cv2.cvtColor(mean.astype(np.float32)[None, None], cv2.COLOR_RGB2LAB)[0, 0]
    return slope, np.asarray(lab)


def _turn(meshes: NDArray[np.floating]) -> float:
    chosen = list(RIGID_VERTICES)
    _, rotation, _ = fit_similarities(canonical_face()[chosen].astype(float), meshes[:, chosen], np.ones(len(chosen)))
    ahead = rotation[:, :, 2]
    usual = np.median(ahead, axis=0)
    usual /= np.linalg.norm(usual)
    return float(np.degrees(np.arccos(np.clip(ahead @ usual, -1, 1))).max())


def _small(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> tuple[NDArray[np.uint8], NDArray[np.floating]]:
    """Only the face of a frame, so that few bytes are kept of many frames."""
    x0, y0 = np.maximum(np.floor(mesh[:, :2].min(axis=0)).astype(int), 0)
    x1, y1 = np.ceil(mesh[:, :2].max(axis=0)).astype(int) + 1
    moved = mesh.copy()
    moved[:, :2] -= (x0, y0)
    return rgb[y0:y1, x0:x1].copy(), moved
