"""Whether the fitted head is where frames have the person: without a face to hold it, under a helmet, it is not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.part_outlines import Silhouette
from engine.errors import Notice

MAX_HEAD_BESIDE_SHARE = 0.02
"""Share of the head's vertices that may lie beside the person in most frames: of heads that are right none do."""
HEAD_BESIDE_FRAMES = Notice(
    "head_beside_frames",
    "The avatar's head stands out of the person's outline in most frames: a helmet, a hood or a mask is not known. Look at "
    "the head closely, or film without.",
)


def beside_share(points: NDArray[np.floating], silhouettes: Sequence[Silhouette]) -> float:
    """Share of the `points` (N, 3) that lie beside the person in most of the silhouettes whose picture has them."""
    shown, beside = np.zeros(len(points), np.intp), np.zeros(len(points), np.intp)
    for one in silhouettes:
        pixels = one.camera.project(points)
        height, width = one.mask.shape
        columns, rows = np.rint(np.clip(pixels[:, :2], -1, [width, height])).astype(np.intp).T
        inside = (pixels[:, 2] > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        shown += inside
        beside[inside] += ~one.mask[rows[inside], columns[inside]]
    return float((2 * beside > shown).mean())
