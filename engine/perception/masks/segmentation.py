"""Where two networks believe people to be in a picture, before its own edges and colours are asked.

MediaPipe's selfie segmentation (256 px; straight and mirrored, and again at the part that holds a person) and the mask
that comes with its body pose. Neither sees edges finely, and they miss different things.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized, size_within
from engine.perception.pose.body import FAINT_CONFIDENCE
from engine.perception.solutions import network

Mask = NDArray[np.float32]

MATTE_SIZE_PIXELS = 800
"""Longest side, in pixels, at which people are looked for and their matte is solved; larger pictures get it by guided
upsampling."""

SELFIE_SHARE = 2 / 3
"""Share of the selfie network in the belief in portraits (by trial on known alphas); the rest is the body pose's."""
SELFIE_SHARE_OF_WHOLE = 1 / 2
"""Share of the selfie network in pictures that show somebody whole, whom the body pose's network knows best."""


def people_confidence(rgb: NDArray[np.uint8], whole: bool = False) -> Mask:
    """What the networks believe to be people in a picture (H, W, 3), in [0, 1] at the size at which a matte is solved;
    `whole` as in `person_mask`."""
    small = resized(np.ascontiguousarray(rgb), size_within(rgb.shape, MATTE_SIZE_PIXELS))
    posed = _pose_mask(small)
    if posed is None and whole:  # who hardly stands out was found by such a look, at this size
        posed = _pose_mask(rgb, FAINT_CONFIDENCE)
        posed = None if posed is None else resized(posed, (small.shape[1], small.shape[0]))
    return _together(small, posed, SELFIE_SHARE_OF_WHOLE if whole else SELFIE_SHARE)


def person_confidence(rgb: NDArray[np.uint8]) -> Mask:
    """What the networks believe to be a person in a portrait, (H, W) in [0, 1]."""
    return _together(rgb, _pose_mask(rgb), SELFIE_SHARE)


def _together(rgb: NDArray[np.uint8], posed: Mask | None, share: float) -> Mask:
    """The belief of both networks, of which `share` is the selfie's."""
    selfie = selfie_mask(rgb, posed)
    return selfie if posed is None else (share * selfie + (1 - share) * posed).astype(np.float32)


def selfie_mask(rgb: NDArray[np.uint8], posed: Mask | None = None) -> Mask:
    """What the selfie network believes to be a person, (H, W) in [0, 1]: it looks closer where people, also those that
    `posed` shows, take up a small part of the picture."""
    height, width = rgb.shape[:2]
    with network("selfie_segmentation", "SelfieSegmentation", model_selection=0) as seer:

        def look(part: NDArray[np.uint8]) -> Mask:
            straight = seer.process(np.ascontiguousarray(part)).segmentation_mask
            mirrored = seer.process(np.ascontiguousarray(part[:, ::-1])).segmentation_mask[:, ::-1]
            return np.asarray((straight + mirrored) / 2, np.float32)

        whole = look(rgb)
        ys, xs = np.nonzero((whole if posed is None else np.maximum(whole, posed)) > 0.5)
        if len(ys) < 16:
            return whole
        margin = 0.15 * max(np.ptp(ys), np.ptp(xs)) + 4
        top, bottom = max(0, int(ys.min() - margin)), min(height, int(ys.max() + margin))
        left, right = max(0, int(xs.min() - margin)), min(width, int(xs.max() + margin))
        if (bottom - top) * (right - left) > 0.7 * height * width:
            return whole
        closer = np.zeros_like(whole)
        closer[top:bottom, left:right] = look(rgb[top:bottom, left:right])
        return closer


def _pose_mask(rgb: NDArray[np.uint8], confidence: float = 0.5) -> Mask | None:
    """The body pose's belief; None where it sees no body."""
    settings: dict[str, Any] = {
        "model_complexity": 1,
        "enable_segmentation": True,
        "min_detection_confidence": confidence,
    }
    with network("pose", "Pose", static_image_mode=True, **settings) as seer:
        mask = seer.process(np.ascontiguousarray(rgb)).segmentation_mask
    return None if mask is None else np.asarray(mask, np.float32)
