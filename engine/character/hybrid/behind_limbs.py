"""What a trunk has behind limbs: what is beside them, mirrored at their border.

The paper fills these regions by PatchMatch. Here a hanging arm hides a side of the trunk that has but one border with
what is seen. What is searched for freely there is found anywhere, as trousers below a striped shirt. A mirror keeps
stripes, belts and hems at their height.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.nearest import nearest_in
from engine.imaging.filling.pull_push import pull_push
from engine.imaging.masks.mask_distance import dilate_mask, distance_to

SHADOW_BAND_SHARE = 0.008
"""Beside limbs, as a share of the picture's longer side, colours are mixed with theirs, or in their shadow, and are not mirrored."""
SEAM_PIXELS, SEAM_LIGHT_SMOOTHING_PIXELS, SEAM_FADE_SHARE = 2, 3.0, 0.02
"""Pixels beside what is hidden whose light it begins with, pixels over which that light is smoothed, and how far it
goes, as a share of the longer side."""
MAX_LIGHT_STEP = 30.0
"""Grey levels by which what is hidden may begin lighter or darker than it is further in: more is another colour, and no light."""
BORDER_SMOOTHING_SHARE = 0.006
"""Over how much the border is smoothed, as a share of the longer side."""
MAX_MIRROR_DISTANCE_SHARE = 0.025
"""How far from the border colours come from at most, as a share of the longer side; beyond twice as much they begin anew."""


def mirrored_behind(rgb: NDArray[np.uint8], hidden: NDArray[np.bool_], shown: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """A picture (H, W, 3) in which what is `hidden` (H, W) has mirrored colours: those of what is `shown` (H, W) as far
    on the other side of the nearest border, to and fro within `MAX_MIRROR_DISTANCE_SHARE`. Where nothing is shown so
    far away, it has the border's. Where it meets what is shown it is as light as that, and goes over from there."""
    longest = max(hidden.shape)
    shadow = dilate_mask(hidden, max(2, round(SHADOW_BAND_SHARE * longest)))
    source = shown & ~shadow
    source &= (
        cv2.GaussianBlur(source.astype(np.float32), (0, 0), BORDER_SMOOTHING_SHARE * longest) > 0.5
    )  # else no mirror
    if not hidden.any() or not source.any():
        return rgb
    seam = shown & ~hidden & dilate_mask(hidden, SEAM_PIXELS)
    rows, columns = nearest_in(source)
    y, x = np.nonzero(hidden | seam)
    border = np.stack([rows[y, x], columns[y, x]], 1)
    away = border - np.stack([y, x], 1)
    far = np.linalg.norm(away, axis=1)
    deep = MAX_MIRROR_DISTANCE_SHARE * longest
    across = border + np.rint(away * ((deep - abs(far % (2 * deep) - deep)) / np.maximum(far, 1e-6))[:, None]).astype(
        int
    )
    inside = np.asarray(((across >= 0) & (across < hidden.shape)).all(1), np.bool_)
    across[~inside] = border[~inside]
    known = source[across[:, 0], across[:, 1]]
    across[~known] = border[~known]
    mirrored = rgb.astype(np.float32)
    mirrored[y, x] = rgb[across[:, 0], across[:, 1]]
    weight = seam.astype(np.float32)[..., None]
    step = np.clip(rgb - mirrored, -MAX_LIGHT_STEP, MAX_LIGHT_STEP) * weight
    told, count = (cv2.GaussianBlur(one, (0, 0), SEAM_LIGHT_SMOOTHING_PIXELS) for one in (step, weight[..., 0]))
    lighter = told / np.maximum(count, 1e-6)[..., None]
    fading = np.exp(-distance_to(seam) / (SEAM_FADE_SHARE * longest))[..., None]
    lighter = pull_push(lighter, weight[..., 0]) * fading
    out = rgb.copy()
    out[hidden] = np.clip(mirrored + lighter + 0.5, 0, 255)[hidden].astype(np.uint8)
    return out
