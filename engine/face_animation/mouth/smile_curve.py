"""A driver's smile on a mouth whose corners hang lower at rest: it ends as curved as the driver's.

Carried as offsets alone, a smile widens and raises such a mouth, and leaves it flat or bent down: it does not read as a smile.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lips_and_skin import (
    LOWER_LIP_COLUMNS,
    SKIN_ABOVE_COLUMNS,
    SKIN_BELOW_COLUMNS,
    UPPER_LIP_COLUMNS,
)
from engine.face_animation.mouth.skin_around_lips import with_lips
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import CHIN_VERTEX, FOREHEAD_VERTEX, MOUTH_CORNER_VERTICES

CORNER_VERTICES = (61, 76, 62, 78, 291, 306, 292, 308)
"""Of the right corner of the mouth and of the left one, each from the skin inwards."""
LIPS_MIDDLE_VERTICES, INNER_UPPER_LIP_VERTICES = (0, 13, 14, 17), (13,)
"""Vertices of the middle of both lips, and of the upper one's inner edge: a smile that shows teeth bends that up,
whatever the lower lip does."""
WIDENING_SHARES, RISE_SHARES = (0.03, 0.12), (0.02, 0.07)
"""By how much of its width at rest a mouth gets wider and its corners higher, where it begins to smile and where it
does so fully. Both count together: lips that are drawn wide alone say e, or are afraid."""
MAX_LIFT_SHARE = 0.16
"""Of the mouth's width, by which its corners are raised beside what the driver's are, at most."""


class SmileCurve:
    """A target's mouth, whose smile is curved as its driver's is: of `rest` (478, 2 or 3), which stands for the `target` (478, 2 or 3), as
    pictured."""

    def __init__(self, rest: NDArray[np.floating], target: NDArray[np.floating]):
        self._rest = rest[:, :2].astype(float)
        self._target = target[:, :2].astype(float)

    def lift(self, positions: NDArray[np.floating], meshes: NDArray[np.floating], strength: float) -> None:
        """Raise the corners of the target's mouth at `positions` (N, 478, 3) as the driver of the `meshes` (N, 478, 2 or 3), upright as at rest,
        smiles, in place; `strength` in [0, 1]."""
        share = strength * smile_share(meshes, self._rest)
        heights = [
            corner_height(meshes, _up(self._rest), middle) - corner_height(positions, _up(self._target), middle)
            for middle in (LIPS_MIDDLE_VERTICES, INNER_UPPER_LIP_VERTICES)
        ]
        lower = np.maximum(*heights)
        lift = share * np.clip(lower, 0, MAX_LIFT_SHARE) * _width(positions)
        positions[..., :2] += lift[:, None, None] * corner_influence()[:, None] * _up(self._target)


def corner_height(
    faces: NDArray[np.floating], up: NDArray[np.float64], middle: tuple[int, ...] = LIPS_MIDDLE_VERTICES
) -> NDArray[np.float64]:
    """(...,) how much higher a mouth's corners are than its `middle`, of faces (..., 478, 2 or 3) whose way `up` (2,) is known, in widths of the mouth."""
    plane = faces[..., :2].astype(float)
    apart = plane[..., list(MOUTH_CORNER_VERTICES), :].mean(axis=-2) - plane[..., list(middle), :].mean(axis=-2)
    return np.asarray(apart @ up / _width(plane))


def smile_share(meshes: NDArray[np.floating], rest: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) how far faces (N, 478, 2 or 3), upright as at `rest` (478, 2 or 3), smile: their mouths are wider, and their corners higher."""
    right, left = (meshes[:, corner, :2].astype(float) for corner in MOUTH_CORNER_VERTICES)
    usual = rest[:, :2].astype(float)
    wider = np.linalg.norm(left - right, axis=1) / _width(usual) - 1
    higher = ((right + left) / 2 - usual[list(MOUTH_CORNER_VERTICES)].mean(axis=0)) @ _up(usual) / _width(usual)
    return smoothstep(wider, *WIDENING_SHARES) * smoothstep(higher, *RISE_SHARES)


@cache
def corner_influence() -> NDArray[np.float64]:
    """(478,) how much each vertex goes along with the mouth's corners: the lips bend as a parabola, and the skin around them with them."""
    skin = [column[0] for columns in (SKIN_ABOVE_COLUMNS, SKIN_BELOW_COLUMNS) for column in columns]
    lips = np.unique([*np.ravel(UPPER_LIP_COLUMNS), *np.ravel(LOWER_LIP_COLUMNS), *skin, *CORNER_VERTICES])
    across = canonical_face()[:, 0].astype(float)
    bend = np.minimum((across[lips] / across[MOUTH_CORNER_VERTICES[1]]) ** 2, 1)
    return with_lips(lips, bend[:, None])[:, 0]


def _width(faces: NDArray[np.floating]) -> NDArray[np.float64]:
    """(...,) of the mouths of faces (..., 478, 2 or 3)."""
    across = faces[..., MOUTH_CORNER_VERTICES[1], :2] - faces[..., MOUTH_CORNER_VERTICES[0], :2]
    return np.asarray(np.maximum(np.linalg.norm(across, axis=-1), 1e-6), float)


def _up(face: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) the way up a face (478, 2)."""
    axis = face[FOREHEAD_VERTEX] - face[CHIN_VERTEX]
    return np.asarray(axis / max(float(np.linalg.norm(axis)), 1e-6), float)
