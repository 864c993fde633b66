"""The far cheek of a turned face: where a face comes to the head's outline, skin goes on behind it before hair begins."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.texture.head_area import Head
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import distance_to

MAX_CHEEK_HALF_AXES = 1.12
"""How far out, in half axes of the face's oval, a cheek may reach."""
MAX_CHEEK_HEIGHT_SHARE = 0.3
"""How far above the face's middle the far cheek reaches, as a share of the way to the top: a forehead is beside
hair."""
MIN_FACE_TURN = 0.2
"""How far a face is turned that has a far cheek: else an ear is at the outline."""
SKIN_COLOUR_RATIO = 0.6
"""How much nearer to the face's colours than to hair's those are that the cheek goes on with."""
CHEEK_SEEN_BAND_PIXELS = 3.0
"""Pixels of the grid from the outline in which it must be seen."""
CHEEK_REACH_HALF_WIDTHS, CHEEK_FADE_SHARE = 0.35, 0.3
"""How far behind the outline the far cheek goes on, in half widths of the face, and over which share of that it
ends."""
CHEEK_COLOUR_BLUR_PIXELS = 2.0
"""Pixels of the grid over which the far cheek's colours are averaged."""


def with_far_cheek(
    back: NDArray[np.uint8],
    rgb: NDArray[np.uint8],
    hair: NDArray[np.bool_],
    head: Head,
    half_width: float,
    turned: float,
) -> NDArray[np.uint8]:
    """The `back` of a head (h, w, 3) with the cheek that its front `rgb` (h, w, 3) shows at the outline; `hair` (h, w) as it is
    seen. `half_width`: the face's, pixels; `turned`: where to, as `face_region.face_turn` says."""
    if abs(turned) < MIN_FACE_TURN:
        return back
    far = np.sign(turned) * head.across > 0
    scale, beside = (
        head.scale,
        far & head.mask & (head.out < MAX_CHEEK_HALF_AXES) & (head.up < MAX_CHEEK_HEIGHT_SHARE) & (head.up > -1),
    )
    cheek = beside & (head.depth > 0.5) & (head.depth < CHEEK_SEEN_BAND_PIXELS) & ~hair
    middle = head.mask & (head.out < 0.7)
    if not (cheek.any() and middle.any() and hair.any()):
        return back
    colours = cv2.cvtColor(cv2.GaussianBlur(rgb, (0, 0), max(scale, 1.0)), cv2.COLOR_RGB2LAB).astype(np.float32)
    skin, other = (np.median(colours[where], axis=0) for where in (middle, hair))
    fine = cv2.cvtColor(rgb, cv2.COLOR_RGB2LAB).astype(np.float32)
    plain = cheek & (head.depth > 1.5)  # no eye, no shadow
    for shown in (colours, fine):
        plain &= np.linalg.norm(shown - skin, axis=-1) < SKIN_COLOUR_RATIO * np.linalg.norm(shown - other, axis=-1)
    if not plain.any():
        return back
    reach = CHEEK_REACH_HALF_WIDTHS * half_width
    away = distance_to(cheek)
    share = np.clip((reach - away) / (CHEEK_FADE_SHARE * reach), 0, 1)
    share = cv2.GaussianBlur(share, (0, 0), CHEEK_COLOUR_BLUR_PIXELS * scale)[..., None] * head.mask[..., None]
    drawn = cv2.GaussianBlur(rgb[nearest_in(plain)], (0, 0), CHEEK_COLOUR_BLUR_PIXELS * scale)
    return np.asarray(back + share * (drawn.astype(np.float32) - back) + 0.5, np.float32).clip(0, 255).astype(np.uint8)
