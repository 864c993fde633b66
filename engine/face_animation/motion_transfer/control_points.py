"""The control points of the target and where each frame of the driver puts them (section 4, equation 1).

Three sets: the fiducial points on the face (the whole mesh here, of which the 68 are a part), peripheral
points around head and shoulders, and points on the image's border that hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import beside_contour, rim_distance
from engine.face_animation.motion_transfer.fringe import fringe_share
from engine.face_animation.motion_transfer.head_room import (
    MIN_PERSON_ALPHA,
    PICTURE_BORDER_SHARE,
    cut_above,
    face_room,
    head_room,
)
from engine.face_animation.motion_transfer.spectacles import spectacles_share
from engine.face_animation.warping.contour_rings import contour_rings, rings_end
from engine.geometry.mesh.surface import area_vectors, summed_at_corners
from engine.geometry.registration.rigid import Similarity
from engine.imaging.warping.delaunay import delaunay
from engine.imaging.window import Window
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import CHIN_VERTEX, LEFT_IRIS, MESH_SIZE, RIGHT_IRIS, eye_distance

PERIPHERY_SPACING_EYE_DISTANCES = 0.5
"""Distance of peripheral points, in eye distances."""
BORDER_POINT_COUNT = 12
"""Along the longer side of the image."""
MIN_SEEN_SURFACE_COSINE = 0.0
"""Cosine between the line of sight and a surface that is still seen."""
PERIPHERY_KERNEL_EYE_DISTANCES = 0.7
"""Width of the kernel that carries tracked points to peripheral ones, in eye distances."""
MIN_TRUSTED_SHARE = 0.1
"""With less than this share of the tracked points left, what they say fades."""


@dataclass(frozen=True)
class ControlPoints:
    """Rest positions in the target.

    points : (C, 2) float64 pixels, first the 478 of the face's mesh, then those around it, then those on the border.
    peripheral : how many lie around the face.
    usable : (C,) bool, False for three kinds of points of the face. The picture sees some from behind: they say nothing
        about the pixels there. Some lie beside its contour, which carries them. The irises stay behind the lids that
        move over them.
    room : (2, 2) how far the head may go, pixels, see `head_room`.
    face_room : (2, 2) how far its face may, pixels, see `face_room`.
    borders : (3,) where the picture ends to the left, to the right and below, pixels; at infinity where a side cuts nobody, see `body_borders`.
    hair_cut : the height at which the picture ends above, pixels, and the share of the head's width that it cuts there, see `cut_above`.
    bare : (478,) how far each point of the face may move by itself, in [0, 1]: not where hair hangs before it, see `fringe`, nor a frame of
        `spectacles`.
    """

    points: NDArray[np.float64]
    peripheral: int
    usable: NDArray[np.bool_]
    room: NDArray[np.float64]
    face_room: NDArray[np.float64]
    borders: NDArray[np.float64]
    hair_cut: tuple[float, float]
    bare: NDArray[np.float64]

    @property
    def periphery(self) -> slice:
        return slice(MESH_SIZE, MESH_SIZE + self.peripheral)

    @property
    def border(self) -> slice:
        return slice(MESH_SIZE + self.peripheral, len(self.points))


def place_control_points(
    mesh: NDArray[np.floating],
    person: NDArray[np.floating],
    inner: Window | None = None,
    rgb: NDArray[np.uint8] | None = None,
) -> ControlPoints:
    """Control points for a target.

    Parameters
    ----------
    mesh : (478, 3) the target's face, pixels. person : (H, W) mask [0, 1]. inner : the picture within a frame, which cuts the person.
    rgb : (H, W, 3) the picture, where it is to be asked for hair and spectacles before the face.
    """
    height, width = person.shape
    shown = inner or Window(0, 0, width, height)
    unit = float(eye_distance(mesh[:, :2]))
    spacing = max(PERIPHERY_SPACING_EYE_DISTANCES * unit, float(np.hypot(height, width)) / 40)
    ys, xs = np.meshgrid(
        np.arange(spacing / 2, height - 1, spacing * 0.87), np.arange(0, width - 1, spacing), indexing="ij"
    )
    xs = xs + (np.arange(len(xs)) % 2)[:, None] * spacing / 2
    grid = np.stack([xs.ravel(), ys.ravel()], axis=1)
    grid = grid[(grid[:, 0] > spacing / 2) & (grid[:, 0] < width - 1 - spacing / 2)]
    away = cv2.distanceTransform((person <= 0.3).astype(np.uint8), cv2.DIST_L2, 5)
    grid = grid[away[grid[:, 1].astype(int), grid[:, 0].astype(int)] <= spacing]
    grid = grid[rim_distance(mesh, grid) > rings_end(mesh) + 0.25 * spacing]
    grid = np.concatenate([contour_rings(mesh, person.shape), grid])
    count = BORDER_POINT_COUNT
    step = max(height, width) / count
    across, down = (
        np.linspace(0, width - 1, max(3, round(width / step) + 1)),
        np.linspace(0, height - 1, max(3, round(height / step) + 1)),
    )
    border = np.array(
        [(x, y) for x in across for y in (0, height - 1)] + [(x, y) for y in down[1:-1] for x in (0, width - 1)]
    )
    points = np.concatenate([mesh[:, :2].astype(float), grid, border])
    seen = facing(mesh)
    usable = np.concatenate([seen & ~beside_contour(mesh, seen), np.ones(len(points) - MESH_SIZE, bool)])
    usable[list(RIGHT_IRIS + LEFT_IRIS)] = False
    within = mesh[:, :2] - np.array([shown.left, shown.top])
    room, of_face = (
        head_room(within, person[shown.pixels]),
        face_room(within, (shown.right - shown.left, shown.bottom - shown.top)),
    )
    bare = np.ones(MESH_SIZE) if rgb is None else (1 - fringe_share(rgb, mesh)) * (1 - spectacles_share(rgb, mesh))
    hair_cut = float(shown.top), cut_above(within, person[shown.pixels])
    return ControlPoints(points, len(grid), usable, room, of_face, body_borders(mesh, person, shown), hair_cut, bare)


def body_borders(mesh: NDArray[np.floating], person: NDArray[np.floating], shown: Window) -> NDArray[np.float64]:
    """(3,) pixels where the picture that is `shown` ends to the left, to the right and below. It is at infinity where a
    side does not cut the body of a `person` (H, W) below the chin of a mesh (478, 2 or 3)."""
    edge = max(1, round(PICTURE_BORDER_SHARE * min(shown.shape)))
    below = person[
        int(np.clip(mesh[CHIN_VERTEX, 1], shown.top, shown.bottom - 1)) : shown.bottom, shown.left : shown.right
    ]
    left, right = (float(side.max()) > MIN_PERSON_ALPHA for side in (below[:, :edge], below[:, -edge:]))
    return np.array([shown.left if left else -np.inf, shown.right - 1 if right else np.inf, shown.bottom - 1], float)


def facing(mesh: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(478,) whether each vertex of a mesh (478, 3) faces the viewer by more than `MIN_SEEN_SURFACE_COSINE`."""
    triangles = delaunay(canonical_face()[:468, :2])
    normal = area_vectors(mesh.astype(float), triangles)
    rest = canonical_face()[triangles].astype(float)
    a, b = rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]
    front = np.sign(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    total = summed_at_corners(normal * front[:, None], triangles, MESH_SIZE)
    length = np.linalg.norm(total, axis=1)
    return np.asarray((total[:, 2] > MIN_SEEN_SURFACE_COSINE * length) | (length == 0))


def carry_fiducials(
    phi: Similarity, meshes: NDArray[np.floating], neutral: NDArray[np.floating], target: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Equation 1: p_i^t = p_0^t + phi (p_i^S - p_0^S), for (N, V, 2) positions; (N, V, 2)."""
    return target[:, :2] + phi.offsets(meshes[..., :2] - neutral[:, :2])


def carry_periphery(
    phi: Similarity,
    places: NDArray[np.floating],
    offsets: NDArray[np.floating],
    trust: NDArray[np.floating],
    points: NDArray[np.floating],
    unit: float,
) -> NDArray[np.float32]:
    """Offsets of the target's peripheral points: what the driver's tracked points around them do.

    The paper puts the tracked points themselves into the target by phi. The two people differ there, and
    points come and go; so each peripheral point takes the mean of the tracked ones that phi carries near
    it, as far as they are trusted. Where hardly any are, it eases to rest.

    Parameters
    ----------
    places (K, 2) : the driver's tracked points in its neutral frame. offsets (N, K, 2) : what they do.
    trust (N, K) [0, 1]. points : (P, 2) of the target. unit : the target's eye distance, pixels.

    Returns
    -------
    (N, P, 2) offsets in the target, pixels.
    """
    if not len(places) or not len(points):
        return np.zeros((len(offsets), len(points), 2), np.float32)
    apart = ((points[:, None] - phi(places)[None]) ** 2).sum(axis=2)
    reach = 2 * (PERIPHERY_KERNEL_EYE_DISTANCES * unit) ** 2
    near = (np.exp(-apart / reach) + 1e-4 * np.exp(-apart / (25 * reach)) + 1e-12).astype(np.float32)
    trust = trust.astype(np.float32)
    carried = phi.offsets(offsets).astype(np.float32)
    total = (trust[..., None] * carried).transpose(0, 2, 1) @ near.T
    weight = trust @ near.T
    left = np.minimum(trust.mean(axis=1) / MIN_TRUSTED_SHARE, 1)[:, None, None]
    return np.asarray(left * (total / np.maximum(weight, 1e-12)[:, None]).transpose(0, 2, 1), np.float32)
