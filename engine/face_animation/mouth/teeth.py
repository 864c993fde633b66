"""The teeth that a picture shows: they keep their shape, and lips that move uncover or cover them.

Drawn out with the lips they would become long where a mouth is pursed, and broad where it laughs. So the inside of a mouth
that is open at rest turns with the head and goes with the opening, but is stretched only by as much as the opening is
larger than at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import (
    LOWER_INNER_LIP,
    UPPER_INNER_LIP,
    box_around,
    mouth_triangles,
    soft_polygon,
)
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER, RIGID_VERTICES, mouth_opening

MIN_TEETH_OPENING = 0.08
"""Opening of a mouth, its gap over its width, from which it shows teeth."""
PRESSED_GAP_SHARE = 0.2
"""Share of its gap at rest at which a closing mouth has pressed its inside together."""
PRESSING_GAP_SHARE = 0.6
"""Share of its gap at rest at which a closing mouth begins to press its inside together, teeth with the shadow of the lips on
them: a strip of bare teeth would shine between its lips."""


@dataclass(frozen=True)
class Teeth:
    """A target `rgb` (H, W, 3) whose mouth is open, and its face's `mesh` (478, 2), pixels."""

    rgb: NDArray[np.uint8]
    mesh: NDArray[np.float32]


def find_teeth(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> Teeth | None:
    """The teeth of a target (H, W, 3) with its face at `mesh` (478, 3); None where its lips are closed."""
    return Teeth(rgb, mesh[:, :2].astype(np.float32)) if float(mouth_opening(mesh)) > MIN_TEETH_OPENING else None


def draw_teeth(frame: NDArray[np.uint8], teeth: Teeth, mesh: NDArray[np.floating], share: float = 1.0) -> None:
    """Draw a `share` of them between the lips of a frame (H, W, 3) with its face at `mesh` (478, 2), in place."""
    lips = mesh[list(LIPS_OUTER + LIPS_INNER), :2].astype(np.float32)
    box, share = box_around(lips, frame.shape[:2]), share * _share(teeth.mesh, mesh)
    if box is None or share == 0:
        return
    x0, y0, x1, y1 = box
    lips -= np.array([x0, y0], np.float32)
    shape = y1 - y0, x1 - x0
    origin = inverse_map(lips, teeth_positions(teeth.mesh, mesh), mouth_triangles(), shape, outside=-1.0)
    inside = cv2.remap(teeth.rgb, origin[..., 0], origin[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    part = frame[y0:y1, x0:x1]
    opening = share * soft_polygon(lips[len(LIPS_OUTER) :], shape)[..., None]
    part[:] = np.clip(part + opening * (inside.astype(np.float32) - part) + 0.5, 0, 255).astype(np.uint8)


def teeth_positions(rest: NDArray[np.floating], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """(40, 2) spots of the picture, with its face at `rest` (478, 2), for the outer and inner lips of a face at `mesh`
    (478, 2): their own for the outer ones, for the inner ones what lies behind them."""
    right = (rest[UPPER_INNER_LIP[-1]] - rest[UPPER_INNER_LIP[0]]).astype(float)
    axes = np.stack([right, (-right[1], right[0])]) / np.linalg.norm(right)  # to the right, and down
    seen, now = rest @ axes.T, mesh @ np.linalg.inv(_turn(rest, mesh)) @ axes.T
    along, middle, gap = _opening(seen)
    now_along, _, now_gap = _opening(now)
    shrink = min(1.0, float(np.ptp(along) / max(np.ptp(now_along), 1e-6)))
    moved = (along[0] + along[-1]) / 2 - shrink * (now_along[0] + now_along[-1]) / 2
    at = moved + shrink * now_along
    half = np.minimum(now_gap, np.interp(at, along, gap)) / 2
    centre = np.interp(at, along, middle)
    behind = rest.astype(float)
    for lip, down in ((UPPER_INNER_LIP, centre - half), (LOWER_INNER_LIP, centre + half)):
        behind[list(lip)] = np.column_stack([moved + shrink * now[list(lip), 0], down]) @ axes
    return behind[list(LIPS_OUTER + LIPS_INNER)].astype(np.float32)


def _share(rest: NDArray[np.floating], mesh: NDArray[np.floating]) -> float:
    """How much teeth keep their shape between the lips of a face at `mesh` (478, 2), at `rest` (478, 2) fully."""
    ratio = float(np.linalg.norm(mesh[13] - mesh[14]) / np.linalg.norm(rest[13] - rest[14]))
    return float(np.clip((ratio - PRESSED_GAP_SHARE) / (PRESSING_GAP_SHARE - PRESSED_GAP_SHARE), 0, 1))


def _opening(mesh: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]:
    """Of each pair of facing inner lips (11,), from corner to corner: where along the mouth they are, how far down their
    middle is, and the gap between them."""
    upper, lower = mesh[list(UPPER_INNER_LIP)], mesh[list(LOWER_INNER_LIP)]
    return (upper[:, 0] + lower[:, 0]) / 2, (upper[:, 1] + lower[:, 1]) / 2, lower[:, 1] - upper[:, 1]


def _turn(rest: NDArray[np.floating], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 2) the linear map, to be multiplied from the right, that carries the head from `rest` (478, 2) to `mesh` (478, 2)."""
    a, b = (face[list(RIGID_VERTICES)].astype(float) for face in (rest, mesh))
    return np.asarray(np.linalg.lstsq(a - a.mean(axis=0), b - b.mean(axis=0), rcond=None)[0])
