"""A canonical face, the head's pose against it by PnP, and meshes from placed landmarks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.npz import read_npz
from engine.package_data import package_data
from engine.perception.face.landmarks import RIGID_VERTICES, eye_centres, fiducials

FOCAL_LENGTH_SIDES = 1.5
"""Assumed focal length of a portrait's camera, in longer sides of the picture."""
LIKE_A_FACE = 0.5
"""How far 68 placed points may be from a face that is turned and stretched, as a share of their spread: root mean squares.
Points put at random have 0.9, drawn faces with dots for eyes and a line for a mouth, with huge eyes or mouths, under 0.2."""


@dataclass(frozen=True)
class HeadPose:
    """Angles in radians: `yaw` > 0 turns the face to the picture's right, `pitch` > 0 downwards,
    `roll` > 0 clockwise as seen. `error` is the reprojection's root mean square in eye distances."""

    yaw: float
    pitch: float
    roll: float
    error: float


@cache
def canonical_face() -> NDArray[np.float32]:
    """(478, 3) mean neutral face, symmetric, frontal: origin between the eyes, x to the picture's right,
    y down, z away from the viewer, the eye distance is 1. A median over many tracked faces."""
    return np.asarray(read_npz(package_data("engine.perception", "canonical_face.npz"))["mesh"], np.float32)


@cache
def mirror_vertices() -> NDArray[np.int16]:
    """(478,) the vertex that each one becomes in a mirrored face."""
    return np.asarray(read_npz(package_data("engine.perception", "canonical_face.npz"))["mirror"], np.int16)


def head_pose(mesh: NDArray[np.floating], size: tuple[int, int]) -> HeadPose:
    """The head's angles by PnP of the rigid vertices of a mesh (478, 2 or 3) in a picture of `size` (w, h)."""
    chosen = list(RIGID_VERTICES)
    model, seen = canonical_face()[chosen].astype(float), mesh[chosen, :2].astype(float)
    focal = FOCAL_LENGTH_SIDES * max(size)
    x, y = (size[0] - 1) / 2, (size[1] - 1) / 2
    lens = Camera((0.0, 0.0, 0.0), focal, (x, y), size[::-1]).intrinsics
    right_eye, left_eye = eye_centres(mesh[:, :2])
    unit = float(np.linalg.norm(right_eye - left_eye))
    start = np.array([[seen[:, 0].mean() - x], [seen[:, 1].mean() - y], [focal]]) / max(unit, 1e-6)
    _, rotation, shift = cv2.solvePnP(
        model, seen, lens, np.zeros(4), np.zeros((3, 1)), start, useExtrinsicGuess=True, flags=cv2.SOLVEPNP_ITERATIVE
    )
    r = np.asarray(cv2.Rodrigues(rotation)[0], np.float64)
    posed = Camera.of_matrices(lens, r, np.asarray(shift[:, 0], np.float64), size[::-1])
    back = posed.project(model, np.float64)[:, :2]
    error = float(np.sqrt(((back - seen) ** 2).sum(axis=1).mean())) / max(unit, 1e-6)
    forward = -r[:, 2]
    # a face is frontal when it looks back along the ray on which it is seen, not along the camera's axis
    ray_yaw, ray_pitch = np.arctan2(shift[0, 0], shift[2, 0]), np.arctan2(shift[1, 0], shift[2, 0])
    return HeadPose(
        yaw=float(np.arctan2(forward[0], -forward[2]) + ray_yaw),
        pitch=float(np.arctan2(forward[1], np.hypot(forward[0], forward[2])) + ray_pitch),
        roll=float(np.arctan2(r[1, 0], r[0, 0])),
        error=error,
    )


def mesh_from_fiducials(points: NDArray[np.floating]) -> NDArray[np.float32]:
    """A face mesh (478, 3) that passes through 68 placed points (68, 2), pixels.

    The canonical face is turned into place and then bent smoothly (thin-plate spline), so that drawings,
    masks and emoji without a face that a detector would see can be animated too.

    Raises `InputError` `landmarks_invalid` where the points are not those of a face.
    """
    points = np.asarray(points, float)
    if points.shape != (68, 2) or not np.isfinite(points).all():
        raise InputError("landmarks_invalid", "Give 68 landmarks as [x, y] in pixels of the picture.", ("landmarks",))
    canonical = canonical_face().astype(float)
    known = fiducials(canonical)[:, :2]
    if np.linalg.matrix_rank(points - points.mean(axis=0), tol=1.0) < 2:
        raise InputError("landmarks_invalid", "The placed landmarks all lie on one line.", ("landmarks",))
    _check_likeness(points, fiducials(canonical))
    from scipy.interpolate import RBFInterpolator  # slow to import, and only placed landmarks need it

    bend = RBFInterpolator(known, points, kernel="thin_plate_spline", smoothing=1e-6)
    plane = bend(canonical[:, :2])
    return np.column_stack([plane, _depth(plane)]).astype(np.float32)


def _check_likeness(points: NDArray[np.floating], face: NDArray[np.floating]) -> None:
    """Refuse placed points (68, 2) that are not those of a `face` (68, 3), from wherever in front of it, however stretched."""
    spread, solid = points - points.mean(axis=0), face - face.mean(axis=0)
    seen, *_ = np.linalg.lstsq(solid, spread, rcond=None)  # (3, 2)
    if np.linalg.norm(spread - solid @ seen) > LIKE_A_FACE * np.linalg.norm(spread):
        raise InputError(
            "landmarks_invalid",
            "The placed landmarks do not have a face's order: 17 of the jaw, 10 of the brows, 9 of the nose, 12 of the eyes, 20 of the lips, as in the iBUG scheme.",
            ("landmarks",),
        )
    if np.cross(seen[:, 0], seen[:, 1])[2] < 0:  # from behind
        raise InputError(
            "landmarks_invalid",
            "The placed landmarks are mirrored: of an upright face the first point of the jaw and the first brow are those on the left of the picture.",
            ("landmarks",),
        )


def _depth(plane: NDArray[np.floating]) -> NDArray[np.float64]:
    canonical = canonical_face().astype(float)
    right_eye, left_eye = eye_centres(plane[:, :2])
    unit = np.linalg.norm(right_eye - left_eye)
    return np.asarray(canonical[:, 2:] * unit, float)
