"""Lips beside the skin above and below them: they press it together, and do not go over it.

Where a mouth is torn open, a tracker has the lips further out than they are, beyond the vertices of the skin beside them;
and what two lips' breadth of skin allow on the driver's face, a target with a shorter lip or chin has no room for.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

UPPER = (
    *((186, 185, 184, 183, 191), (92, 40, 74, 42, 80), (165, 39, 73, 41, 81), (167, 37, 72, 38, 82), (164, 0, 11, 12, 13)),
    *((393, 267, 302, 268, 312), (391, 269, 303, 271, 311), (322, 270, 304, 272, 310), (410, 409, 408, 407, 415)),
)  # fmt: skip
"""Columns across the upper lip: a vertex of the skin above, then those of the lip from its border to the mouth."""
LOWER = (
    *((43, 146, 77, 96, 95), (106, 91, 90, 89, 88), (182, 181, 180, 179, 178), (83, 84, 85, 86, 87), (18, 17, 16, 15, 14)),
    *((313, 314, 315, 316, 317), (406, 405, 404, 403, 402), (335, 321, 320, 319, 318), (273, 375, 307, 325, 324)),
)  # fmt: skip
"""The same across the lower lip, from the skin below it."""
BROW, CHIN = 10, 152
"""Where the face's axis begins and ends."""
LEAST, MOST = 0.1, 0.6
"""Shares of its usual breadth: skin is not pressed together by more than the first, and given a say from the second on."""
YIELDS = 0.5
"""Share of the way by which skin that is pressed on gives way on a target, rather than the lips."""
NARROW = 0.03
"""Eye distances: skin as narrow as this on the driver says nothing about how far it is pressed together."""


def breadths(faces: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 18) pixels along the face from the lips' borders to the skin vertices beside them, of meshes (N, 478, 2 or 3);
    negative where lips lie over them."""
    down = _down(faces)[:, None]
    above, below = (faces[:, np.array(columns)[:, :2], :2] for columns in (UPPER, LOWER))
    return np.concatenate(
        [((above[:, :, 1] - above[:, :, 0]) * down).sum(-1), ((below[:, :, 0] - below[:, :, 1]) * down).sum(-1)], axis=1
    )


def pressed(faces: NDArray[np.floating], neutral: NDArray[np.floating], unit: float) -> NDArray[np.float64]:
    """(N, 18) the share of its breadth on the `neutral` face that is left of the skin at least, from `LEAST` to `MOST`, on
    faces (N, 478, 2 or 3) that are upright as the neutral one is; `unit` is their eye distance."""
    usual = breadths(neutral[None])
    share = breadths(faces) / np.maximum(usual, 1e-6)
    return np.asarray(np.where(usual > NARROW * unit, np.clip(share, LEAST, MOST), LEAST), float)


def clear_of_skin(faces: NDArray[np.floating], least: NDArray[np.floating], yields: float = 0.0) -> None:
    """Move the lips of faces (N, 478, 2 or 3), in place and along the face, so far that the skin beside them has a breadth
    of `least` (N or 1, 18), pixels, or none where that is negative. Of the way, the skin `yields` a share."""
    down = _down(faces)
    push = np.maximum(np.maximum(least, 0) - breadths(faces), 0)
    shares = np.array([-yields, *[1 - yields] * 4])[:, None]
    for columns, pushes, way in ((UPPER, push[:, :9], 1), (LOWER, push[:, 9:], -1)):
        faces[:, np.array(columns), :2] += way * pushes[:, :, None, None] * shares * down[:, None, None]


def _down(faces: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2) the way down the face."""
    axis = faces[:, CHIN, :2].astype(float) - faces[:, BROW, :2]
    return np.asarray(axis / np.linalg.norm(axis, axis=1, keepdims=True), float)
