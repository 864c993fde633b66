"""The head as one solid: the face mesh, carried on over ears and hair, turned in space.

The paper warps in the plane and names turns of the head as its limit (section 7.3); its outlook is "to map the face
over a template 3D face". Here every control point of the head has a depth: the mesh's own on the face, an ellipsoid's
around it. The driver's motion is split into the head's rigid motion and the expression, and the rigid part moves all of
the head in space. What the skull's outline shows is another part of it after a turn, and as wide: it goes along and
turns in the plane alone. On the side that turns towards the viewer the picture has nothing of that other part. To keep
the outline where it was would draw out the ear and the hair beside it to more than twice their width. There what is
seen turns whole. The surroundings have no such marks, and make up for it. Towards the shoulders the head hands over to
the body (`body_motion`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import contour_spots, even_depth, rim_distance
from engine.face_animation.motion_transfer.head_motion import SOFT_WEIGHT, HeadMotion
from engine.face_animation.motion_transfer.head_room import skull_centre, skull_shift
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, RIGID_VERTICES, eyes_and_chin

NECK_FADE_CHIN_LENGTHS = (0.9, 1.7)
"""The head's rigid motion fades out between these distances below the eyes, in lengths from eyes to chin."""
SHOULDER_FADE_CHIN_LENGTHS, SHOULDER_SIDE_CHIN_LENGTHS = (0.6, 1.0), (0.7, 1.2)
"""Lengths from eyes to chin: where shoulders begin beside the neck, below the eyes, and how far aside they do."""
CONTOUR_REACH_CHIN_LENGTHS, CONTOUR_SPREAD_CHIN_LENGTHS, CONTOUR_POINT_REACH_CHIN_LENGTHS = 0.5, 0.15, 0.3
"""Lengths from eyes to chin. So far from the contour what it does beyond the head has faded. So far along it points
beside it take part in each other's, and so far from it they do so fully."""
RIM_TO_SKULL_FACE_WIDTHS, RIM_TO_OUTLINE_FACE_WIDTHS = 0.3, 0.12
"""Outside the face's skin its rim passes over into the skull, in depth, and into the skull's outline, in motion, within these shares of the
face's width."""
SKIN_BAND_FACE_WIDTHS, CHEEK_SKIN_START_CHIN_LENGTHS = 0.03, 0.5
"""Widths of the face by which skin may reach beyond the contour, from there on that many lengths from eyes to chin below the eyes."""
SKULL_HALF_WIDTH_FACE_WIDTHS, SKULL_HALF_HEIGHT_CHIN_LENGTHS = 0.56, 1.5
"""Half axes of the skull seen from the front: in widths of the face, and in lengths from eyes to chin."""
OUTLINE_SKULL_RADII = (0.85, 1.15)
"""Radii of the skull between which its front passes over into its outline."""
NEAR_SIDE_OUTLINE_SKULL_RADII = (0.85, 1.45)
"""Radii of the skull between which its front passes over into its outline on the side that turns towards the viewer:
beyond ears."""
NEAR_SIDE_COSINES = (0.0, 0.7)
"""Between the way inwards and the way that a turn takes a point from the outline, from and up to which it is on that side."""
NOSE_BRIDGE_VERTEX = 168


@dataclass(frozen=True)
class HeadProxy:
    """points : (C, 3) control points with depth, pixels.
    share : (C,) how far each belongs to the head [0, 1].
    outline : (C,) how far each moves as the skull's outline does [0, 1]: 0 on the face.
    near : (C,) the same on the side that a turn brings nearer.
    contour : (C - 478, 36) how far those around the face follow what the face's contour, `FACE_OVAL`, does beyond the
        head.
    """

    points: NDArray[np.float64]
    share: NDArray[np.float64]
    outline: NDArray[np.float64]
    near: NDArray[np.float64]
    contour: NDArray[np.float64]


def build_head_proxy(points: NDArray[np.floating], mesh: NDArray[np.floating]) -> HeadProxy:
    """Depth and belonging of points (C, 2) around a face: the mesh's own 478 first, then any others."""
    others = points[MESH_SIZE:]
    face = even_depth(mesh)
    depth = np.concatenate([face, surface_depth(mesh, others)])
    share = np.concatenate([np.ones(MESH_SIZE), head_share(mesh, others)])
    outline, near = (
        np.concatenate([np.zeros(MESH_SIZE), outline_share(mesh, others, radii)])
        for radii in (OUTLINE_SKULL_RADII, NEAR_SIDE_OUTLINE_SKULL_RADII)
    )
    return HeadProxy(np.column_stack([points, depth]), share, outline, near, contour_weights(mesh, others))


def contour_weights(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P, 36) how much points (P, 2) around a face follow each vertex of its contour, ever less with the distance from it, so that a jaw
    which opens squeezes the neck evenly instead of folding over it."""
    fading = 1 - smoothstep(rim_distance(mesh, points) / (CONTOUR_REACH_CHIN_LENGTHS * chin_length(mesh)))
    return np.asarray(fading[:, None] * beside_rim(mesh, points))


def beside_rim(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P, 36) what each vertex of a face's contour counts for points (P, 2) around it; rows sum to one. At the contour it is the spot next to them
    alone, so that nothing parts there, and with the distance ever more of it."""
    length = chin_length(mesh)
    apart = np.linalg.norm(mesh[list(FACE_OVAL), :2].astype(float)[None] - points[:, None], axis=2)
    nearest = apart.min(axis=1, keepdims=True)
    near = np.exp(-0.5 * ((apart - nearest) / (CONTOUR_SPREAD_CHIN_LENGTHS * length + 0.5 * nearest)) ** 2)
    away = smoothstep(rim_distance(mesh, points) / (CONTOUR_POINT_REACH_CHIN_LENGTHS * length))[:, None]
    return np.asarray((1 - away) * contour_spots(mesh, points) + away * near / near.sum(axis=1, keepdims=True))


def chin_length(mesh: NDArray[np.floating]) -> float:
    """From the eyes to the chin of a face (478, 2 or 3), pixels."""
    eyes, chin = eyes_and_chin(mesh)
    return float(np.linalg.norm(chin - eyes))


def chin_lengths_below(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how far below the eyes, down the face, points (P, 2) lie, in lengths from eyes to chin."""
    eyes, chin = eyes_and_chin(mesh)
    down = chin - eyes
    return np.asarray((points - eyes) @ down / float(down @ down), float)


def outline_share(
    mesh: NDArray[np.floating], points: NDArray[np.floating], radii: tuple[float, float] = OUTLINE_SKULL_RADII
) -> NDArray[np.float64]:
    """(P,) how far points (P, 2) outside the face move as the skull's outline does, between `radii` of it: none on its front, all beyond it."""
    share = smoothstep(skull_radius(mesh, points), *radii)
    return share * smoothstep(_beyond_skin(mesh, points) / RIM_TO_OUTLINE_FACE_WIDTHS)


def surface_depth(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Depth (P,) at points outside the face: the face's rim, passing over into the skull's, pixels.

    The skull is an ellipsoid around its middle, as deep as the bridge of the nose lies before that.
    """
    mesh = mesh.astype(float)
    centre = skull_centre(mesh)
    front = centre[2] - mesh[NOSE_BRIDGE_VERTEX, 2]
    skull = centre[2] - front * np.sqrt(np.clip(1 - skull_radius(mesh, points) ** 2, 0, 1))
    rim = beside_rim(mesh, points) @ even_depth(mesh)[list(FACE_OVAL)]
    away = smoothstep(_beyond_skin(mesh, points) / RIM_TO_SKULL_FACE_WIDTHS)
    return np.asarray(rim + away * (skull - rim), float)


def _beyond_skin(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how far points (P, 2) lie outside a face's skin, in widths of the face: beside cheeks and jaw it ends a little outside of the contour."""
    band = SKIN_BAND_FACE_WIDTHS * smoothstep(chin_lengths_below(mesh, points) / CHEEK_SKIN_START_CHIN_LENGTHS)
    return np.asarray(rim_distance(mesh, points) / _face_width(mesh) - band)


def skull_radius(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how far points (P, 2) lie from the skull's middle, 1 on the outline of a skull without hair."""
    right, left = mesh[[127, 234, 93], :2].mean(axis=0), mesh[[356, 454, 323], :2].mean(axis=0)
    across = (left - right) / np.linalg.norm(left - right)
    apart = points - skull_centre(mesh)[:2]
    aside, along = apart @ across, apart @ (across[::-1] * (-1, 1))
    return np.asarray(
        np.hypot(
            aside / (SKULL_HALF_WIDTH_FACE_WIDTHS * _face_width(mesh)),
            along / (SKULL_HALF_HEIGHT_CHIN_LENGTHS * chin_length(mesh)),
        )
    )


def _face_width(mesh: NDArray[np.floating]) -> float:
    return float(np.linalg.norm(mesh[454, :2] - mesh[234, :2]))


def head_share(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """How far points (P, 2) belong to the head: 1 above the chin, fading to 0 down the neck, and aside of it, where shoulders are."""
    below = chin_lengths_below(mesh, points)
    eyes, chin = eyes_and_chin(mesh)
    down = (chin - eyes) / chin_length(mesh)
    aside = np.abs((points - eyes) @ (down[::-1] * (1, -1))) / chin_length(mesh)
    begin, end = NECK_FADE_CHIN_LENGTHS
    fading = smoothstep(below, begin, end)
    shoulder = smoothstep(below, *SHOULDER_FADE_CHIN_LENGTHS)
    beside = smoothstep(aside, *SHOULDER_SIDE_CHIN_LENGTHS)
    return np.asarray((1 - fading) * (1 - shoulder * beside), float)


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
    (N, C, 3) positions, pixels; points that do not belong to the head move rigidly too, see `share`. Those of the outline
    go with the skull's middle and turn in the plane alone: a skull that turns shows another outline, as wide as the last.
    """
    carry = _HeadCarry(motion, target)
    points = np.repeat(proxy.points[None], len(carry.rotation), axis=0)
    if expression is not None:
        points[:, :MESH_SIZE] += expression
    arm = points - carry.pivot
    turned = np.einsum("nij,ncj->nci", carry.rotation, arm)
    rolled = np.einsum("nij,ncj->nci", _roll(carry.rotation), arm)
    turned[..., :2] += _outline(proxy, turned, rolled)[..., None] * (rolled - turned)[..., :2]
    return carry.placed(turned)


def roll_head(proxy: HeadProxy, motion: HeadMotion, target: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, C, 2) where all points of a proxy go if they move as the skull's outline does; parameters as of `move_head`."""
    carry = _HeadCarry(motion, target)
    return carry.placed(np.einsum("nij,cj->nci", _roll(carry.rotation), proxy.points - carry.pivot))[..., :2]


class _HeadCarry:
    """A driver's motion carried to a target: `rotation` (N, 3, 3) about the `pivot` (3,)."""

    def __init__(self, motion: HeadMotion, target: NDArray[np.floating]):
        weights = np.full(MESH_SIZE, SOFT_WEIGHT)
        weights[list(RIGID_VERTICES)] = 1.0
        size, between, _ = fit_similarities(motion.neutral, target[None].astype(float), weights)
        self.rotation = between[0] @ motion.rotation @ between[0].T
        self.pivot = skull_centre(target)
        self._scale = motion.scale[:, None, None]
        self._place = self.pivot + (size[0] * skull_shift(motion) @ between[0].T)[:, None]

    def placed(self, turned: NDArray[np.floating]) -> NDArray[np.float32]:
        """(N, C, 3) where points go that are `turned` about the pivot."""
        return np.asarray(self._scale * turned + self._place, np.float32)


def followed_outline(
    proxy: HeadProxy, rotation: NDArray[np.float64], pivot: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(N, C) how far the points of a proxy move as the skull's outline does where the head's `rotation` (N, 3, 3) about the `pivot` (3,) is."""
    arm = proxy.points - pivot
    turned, rolled = (np.einsum("nij,cj->nci", one, arm) for one in (rotation, _roll(rotation)))
    return _outline(proxy, turned, rolled)


def _outline(proxy: HeadProxy, turned: NDArray[np.float64], rolled: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where the outline leads points that are `turned` and `rolled` (N, C, 3) about the head's middle."""
    inwards, back = -rolled[..., :2], (turned - rolled)[..., :2]
    sizes = np.linalg.norm(inwards, axis=-1) * np.linalg.norm(back, axis=-1)
    side = smoothstep((inwards * back).sum(axis=-1) / np.maximum(sizes, 1e-9), *NEAR_SIDE_COSINES)
    return np.asarray(proxy.outline + side * (proxy.near - proxy.outline))


def _roll(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """What rotations (N, 3, 3) turn within the picture plane, as rotations."""
    angle = np.arctan2(rotation[:, 1, 0] - rotation[:, 0, 1], rotation[:, 0, 0] + rotation[:, 1, 1])
    out = np.tile(np.eye(3), (len(rotation), 1, 1))
    out[:, 0, 0] = out[:, 1, 1] = np.cos(angle)
    out[:, 1, 0] = np.sin(angle)
    out[:, 0, 1] = -out[:, 1, 0]
    return out
