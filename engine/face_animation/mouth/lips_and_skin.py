"""Lips beside the skin around them: they press it together, and do not go over it.

What the skin above the driver's upper lip has room for, or that of the chin, a target with a shorter lip or chin may not
have. Carried over as it is, a mouth that is torn open smears over the skin, or the skin over it. So the skin gives way up
to the nose, and down to the jaw, and where it cannot any more, the lips stop.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import CHIN_VERTEX, FOREHEAD_VERTEX

UPPER_LIP_COLUMNS = (
    *((184, 183, 191), (74, 42, 80), (73, 41, 81), (72, 38, 82), (11, 12, 13)),
    *((302, 268, 312), (303, 271, 311), (304, 272, 310), (408, 407, 415)),
)
"""Columns across the upper lip, without its border."""
SKIN_ABOVE_COLUMNS = (
    *((185, 186, 216), (40, 92, 64), (39, 165, 98), (37, 167, 97), (0, 164, 2)),
    *((267, 393, 326), (269, 391, 327), (270, 322, 294), (409, 410, 436)),
)
"""What each of `UPPER_LIP_COLUMNS` goes on with, from the border of the lip over the skin to the nose, or the cheek
beside it."""
LOWER_LIP_COLUMNS = (
    *((77, 96, 95), (90, 89, 88), (180, 179, 178), (85, 86, 87), (16, 15, 14)),
    *((315, 316, 317), (404, 403, 402), (320, 319, 318), (307, 325, 324)),
)
"""Columns across the lower lip, without its border."""
SKIN_BELOW_COLUMNS = (
    *((146, 43, 202, 210, 169, 150), (91, 106, 204, 211, 170, 149), (181, 182, 194, 32, 140, 176)),
    *((84, 83, 201, 208, 171, 148), (17, 18, 200, 199, 175, 152), (314, 313, 421, 428, 396, 377)),
    *((405, 406, 418, 262, 369, 400), (321, 335, 424, 431, 395, 378), (375, 273, 422, 430, 394, 379)),
)
"""What each of `LOWER_LIP_COLUMNS` goes on with, down to the jaw's contour."""
LIP_COLUMNS = (
    tuple((*lip, skin[0]) for lip, skin in zip(UPPER_LIP_COLUMNS, SKIN_ABOVE_COLUMNS, strict=True)),
    tuple((*lip, skin[0]) for lip, skin in zip(LOWER_LIP_COLUMNS, SKIN_BELOW_COLUMNS, strict=True)),
)
"""Of the upper and the lower lip, nine columns each; the last but one of a column is the inner edge, the last the border."""
MIN_SKIN_SHARE = 0.2
"""Share of its usual breadth that skin keeps, at least."""
NARROW_LIP_SKIN_SHARE = 0.3
"""Share of its usual breadth that skin under the nose keeps, at least, where it does on the driver's face."""
EVEN_SHARE, MAX_EVEN_SHARE = 0.85, 0.6
"""Share of a column's remaining breadth that each part of it keeps, and up to which it is led to that. The part beside
the lip alone would be pressed to a line in which the picture's pixels break up."""
NEIGHBOUR_WEIGHTS = np.array([1, 2, 3, 2, 1]) / 9
"""How much columns of a lip draw their neighbours along."""


def philtrum_compression(faces: NDArray[np.floating], neutral: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) how far the skin between nose and mouth is pressed together on the driver's faces (N, 478, 2 or 3): what is
    left of its breadth, from `MIN_SKIN_SHARE` to `NARROW_LIP_SKIN_SHARE`. Faces are upright as the `neutral` one (478,
    2 or 3) is."""
    lip, _, nose = SKIN_ABOVE_COLUMNS[4]
    now, usual = ((one[..., lip, :2] - one[..., nose, :2]) @ _down(neutral) for one in (faces, neutral))
    return np.asarray(np.clip(now / np.maximum(usual, 1e-6), MIN_SKIN_SHARE, NARROW_LIP_SKIN_SHARE), float)


def keep_lips_off_skin(faces: NDArray[np.floating], rest: NDArray[np.floating], room: NDArray[np.floating]) -> None:
    """Lead lips of faces (N, 478, 2 or 3), inclined as at rest, that go over the skin beside them back to its edge, in place
    and along the face.

    Parameters
    ----------
    rest : (478, 2 or 3) the same face at rest; or (N, 478, 2 or 3), of each. room : (N,) share of its breadth that the skin under the nose keeps.
    """
    least = np.full_like(room, MIN_SKIN_SHARE)
    for lips, skin, share, way in (
        (UPPER_LIP_COLUMNS, SKIN_ABOVE_COLUMNS, room, -1),
        (LOWER_LIP_COLUMNS, SKIN_BELOW_COLUMNS, least, 1),
    ):
        columns = np.array(skin)
        out = way * _down(rest)
        usual = np.diff(_along(rest[..., columns, :2], out), axis=-1)
        along = _along(faces[:, columns, :2], out)
        moved = in_order(along, np.minimum(usual, usual * _kept_share(along, usual, share)[..., None])) - along
        moved[..., 0] = with_neighbours(moved[..., 0])
        faces[:, columns, :2] += moved[..., None] * out[..., None, None, :]
        faces[:, np.array(lips), :2] += moved[:, :, :1, None] * out[..., None, None, :]


def _kept_share(
    along: NDArray[np.floating], usual: NDArray[np.floating], least: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(N, C) the share of its usual breadth that each part of columns of skin at places (N, C, K) keeps: they give way evenly, and `least` (N,)
    where there is no more room. usual : (C, K - 1) or (N, C, K - 1)."""
    left = (along[..., -1] - along[..., 0]) / np.maximum(usual.sum(axis=-1), 1e-6)
    return np.asarray(np.maximum(least[:, None], np.minimum(EVEN_SHARE * left, MAX_EVEN_SHARE)), float)


def in_order(
    along: NDArray[np.floating], least: NDArray[np.floating], gives: NDArray[np.floating] | None = None
) -> NDArray[np.floating]:
    """Places (..., K) along a way, moved as little as it takes to be `least` (..., K - 1) apart, the last one not at
    all. Each makes room for those before it as long as there is any, and as far as it `gives` way (..., K), in [0,
    1]."""
    kept = along.copy()
    give = np.ones(along.shape[-1]) if gives is None else gives
    for k in range(1, along.shape[-1] - 1):
        kept[..., k] += give[..., k] * np.maximum(kept[..., k - 1] + least[..., k - 1] - kept[..., k], 0)
    for k in range(along.shape[-1] - 2, -1, -1):
        kept[..., k] = np.minimum(kept[..., k], kept[..., k + 1] - least[..., k])
    return kept


def with_neighbours(moves: NDArray[np.floating]) -> NDArray[np.floating]:
    """How far the columns (N, 9) of a lip move back where each draws those beside it along: no less than by themselves."""
    drawn = cv2.filter2D(moves, -1, NEIGHBOUR_WEIGHTS[None], borderType=cv2.BORDER_REPLICATE)
    return np.asarray(np.where(np.abs(drawn) > np.abs(moves), drawn, moves))


def _down(face: NDArray[np.floating]) -> NDArray[np.float64]:
    """(..., 2) the way down faces (..., 478, 2 or 3)."""
    axis = face[..., CHIN_VERTEX, :2].astype(float) - face[..., FOREHEAD_VERTEX, :2]
    return np.asarray(axis / np.linalg.norm(axis, axis=-1, keepdims=True), float)


def _along(places: NDArray[np.floating], way: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., C, K) how far places (..., C, K, 2) are along a way (..., 2)."""
    return np.asarray(np.einsum("...ckd,...d->...ck", places, way))
