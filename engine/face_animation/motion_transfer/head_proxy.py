"""Head turns by a 3D proxy: the face mesh, carried on to ears, hair and neck.

The paper warps in the plane and names turns of the head as its limit (section 7.3); its outlook is "to map
the face over a template 3D face". Here every control point of the head has a depth, the driver's motion is
split into the head's rigid motion and the expression, and the rigid part moves the points in 3D. Towards
the shoulders it hands over to the 2D warp. The driver's tracked points correct the proxy: what they do
beyond its prediction for the driver's own head is carried over in the plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.head_motion import SOFT_WEIGHT, HeadMotion, turn_angles
from engine.geometry.registration.rigid import fit_similarities
from engine.perception.head_pose import canonical_face
from engine.perception.landmarks import FACE_OVAL, MESH_SIZE, RIGID_VERTICES, eye_distance

LARGEST_TURN = np.deg2rad(25.0)
"""Turns beyond are held back to this."""
NECK_FADE_CHIN_LENGTHS = (0.9, 2.0)
"""The head's rigid motion fades out between these distances below the eyes, in lengths from eyes to chin."""
CONTOUR_BLEND_EYE_DISTANCES = 0.07
"""Within this distance of the contour, in eye distances, the face's depth passes over into the contour's."""
MAX_DEPTH_SLOPE = 2.0
"""In a face that the picture shows turned, its depth departs from the contour's by no more than this times the
distance: the far cheek, of which little is seen, would part into flaps where the driver turns it to the front."""
SLOPE_BOUND_TURN_DEGREES = (14.0, 18.0)
"""Degrees of turn, in the picture, from which and to which that bound takes hold."""
BACK_OF_HAIR = 0.35
"""Outside the face the surface falls back to the ears' depth within this share of the face's width."""


@dataclass(frozen=True)
class HeadProxy:
    """`points` (C, 3) control points with depth, pixels; `share` (C,) how far each belongs to the head [0, 1]."""

    points: NDArray[np.float64]
    share: NDArray[np.float64]


def build_head_proxy(points: NDArray[np.floating], mesh: NDArray[np.floating]) -> HeadProxy:
    """Depth and belonging of points (C, 2) around a face: the mesh's own 478 first, then any others."""
    others = points[MESH_SIZE:]
    depth = np.concatenate([_joined_rim(mesh), surface_depth(mesh, others)])
    share = np.concatenate([np.ones(MESH_SIZE), head_share(mesh, others)])
    return HeadProxy(np.column_stack([points, depth]), share)


def _joined_rim(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """Depth (478,) of the face's vertices; those that the picture shows on its contour have the contour's own.

    Where the surface goes out of sight it is steep: neighbours in the picture differ much in depth, and turned
    they would part into a serrated edge.
    """
    mesh = mesh.astype(float)
    oval = mesh[list(FACE_OVAL)]
    following = np.roll(oval, -1, axis=0)
    way = (following - oval)[:, :2]
    along = ((mesh[:, None, :2] - oval[:, :2]) * way).sum(axis=2) / (way**2).sum(axis=1)
    along = np.clip(along, 0, 1)[..., None]
    nearest = oval + along * (following - oval)
    apart = np.linalg.norm(mesh[:, None, :2] - nearest[..., :2], axis=2)
    closest = apart.argmin(axis=1)
    rim = np.take_along_axis(nearest[..., 2], closest[:, None], axis=1)[:, 0]
    inside = apart.min(axis=1)
    t = np.clip(inside / (CONTOUR_BLEND_EYE_DISTANCES * float(eye_distance(mesh[:, :2]))), 0, 1)
    rise = t * t * (3 - 2 * t) * (mesh[:, 2] - rim)
    slant = np.rad2deg(turn_angles(mesh[None], canonical_face())[0])
    bound = np.clip(
        (slant - SLOPE_BOUND_TURN_DEGREES[0]) / (SLOPE_BOUND_TURN_DEGREES[1] - SLOPE_BOUND_TURN_DEGREES[0]), 0, 1
    )
    return np.asarray(
        rim + rise + bound * (np.clip(rise, -MAX_DEPTH_SLOPE * inside, MAX_DEPTH_SLOPE * inside) - rise), float
    )


def surface_depth(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Depth (P,) at points outside the face: the face's rim, falling back to the ears' depth, pixels.

    In a turned head the ears' depths differ: between and beside them it is interpolated.
    """
    mesh = mesh.astype(float)
    oval = mesh[list(FACE_OVAL)]
    width = float(np.linalg.norm(mesh[454, :2] - mesh[234, :2]))
    right, left = mesh[[127, 234, 93]].mean(axis=0), mesh[[356, 454, 323]].mean(axis=0)
    axis = left[:2] - right[:2]
    along = np.clip((points - right[:2]) @ axis / float(axis @ axis), -0.2, 1.2)
    back = right[2] + along * (left[2] - right[2])
    apart = np.linalg.norm(oval[None, :, :2] - points[:, None], axis=2)
    nearest = apart.min(axis=1)
    near = np.exp(-0.5 * ((apart - nearest[:, None]) / (0.1 * width)) ** 2)
    rim = near @ oval[:, 2] / near.sum(axis=1)
    t = np.clip(nearest / (BACK_OF_HAIR * width), 0, 1)
    return np.asarray((1 - t) * rim + t * back, float)


def head_share(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """How far points (P, 2) belong to the head: 1 above the chin, fading to 0 down the neck."""
    eyes = mesh[[33, 133, 263, 362], :2].mean(axis=0)
    down = mesh[152, :2] - eyes
    below = (points - eyes) @ down / float(down @ down)
    t = np.clip((below - NECK_FADE_CHIN_LENGTHS[0]) / (NECK_FADE_CHIN_LENGTHS[1] - NECK_FADE_CHIN_LENGTHS[0]), 0, 1)
    return np.asarray(1 - t * t * (3 - 2 * t), float)


def move_head(
    proxy: HeadProxy, motion: HeadMotion, target: NDArray[np.floating], expression: NDArray[np.floating] | None = None
) -> NDArray[np.float32]:
    """Where the head's rigid motion takes the points of a proxy.

    Parameters
    ----------
    motion : the driver's, relative to its neutral frame. target : (478, 3) mesh.
    expression : (N, 478, 3) offsets of the face, already in the target's frame and size, pixels.

    Returns
    -------
    (N, C, 3) positions, pixels; points that do not belong to the head move rigidly too, see `share`.
    """
    weights = np.full(MESH_SIZE, SOFT_WEIGHT)
    weights[list(RIGID_VERTICES)] = 1.0
    size, between, _ = fit_similarities(motion.neutral, target[None].astype(float), weights)
    rotation = limit_rotation(between[0] @ motion.rotation @ between[0].T)
    pivot_driver = motion.neutral[list(RIGID_VERTICES)].mean(axis=0)
    pivot = target[list(RIGID_VERTICES)].astype(float).mean(axis=0)
    moved = motion.scale[:, None] * (motion.rotation @ pivot_driver) + motion.shift - pivot_driver
    shift = size[0] * moved @ between[0].T
    points = np.repeat(proxy.points[None], len(rotation), axis=0)
    if expression is not None:
        points[:, :MESH_SIZE] += expression
    turned = np.einsum("nij,ncj->nci", rotation, points - pivot)
    return np.asarray(motion.scale[:, None, None] * turned + pivot + shift[:, None], np.float32)


def limit_rotation(rotation: NDArray[np.float64], largest: float = LARGEST_TURN) -> NDArray[np.float64]:
    """Rotations (N, 3, 3) with turns out of the picture plane held back softly to `largest` radians."""
    limited = rotation.copy()
    for i, r in enumerate(rotation):
        vector = cv2.Rodrigues(r)[0][:, 0]
        turn = float(np.hypot(vector[0], vector[1]))
        if turn > 0.8 * largest:
            start = 0.8 * largest
            held = start + (largest - start) * np.tanh((turn - start) / (largest - start))
            vector[:2] *= held / turn
            limited[i] = cv2.Rodrigues(vector)[0]
    return limited
