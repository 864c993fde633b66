"""The tone of somebody's skin, and whether colours have it: bare hands have the face's, but for shading; gloves have not.

A hand is small in pictures, and where the fitted one is beside it they show a sleeve or the room there. So a colour counts as the
hand's only where it is like the skin of the same person's face.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.histogram_matching import from_lab, to_lab

SKIN_HUE_RANGE_DEGREES = (15.0, 85.0)
"""Degrees in CIELAB's a and b between which skin lies, of whatever tone; in warm and in cold light."""
MIN_HUE_CHROMA = 5.0
"""In CIELAB, below which a colour has no hue."""
MAX_SKIN_COLOUR_DISTANCE = 14.0
"""In CIELAB, lightness by half (shading), within which a colour is like the person's skin."""
MIN_HAND_SHARE = 0.2
"""Of what is seen of a hand that has to be like the face's skin for the hand's own tone to be believed."""
MIN_GLOVE_SHARE, MAX_GLOVE_COLOUR_SPREAD, MIN_GLOVE_COLOUR_DISTANCE = 0.3, 8.0, 12.0
"""When a glove is seen: on so much of a hand at least, in colours whose median distance from their middle is below so
much, and so far from those of the sleeve. What is like the sleeve is a sleeve, seen beside the hand."""


def hand_tone(
    face: NDArray[np.uint8], hand: NDArray[np.uint8], shown: NDArray[np.bool_], sleeve: NDArray[np.uint8]
) -> NDArray[np.float32] | None:
    """The middle colour (3,) CIELAB of a hand; None where it keeps what is seen, a glove.

    `face` (M, 3) is skin of the face, if any. `hand` (N, 3) is what a texture or picture has at the hand, of which
    `shown` (N,) is seen. `sleeve` (K, 3) is what it has just before the wrist.
    """
    told = to_lab(hand[shown])
    if not len(face):
        return None if _glove(told, len(hand), None) else np.median(told if len(told) else to_lab(hand), 0)
    tone = np.median(to_lab(face), 0)
    own = told[like_skin(told, tone)]
    if len(own) > MIN_HAND_SHARE * len(told):
        return np.asarray((tone + np.median(own, 0)) / 2, np.float32)
    return None if _glove(told, len(hand), to_lab(sleeve)) else np.asarray(tone, np.float32)


def like_skin(lab: NDArray[np.floating], tone: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(N,) which colours (N, 3) are, but for shading, of a skin's tone (3,); both CIELAB."""
    return skin_likeness(lab, tone) == 1


def skin_likeness(lab: NDArray[np.floating], tone: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) in [0, 1]: the same, not as yes or no; nothing from twice the distance on."""
    return np.clip(2 - np.linalg.norm((lab - tone) * [0.5, 1, 1], axis=1) / MAX_SKIN_COLOUR_DISTANCE, 0, 1).astype(
        np.float64
    )


def toned(colours: NDArray[np.floating], tone: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours (N, 3) sRGB, 0 to 255, moved in CIELAB until their middle is `tone` (3,): nails, knuckles and the palm stay as far
    from one another as they are."""
    lab = to_lab(colours)
    return from_lab(lab + (tone - np.median(lab, 0)))


def of_skin_s_hue(colours: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """(N,) which colours (N, 3) sRGB, 0 to 255, have a hue that skin has."""
    lab = to_lab(colours)
    hue = np.degrees(np.arctan2(lab[:, 2], lab[:, 1]))
    return np.asarray(
        (hue > SKIN_HUE_RANGE_DEGREES[0])
        & (hue < SKIN_HUE_RANGE_DEGREES[1])
        & (np.hypot(lab[:, 1], lab[:, 2]) > MIN_HUE_CHROMA)
    )


def _glove(told: NDArray[np.float32], texels: int, sleeve: NDArray[np.float32] | None) -> bool:
    if len(told) < max(MIN_GLOVE_SHARE * texels, 1):
        return False
    middle = np.median(told, 0)
    if np.median(np.linalg.norm(told - middle, axis=1)) > MAX_GLOVE_COLOUR_SPREAD:
        return False
    return (
        sleeve is None
        or not len(sleeve)
        or float(np.linalg.norm(middle - np.median(sleeve, 0))) > MIN_GLOVE_COLOUR_DISTANCE
    )
