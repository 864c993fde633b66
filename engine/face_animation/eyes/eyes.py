"""Eyes that look and close: the eyeball stays behind, the lids' skin moves over it.

The paper warps the eye with the face, so that a closing lid squeezes the iris, and names eyes that do not
close as its limit (section 7.3). Here the eyeball is a layer of its own (`eyeball`). A frame draws it into the opening that
the lids leave, with the iris where the driver looks, and the catch-light nearly where it was.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import EYE_OUTLINE_IRIS_CORNERS, Eyeball, white_light
from engine.face_animation.smoothstep import smoothstep

FULL_OPENING_CHANGE = 0.15
"""Change of the opening's area, as a share of it, from which the eyeball's layer is fully drawn."""
FULL_GAZE_CHANGE = 0.03
"""Change of the gaze, in eye widths, from which the eyeball's layer is fully drawn."""
SHUT_OPENING_SHARES = (0.25, 0.1)
"""Shares of the picture's opening at which what is below a lid's edge begins to be skin, and is."""
LID_SOFTNESS_EYE_WIDTHS, MIN_LID_SOFTNESS_PIXELS = 0.02, 0.4
"""Eye widths over which the eyeball passes into the lids, which are wet and round; pixels below which that is not to be seen."""
CLOSING_OPENING_SHARES = (0.95, 0.7)
"""Shares of the picture's opening at which a lid begins to take its own colours, and has."""
GLINT_MOTION_SHARE = 0.3
"""Of the iris' way, that the catch-light goes: it is a mirror image of what is before the face."""


def draw_eye(
    frame: NDArray[np.uint8], eye: Eyeball, mesh: NDArray[np.floating], side: int, look: NDArray[np.floating]
) -> None:
    """Draw an eyeball into the opening that the lids leave in a frame, in place.

    Parameters
    ----------
    mesh : (478, 2) the face in this frame. side : 0 right, 1 left. look : (2,) of the iris from where it rests, as `gaze.iris_shifts` has it.
    """
    contour, _, outer, inner = EYE_OUTLINE_IRIS_CORNERS[side]
    opening = mesh[list(contour), :2].astype(np.float32)
    low = np.maximum(np.floor(opening.min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(opening.max(axis=0)).astype(int) + 2, (frame.shape[1], frame.shape[0]))
    if (high - low).min() < 2:
        return
    shape = (int(high[1] - low[1]), int(high[0] - low[0]))
    cover = np.zeros(shape, np.uint8)
    cv2.fillPoly(cover, [np.round((opening - low) * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    soft = LID_SOFTNESS_EYE_WIDTHS * float(np.linalg.norm(opening[8] - opening[0]))
    if soft > MIN_LID_SOFTNESS_PIXELS:  # within the lids alone
        cover = np.minimum(cover, cv2.GaussianBlur(cover, (0, 0), soft))
    place = _place(eye, mesh[[outer, inner], :2], low)
    white = cv2.warpAffine(eye.white, place, shape[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    along = place[:, :2] @ (eye.ends[1] - eye.ends[0])
    across = np.array([-along[1], along[0]])
    shifted = place.copy()
    shifted[:, 2] += look[0] * along + look[1] * across
    iris = cv2.warpAffine(eye.iris, shifted, shape[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    disk = cv2.warpAffine(eye.iris_alpha, shifted, shape[::-1], flags=cv2.INTER_LINEAR)[..., None]
    white = np.asarray(white, np.float32) * white_light(eye.lid_shade, opening - low, shape)[..., None]
    ball = white + disk * (iris - white)
    place[:, 2] += GLINT_MOTION_SHARE * (look[0] * along + look[1] * across)
    glint = cv2.warpAffine(eye.glint, place, shape[::-1], flags=cv2.INTER_LINEAR)
    ball += glint[..., 3:] * disk * (glint[..., :3] - ball)
    below = frame[low[1] : high[1], low[0] : high[0]].astype(np.float32)
    alpha = _departure(eye, opening, look) * cover[..., None].astype(np.float32) / 255
    drawn = below + alpha * (ball - below)
    frame[low[1] : high[1], low[0] : high[0]] = np.clip(drawn + 0.5, 0, 255).astype(np.uint8)


def lid_closing_share(eye: Eyeball, mesh: NDArray[np.floating], side: int) -> float:
    """How far the upper lid of a face (478, 2) takes its own colours: 0 as long as it is open, 1 long before it is shut."""
    return float(smoothstep(_open_by_of(eye, mesh, side), *CLOSING_OPENING_SHARES))


def shut_share(eye: Eyeball, mesh: NDArray[np.floating], side: int) -> float:
    """How far the eye of a face (478, 2) is shut: 1 where its lids meet, 0 as long as something of it is to be seen."""
    return float(smoothstep(_open_by_of(eye, mesh, side), *SHUT_OPENING_SHARES))


def _open_by_of(eye: Eyeball, mesh: NDArray[np.floating], side: int) -> float:
    return _open_by(eye, mesh[list(EYE_OUTLINE_IRIS_CORNERS[side][0]), :2].astype(np.float32))


def _departure(eye: Eyeball, opening: NDArray[np.float32], look: NDArray[np.floating]) -> float:
    """How far the layer is drawn: 0 where lids and gaze are as in the picture, and 1 where they are not."""
    open_by = _open_by(eye, opening)
    moved = max(abs(open_by - 1) / FULL_OPENING_CHANGE, float(np.hypot(*look)) / FULL_GAZE_CHANGE)
    return min(moved, 1.0)


def _open_by(eye: Eyeball, opening: NDArray[np.float32]) -> float:
    """Area of the opening against the picture's."""
    width = float(np.linalg.norm(opening[8] - opening[0]))
    return float(cv2.contourArea(opening)) / max(width, 1.0) ** 2 / eye.opening


def _place(eye: Eyeball, ends: NDArray[np.floating], low: NDArray[np.int64]) -> NDArray[np.float64]:
    """(2, 3) from the layer's pixels to those of the box at `low`: the similarity of the eye's corners."""
    before, after = (eye.ends[1] - eye.ends[0]).astype(float), (ends[1] - ends[0]).astype(float)
    norm = float(before @ before)
    c, s = float(before @ after) / norm, float(before[0] * after[1] - before[1] * after[0]) / norm
    linear = np.array([[c, -s], [s, c]])
    shift = ends.mean(axis=0) - low - linear @ (eye.ends.mean(axis=0) - eye.corner)
    return np.column_stack([linear, shift])
