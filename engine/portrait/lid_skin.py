"""The skin of upper lids that close: a picture of open eyes shows hardly any of it.

What is seen of it there, a narrow strip with lashes and their shadow, would be drawn out over the whole eye and make a
shut one black. So a closing lid takes the colours of the skin above it, more the further it closes.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.mesh_warp import inverse_map

STRIPS = (
    ((247, 30, 29, 27, 28, 56, 190), (246, 161, 160, 159, 158, 157, 173)),
    ((467, 260, 259, 257, 258, 286, 414), (466, 388, 387, 386, 385, 384, 398)),
)
"""Vertices of the skin above the upper lid, and of the lid's edge, from the eye's outer corner on; right eye first."""
CORNERS = ((33, 133), (263, 362))
"""Where both end."""
SAMPLE = 0.06
"""Radius of the neighbourhood whose colour counts, in eye widths."""
BEGINS = 0.35
"""Share of the way from the skin above to the lid's edge over which the colours go over."""
HIGHER = ((113, 225, 224, 223, 222, 221, 189), (342, 445, 444, 443, 442, 441, 413))
"""Vertices further up, below the brow: the lighter of both is less of a shadow."""
SHADED = 0.12
"""By how much a lid is darker at its edge."""
_TRIANGLES = np.array([t for k in range(8) for t in ((k, k + 1, 9 + k), (k + 1, 10 + k, 9 + k))], np.int32)


def lid_colours(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """(2, 9, 3) the skin above each lid of a target (H, W, 3) with its face at `mesh` (478, 2 or 3), from corner to corner;
    right eye first."""
    return np.stack([_colours(rgb, mesh, side) for side in range(2)])


def draw_lid(
    frame: NDArray[np.uint8], colours: NDArray[np.float32], mesh: NDArray[np.floating], side: int, share: float
) -> None:
    """Give the upper lid in a frame (H, W, 3), in place, a `share` of the `colours` (9, 3).

    Parameters
    ----------
    mesh : (478, 2) the face in this frame. side : 0 right, 1 left.
    """
    points = _strip(mesh, side)
    low = np.maximum(np.floor(points.min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(points.max(axis=0)).astype(int) + 1, frame.shape[1::-1])
    if share == 0 or (high - low).min() < 2:
        return
    field = inverse_map(
        (points - low).astype(np.float32),
        np.column_stack([np.concatenate([colours, (1 - SHADED) * colours]), np.repeat([0, 1], 9)]).astype(np.float32),
        _TRIANGLES,
        (int(high[1] - low[1]), int(high[0] - low[0])),
        outside=-1.0,
    )
    t = np.clip(field[..., 3:] / BEGINS, 0, 1)
    part = frame[low[1] : high[1], low[0] : high[0]]
    part[:] = np.clip(part + share * t * t * (3 - 2 * t) * (field[..., :3] - part) + 0.5, 0, 255).astype(np.uint8)


def _strip(mesh: NDArray, side: int) -> NDArray:
    """(18, 2) the skin above from corner to corner, then the lid's edge."""
    outer, inner = CORNERS[side]
    return np.asarray(mesh[[v for row in STRIPS[side] for v in (outer, *row, inner)], :2])


def _colours(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float32]:
    width = float(np.linalg.norm(mesh[CORNERS[side][0], :2] - mesh[CORNERS[side][1], :2]))
    blurred = cv2.GaussianBlur(rgb, (0, 0), max(SAMPLE * width, 0.5))
    at = mesh[np.array([STRIPS[side][0], HIGHER[side]]), :2].round().astype(int).clip(0, np.array(rgb.shape[1::-1]) - 1)
    seen = blurred[at[..., 1], at[..., 0]].astype(np.float32)
    lighter = np.where((seen[0].sum(1) > seen[1].sum(1))[:, None], seen[0], seen[1])
    return np.asarray(cv2.GaussianBlur(lighter[[0, *range(7), 6]], (1, 5), 0, borderType=cv2.BORDER_REPLICATE))
