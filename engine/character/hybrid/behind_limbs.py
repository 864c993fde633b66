"""What a trunk has behind limbs: what is beside them, mirrored at their border.

The paper fills these regions by PatchMatch. Here a hanging arm hides a side of the trunk that has but one border with what is seen,
and what is searched for freely there is found anywhere, as trousers below a striped shirt; a mirror keeps stripes, belts
and hems at their height.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import dilate_mask

MIXED_COLOUR_BAND_SHARE = 0.004
"""Beside limbs, as a share of the picture's longer side, colours are mixed with theirs, or in their shadow, and are not mirrored."""

MAX_MIRROR_DISTANCE_SHARE = 0.025
"""How far from the border colours come from at most, as a share of the longer side; beyond twice as much they begin anew."""


def mirrored_behind(rgb: NDArray[np.uint8], hidden: NDArray[np.bool_], shown: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """A picture (H, W, 3) in which what is `hidden` (H, W) has the colours of what is `shown` (H, W) as far on the other side of
    the nearest border, to and fro within `MAX_MIRROR_DISTANCE_SHARE`; where nothing is shown so far away, those of the
    border."""
    near = dilate_mask(hidden, max(2, round(MIXED_COLOUR_BAND_SHARE * max(hidden.shape))))
    source: NDArray[np.bool_] = np.logical_and.reduce([shown, ~hidden, ~near])
    if not hidden.any() or not source.any():
        return rgb
    rows, columns = nearest_in(source)
    y, x = np.nonzero(hidden)
    border = np.stack([rows[y, x], columns[y, x]], 1)
    away = border - np.stack([y, x], 1)
    far = np.linalg.norm(away, axis=1)
    deep = MAX_MIRROR_DISTANCE_SHARE * max(hidden.shape)
    across = border + np.rint(away * ((deep - abs(far % (2 * deep) - deep)) / np.maximum(far, 1e-6))[:, None]).astype(
        int
    )
    inside = np.asarray(((across >= 0) & (across < hidden.shape)).all(1), np.bool_)
    across[~inside] = border[~inside]
    known = source[across[:, 0], across[:, 1]]
    across[~known] = border[~known]
    out = rgb.copy()
    out[y, x] = rgb[across[:, 0], across[:, 1]]
    return out
