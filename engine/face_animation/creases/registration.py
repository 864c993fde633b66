"""The driver's face held against its own neutral frame, so that control points stay on the skin.

A landmark tracker puts the tip of the nose where a nose tip looks to be, not where that spot of skin went;
over a turn or a frown they part by a pixel or two. After the mesh has brought a frame onto the neutral one,
what is left is small, and dense optical flow (DIS; Kroeger et al. 2016) measures it on the skin itself.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from threading import local

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.driver_tracking.unseen_blinks import eye_contrast, shut_by_contrast
from engine.face_animation.mouth.lip_contours import MIN_TEETH_OPENING
from engine.imaging.warping.delaunay import delaunay
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.landmarks import (
    FACE_OVAL,
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_EYE,
    RIGHT_IRIS,
    mouth_opening,
)
from engine.perception.face_track.face_crop import CROP_EYE_DISTANCE_PIXELS, CROP_SHAPE
from engine.perception.face_track.steady_face import steady_on_head
from engine.perception.face_track.track import FaceTrack

SMOOTHING_PIXELS = 4.0
"""Pixels of the crop over which the measured rest is averaged."""
TRUSTED_RESIDUAL_PIXELS = 9.0
"""Pixels of the crop up to which the measured rest is believed."""
MAX_RESIDUAL_PIXELS = 12.0
"""Pixels of the crop from which on the measured rest is a residual of the flow. On cheeks that a mouth stretches or lifts,
tracker and skin part by up to 11 in 99 of 100 places."""
TRUST_SMOOTHING_FRAMES = 3.0
"""Frames over which belief comes and goes (width of a Gaussian): a rest that noise takes past the limit and back would make
the skin jump."""
LIGHT_SMOOTHING_PIXELS = 20.0
"""Pixels over which the light of the two frames is made equal first."""
CONTOUR_FADE_EYE_DISTANCES = 0.35
"""Within this distance of the face's contour, in eye distances, the flow fades out."""
TRACKED_VERTICES = (*RIGHT_EYE, *LEFT_EYE, *RIGHT_IRIS, *LEFT_IRIS, *LIPS_OUTER, *LIPS_INNER)
"""Lids, irises and lips, which stay as tracked: what opens and closes changes its looks, and the tracker knows it better."""
LIPS_FADE_EYE_DISTANCES = 0.08
"""Eye distances beside the lips over which the flow fades in where the neutral frame's mouth is open. It takes teeth that
come and go for lips that move, and vertices of the lips' red would fold over the skin."""


@dataclass(frozen=True)
class Registration:
    """`meshes` (N, 478, 3) float32: the track's, on the skin, pixels of the driver's frames."""

    meshes: NDArray[np.float32]


def register_track(
    track: FaceTrack,
    neutral: int,
    tick: Callable[[float], None] = lambda fraction: None,
    out: NDArray[np.float32] | None = None,
) -> Registration:
    """Correct a track's meshes by the flow that is left against its neutral frame, and shut eyes that are seen to be shut.

    `out` is where the result goes; it may be the track's own meshes, which a long clip should not have twice.
    """
    rest = track.in_crop(neutral)[:468]
    triangles = delaunay(rest)
    reference = _grey(track.crop(neutral))
    light = _wide(reference)
    weight = _trust(rest)
    own = local()

    def offsets(frame: int) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float64]]:
        if not hasattr(own, "flow"):
            own.flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_FAST)
        face = track.in_crop(frame)
        origin = inverse_map(rest, face[:468], triangles, CROP_SHAPE)
        grey = _grey(track.crop(frame))
        moved = cv2.remap(grey, origin[..., 0], origin[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        moved = np.clip(moved * (light / _wide(np.asarray(moved))), 0, 255)
        aligned = np.where(origin[..., 0] > -1000, moved, reference).astype(np.uint8)
        half = cv2.resize(own.flow.calc(reference, aligned, None), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
        even = cv2.GaussianBlur(half, (0, 0), SMOOTHING_PIXELS / 2)
        at = cv2.remap(even, rest[None] / 2 - np.float32(0.25), None, cv2.INTER_LINEAR)[0]  # type: ignore[call-overload]
        size = np.linalg.norm(at, axis=1)
        at *= np.minimum(1, MAX_RESIDUAL_PIXELS / np.maximum(size, 1e-6))[:, None]
        offset = np.asarray(at @ np.linalg.inv(track.crop_places[frame][:, :2]).T, np.float32)
        belief = np.clip((MAX_RESIDUAL_PIXELS - size) / (MAX_RESIDUAL_PIXELS - TRUSTED_RESIDUAL_PIXELS), 0, 1)
        return offset, np.asarray(belief, np.float32), eye_contrast(grey, face, rest)

    left, belief = (
        np.empty((len(track), 468, *more), np.float16) for more in ((2,), ())
    )  # long clips have many frames
    contrast = np.empty((len(track), 2, 2))
    with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="register") as pool:
        for frame, (left[frame], belief[frame], contrast[frame]) in enumerate(pool.map(offsets, range(len(track)))):
            tick((frame + 1) / len(track))
    meshes = np.empty_like(track.meshes) if out is None else out
    meshes[:] = track.meshes
    for some in np.array_split(np.flatnonzero(weight), 16):  # a part at a time, for the same reason
        eased = _eased(belief[:, some].astype(np.float32))
        meshes[:, some, :2] += (weight[some] * eased)[..., None] * left[:, some]
    # what stays as tracked was steadied there: twice would shift its peaks
    steady_on_head(meshes, np.flatnonzero(weight))
    shut_by_contrast(meshes, contrast, neutral, track.fps)
    return Registration(meshes)


def _eased(belief: NDArray[np.float32]) -> NDArray[np.float32]:
    """Averaged over frames: (N, V)."""
    reach = 2 * round(4 * TRUST_SMOOTHING_FRAMES) + 1
    return np.asarray(
        cv2.GaussianBlur(belief, (1, reach), sigmaX=1, sigmaY=TRUST_SMOOTHING_FRAMES, borderType=cv2.BORDER_REPLICATE)
    )


def _trust(rest: NDArray[np.float32]) -> NDArray[np.float32]:
    """(468,) how far the flow is believed at each vertex: not at `TRACKED_VERTICES`, nor at the rim, where it follows what
    lies behind the face, nor beside an open mouth."""
    oval = rest[list(FACE_OVAL)]
    inside = np.array([cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in rest])
    t = np.clip(inside / (CONTOUR_FADE_EYE_DISTANCES * CROP_EYE_DISTANCE_PIXELS), 0, 1)
    weight = t * t * (3 - 2 * t)
    if float(mouth_opening(rest)) > MIN_TEETH_OPENING:
        lips = rest[list(LIPS_OUTER)]
        beside = np.array([-cv2.pointPolygonTest(lips, (float(x), float(y)), True) for x, y in rest])
        weight *= np.clip(beside / (LIPS_FADE_EYE_DISTANCES * CROP_EYE_DISTANCE_PIXELS), 0, 1)
    weight[[v for v in TRACKED_VERTICES if v < len(weight)]] = 0
    return np.asarray(weight, np.float32)


def _grey(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return np.asarray(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), np.uint8)


def _wide(grey: NDArray) -> NDArray[np.float32]:
    small = cv2.resize(grey, None, fx=0.125, fy=0.125, interpolation=cv2.INTER_AREA).astype(np.float32)
    blurred = cv2.GaussianBlur(small, (0, 0), LIGHT_SMOOTHING_PIXELS / 8) + 5
    return np.asarray(cv2.resize(blurred, grey.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)
