"""Eyes that are shut although the tracker sees them open.

Of lids without lashes to be seen, on a lowered head or a blurred one, a tracker takes the crease for the opening. But where
the iris was there is skin now: an eye that lost both the darkness it has in the neutral frame and the edges between iris
and white is shut. Neither says so alone: a shadow over the eyes takes the one, motion the other.
"""

from __future__ import annotations

from math import ceil

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import grey_opening

from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS, LID_SKIN_VERTEX_PAIRS
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE

EYE_CONTOURS = np.array((RIGHT_EYE, LEFT_EYE))
INNER_CORNER_INDEX = 8
"""Where in an eye's outline its inner corner stands; the outer one is its first."""
BLUR_PIXELS = 1.5
"""Pixels: standard deviation of what quiets sensor noise."""
SKIN_RING_PIXELS = 4
"""Pixels around the eye's outline in which its skin is seen."""
IRIS_PERCENTILE = 15
"""Percentile of grey within the outline that stands for the iris."""
SHUT_CONTRAST_SHARES = np.array((0.52, 0.62))
"""Shares of the neutral frame's darkness, and of its edges, below which an eye is shut."""
OPEN_CONTRAST_SHARES = np.array((0.64, 0.74))
"""Shares of the neutral frame's darkness, and of its edges, from which on the tracker is believed. Whichever open frame of
the real clips is taken as neutral, no open eye falls below them."""
MIN_EYE_DARKNESS = 0.3
"""Eyes of less darkness in the neutral frame, as behind dark glasses, tell nothing."""
LONE_SHUT_SHARE = 0.5
"""Of the contrast below which both eyes are shut, that below which one is beside an open one: a reflection in one glass of
spectacles veils its eye, and people blink with both."""
MIN_BLINK_SECONDS = 0.1
"""Seconds for which an eye is shut at least: a blink takes 0.1 to 0.4, and one that is shorter the tracker does not miss."""
MIN_OPEN_EYE_RATIO = 0.2
"""Height by width below which an eye of the neutral frame tells of no blinks; open ones have 0.28 to 0.45."""


def eye_contrast(
    grey: NDArray[np.uint8], face: NDArray[np.floating], neutral: NDArray[np.floating]
) -> NDArray[np.float64]:
    """How each eye stands out from its skin, (2, 2), right eye first: how much darker it is at its darkest, and the mean
    size of its horizontal gradient a pixel, both as a share of the skin's grey.

    Parameters
    ----------
    grey : (H, W) the face's crop. face : (478, 2) the mesh in it. neutral : (478, 2) the neutral frame's in its own crop: of
        its eyes' outlines, put between the corners of these.
    """
    return np.array(
        [_contrast(grey, neutral[eye] - _middle(neutral[eye]) + _middle(face[eye])) for eye in EYE_CONTOURS]
    )


def shut_by_contrast(meshes: NDArray[np.floating], contrast: NDArray[np.floating], neutral: int, fps: float) -> None:
    """Shut the eyes of meshes (N, 478, 3) that have lost their `contrast` (N, 2, 2) against the neutral frame's, in place:
    the upper lid goes down to the lower one, and the skin above it half the way. As far as an eye is shut for
    `MIN_BLINK_SECONDS` at least: what is gone for a moment was blurred by motion, or hidden by the rim of glasses."""
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    rest, at_rest = contrast[neutral], meshes[neutral]
    heights = np.linalg.norm(at_rest[upper] - at_rest[lower], axis=1).reshape(2, -1).max(axis=1)
    widths = np.linalg.norm(at_rest[EYE_CONTOURS[:, 0]] - at_rest[EYE_CONTOURS[:, INNER_CORNER_INDEX]], axis=1)
    tells = (rest[:, 0] >= MIN_EYE_DARKNESS) & (heights >= MIN_OPEN_EYE_RATIO * widths)
    shares = contrast / np.maximum(rest, 1e-6)
    kept, kept_alone = _open_share(shares), _open_share(shares / LONE_SHUT_SHARE)
    kept += kept[:, ::-1] * (kept_alone - kept)
    lasting = grey_opening(
        np.where(tells, 1 - kept, 0), size=(max(1, ceil(MIN_BLINK_SECONDS * fps)), 1), mode="nearest"
    )
    closed = np.repeat(lasting, len(LID_EDGE_VERTEX_PAIRS) // 2, axis=1)[..., None]
    way = closed * (meshes[:, lower] - meshes[:, upper])
    meshes[:, [skin for skin, _ in LID_SKIN_VERTEX_PAIRS]] += 0.5 * way
    meshes[:, upper] += way


def _open_share(shares: NDArray[np.floating]) -> NDArray[np.floating]:
    """(N, 2) how far each eye is open whose contrast is `shares` (N, 2, 2) of the neutral frame's."""
    way = (shares - SHUT_CONTRAST_SHARES) / (OPEN_CONTRAST_SHARES - SHUT_CONTRAST_SHARES)
    return np.asarray(np.clip(way, 0, 1).max(axis=2))


def _middle(outline: NDArray[np.floating]) -> NDArray[np.floating]:
    """The middle between an eye's corners."""
    return (outline[0] + outline[INNER_CORNER_INDEX]) / 2


def _contrast(grey: NDArray[np.uint8], outline: NDArray[np.floating]) -> tuple[float, float]:
    """`eye_contrast` of the eye with this outline (16, 2); nothing where it is out of sight."""
    edge = np.array(grey.shape[::-1])
    low, high = (
        np.clip(at.astype(int), 0, edge)
        for at in (outline.min(axis=0) - 2 * SKIN_RING_PIXELS, outline.max(axis=0) + 2 * SKIN_RING_PIXELS)
    )
    near = grey[low[1] : high[1], low[0] : high[0]]
    inside = np.zeros(near.shape, np.uint8)
    if inside.size:
        cv2.fillPoly(inside, [np.round(outline - low).astype(np.int32)], 1)
    core = cv2.erode(inside, np.ones((3, 3), np.uint8)) > 0 if inside.any() else inside > 0
    if not core.any():
        return 0.0, 0.0
    quiet = cv2.GaussianBlur(near.astype(np.float32), (0, 0), BLUR_PIXELS)
    around = cv2.dilate(inside, np.ones((2 * SKIN_RING_PIXELS + 1, 2 * SKIN_RING_PIXELS + 1), np.uint8)) > inside
    skin = max(float(np.median(quiet[around])), 1.0)
    across = cv2.Sobel(quiet, cv2.CV_32F, 1, 0, scale=1 / 8)
    return 1 - float(np.percentile(quiet[core], IRIS_PERCENTILE)) / skin, float(np.abs(across[core]).mean()) / skin
