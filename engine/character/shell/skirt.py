"""A skirt, or the tails of a coat: a tube around both legs, from the rows of cloth that hangs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.body.parts import BODY_PARTS
from engine.character.parts.free_cloth import FreeCloth, Ring
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS
from engine.character.shell.outlines import hanging
from engine.character.shell.piece import Piece
from engine.character.shell.template_mesh import TemplateMesh

PIXEL_ROWS_PER_RING, MIN_TUBE_RINGS = 3, 6
"""Rows of pixels for each of the tube's, and of these with which it is worth being one."""
ROW_VERTICES = 64
"""Vertices of a row."""
BODY_CLEARANCE_PIXELS, CLOTH_THICKNESS_PIXELS = 3.0, 1.5
"""Pixels between cloth and body in front and behind, and between its outside and its inside."""
LOOSENING_SHARE = 0.3
"""Share of the tube's length, from above, over which it goes from the body's depth to the cloth's."""
BODY_WINDOW_PIXELS = 5.0
"""Pixels above and below a row within which the body is looked at."""
MIN_BODY_WEIGHT = 0.9
"""Share of trunk and legs in what moves a vertex that a skirt goes around."""
HEM_SMOOTHING_VERTICES = 2.0
"""Vertices over which a hem is smoothed: at the sides of the tube the picture's columns say little."""
HEM_LEG_WEIGHT = 0.75
"""How much a hem goes with the legs."""
RIGID_WAIST_SHARE = 0.1
"""Share of the tube's length, from above, that goes with the hips alone."""


def skirt_of(mesh: TemplateMesh, pictured: NDArray[np.float64], labels: Labels) -> Piece | None:
    """The tube of cloth that hangs, around the shell as `pictured` (V, 3); None where none does."""
    cloth = labels.cloth
    if cloth is None or not cloth.hangs:
        return None
    area = hanging(cloth, labels.labels)
    rings = [ring for ring in cloth.rings if area[ring.row].any()][::PIXEL_ROWS_PER_RING]
    if len(rings) < MIN_TUBE_RINGS:
        return None
    rows = np.array([ring.row for ring in rings], np.float64)
    left, right = (gaussian_filter1d(np.array([end(ring) for ring in rings]), 1.5) for end in (_left, _right))
    near, far = _depths(mesh, pictured, rings)
    angle = np.arange(ROW_VERTICES) / ROW_VERTICES * 2 * np.pi
    across, along = np.sin(angle), np.cos(angle)

    def tube(inwards: float) -> NDArray[np.float64]:
        x = ((left + right) / 2)[:, None] + ((right - left) / 2 - inwards)[:, None] * across
        z = ((near + far) / 2)[:, None] + ((near - far) / 2 - inwards)[:, None] * along
        y = np.repeat(rows[:, None], ROW_VERTICES, 1)
        y[-1] = _hem(cloth, area, x[-1], y[-1])
        return np.stack([x, y, z], 2).reshape(-1, 3)

    vertices = np.concatenate([tube(0.0), tube(CLOTH_THICKNESS_PIXELS)])
    triangles = _double_wall(len(rows))
    down = np.clip((vertices[:, 1] - rows[0]) / (rows[-1] - rows[0]), 0, 1)
    share = HEM_LEG_WEIGHT * np.clip((down - RIGID_WAIST_SHARE) / (1 - RIGID_WAIST_SHARE), 0, 1)
    middle, half = (
        np.interp(vertices[:, 1], rows, (left + right) / 2),
        np.interp(vertices[:, 1], rows, right - left) / 2,
    )
    aside = np.clip(0.9 * (vertices[:, 0] - middle) / np.maximum(half, 1) + 0.5, 0, 1)
    aside = aside * aside * (3 - 2 * aside)
    first, second = _legs_by_side(mesh, pictured)
    weights = np.stack([1 - share, share * (1 - aside), share * aside, 0 * share], 1)
    joints = [mesh.names.index(name) for name in ("Hips", first, second, "Hips")]
    order = np.argsort(-weights, 1, kind="stable")
    bones = np.take_along_axis(np.tile(joints, (len(vertices), 1)), order, 1)
    weights = np.take_along_axis(weights, order, 1)
    return Piece("skirt", vertices, triangles, bones.astype(np.intp), weights.astype(np.float32))


def _left(ring: Ring) -> float:
    return ring.first - 0.5


def _right(ring: Ring) -> float:
    return ring.last + 0.5


def _depths(
    mesh: TemplateMesh, pictured: NDArray[np.float64], rings: list[Ring]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How near and how far (R,) the tube is in its rows: as the cloth is taken to be, and around the body."""
    body = pictured[mesh.parts[:, [BODY_PARTS.index("torso"), *LEG_LABELS]].sum(1) > MIN_BODY_WEIGHT]
    middle, half = (
        gaussian_filter1d(np.array(v, float), 2) for v in zip(*((r.middle, r.half) for r in rings), strict=True)
    )
    near, far = np.full(len(rings), np.nan), np.full(len(rings), np.nan)
    for k, ring in enumerate(rings):
        depth = body[np.abs(body[:, 1] - ring.row) < BODY_WINDOW_PIXELS, 2]
        if len(depth):
            near[k], far[k] = depth.max() + BODY_CLEARANCE_PIXELS, depth.min() - BODY_CLEARANCE_PIXELS
    there = np.isfinite(near)
    if there.any():
        at = np.arange(len(rings))
        near, far = (gaussian_filter1d(np.interp(at, at[there], v[there]), 3) for v in (near, far))
        loose = np.clip(at / (LOOSENING_SHARE * len(rings)), 0, 1)
        front, back = np.maximum(middle + half, near), np.minimum(middle - half, far)
        return near + loose * (front - near), far + loose * (back - far)
    return middle + half, middle - half


def _hem(
    cloth: FreeCloth, area: NDArray[np.bool_], columns: NDArray[np.float64], rows: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How low (AROUND,) the hem is at some columns: as low as the picture has cloth there."""
    hem = area | cloth.lower
    x = np.clip(np.rint(columns).astype(int), 0, hem.shape[1] - 1)
    lowest = np.where(hem.any(0), hem.shape[0] - 1 - np.argmax(hem[::-1], 0), 0)[x]
    return np.asarray(
        np.maximum(rows, gaussian_filter1d(np.maximum(lowest + 0.5, rows), HEM_SMOOTHING_VERTICES, mode="wrap"))
    )


def _double_wall(rows: int) -> NDArray[np.int32]:
    """Triangles of a tube of so many rows of `ROW_VERTICES` vertices and of the same within it, joined above and below."""
    outer = np.arange(rows * ROW_VERTICES).reshape(rows, ROW_VERTICES)
    inner = outer + rows * ROW_VERTICES

    def wall(upper: NDArray[np.intp], lower: NDArray[np.intp]) -> NDArray[np.intp]:
        following, below = np.roll(upper, -1, -1), np.roll(lower, -1, -1)
        return np.concatenate(
            [
                np.stack([upper, lower, below], -1).reshape(-1, 3),
                np.stack([upper, below, following], -1).reshape(-1, 3),
            ]
        )

    return np.concatenate(
        [
            wall(outer[:-1], outer[1:]),
            wall(inner[:-1], inner[1:])[:, ::-1],
            wall(inner[0], outer[0]),
            wall(outer[-1], inner[-1]),
        ]
    ).astype(np.int32)


def _legs_by_side(mesh: TemplateMesh, pictured: NDArray[np.float64]) -> tuple[str, str]:
    """The thighs' joints, the one at the picture's left first."""
    names = ("LeftUpLeg", "RightUpLeg")
    places = [pictured[mesh.share(name) > 0.5, 0].mean() for name in names]
    return names if places[0] < places[1] else names[::-1]
