"""How much of its upper and lower teeth a driver shows: what lies between its lips, as light as skin and less red, beside either lip."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import mouth_opening
from engine.perception.face_track.track import FaceTrack

MIDDLE_PAIRS = slice(3, 8)
"""Of facing vertices of the inner lips, those in the middle: before the incisors."""
SAMPLES = 32
"""From lip to lip."""
CHEEK_VERTICES = (50, 280)
CHEEK_SIDE_PIXELS = 9
LIGHT_RATIOS = (0.8, 0.95)
"""Light of what lies between the lips, in the cheeks', up to which it is the dark or a tongue, and from which on teeth."""
REDDER_SHARES = (0.0, 0.015)
"""By how much more of its light is red beyond what is green than of the cheeks', up to which it is teeth, and from which on a tongue, gums or lips."""
DARK_RATIOS = (0.4, 0.65)
"""Light of the darkest place between the lips, in the cheeks', up to which the inside is seen, and from which on it is not: in a blurred frame, or where the tracker
has the lower lip for an opening, it tells nothing of teeth."""
LIP_SHARE = 0.35
"""Share of the opening beside a lip in which its teeth begin: what the tracker takes for an opening has some of the lip."""
MEASURED_OPENINGS = (0.15, 0.35)
"""Openings of a mouth, its gap over its width, up to which what the tracker errs by is too much of it to tell teeth, and from which on they are told."""
STEADY_FRAMES = 1.5
"""Over which shares are steadied, as a Gaussian."""


def seen_teeth(track: FaceTrack) -> NDArray[np.float64]:
    """(N, 2) how much of the opening of its mouth the upper and the lower teeth of a driver fill at most in each frame, beside either lip: all of it where its
    inside is not seen."""
    shares = np.array([teeth_shares(track.crop(k), track.in_crop(k)) for k in range(len(track))]).reshape(-1, 2)
    told = smoothstep(np.asarray(mouth_opening(track.meshes)), *MEASURED_OPENINGS)[:, None]
    return np.asarray(gaussian_filter1d(1 - told * (1 - shares), STEADY_FRAMES, axis=0))


def teeth_shares(crop: NDArray[np.uint8], face: NDArray[np.floating]) -> tuple[float, float]:
    """As `seen_teeth`, of one picture (H, W, 3) of a face (478, 2)."""
    top, bottom = (face[list(lip)][MIDDLE_PAIRS] for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    down = ((np.arange(SAMPLES) + 0.5) / SAMPLES)[:, None, None]
    places = ((1 - down) * top + down * bottom).astype(np.float32)
    between = cv2.remap(crop, places[..., 0], places[..., 1], cv2.INTER_LINEAR).reshape(SAMPLES, -1, 3).mean(axis=1)
    size = (CHEEK_SIDE_PIXELS, CHEEK_SIDE_PIXELS)
    cheeks = [cv2.getRectSubPix(crop, size, face[one].astype(float).tolist()) for one in CHEEK_VERTICES]
    skin = np.mean(cheeks, axis=(0, 1, 2))
    light = between @ LUMINANCE_WEIGHTS / max(float(skin @ LUMINANCE_WEIGHTS), 1.0)
    like = smoothstep(light, *LIGHT_RATIOS) * (1 - smoothstep(_redness(between) - _redness(skin), *REDDER_SHARES))
    dark = 1 - float(smoothstep(float(light.min()), *DARK_RATIOS))
    upper, lower = _reach(like), _reach(like[::-1])
    return 1 - dark * (1 - upper), 1 - dark * (1 - lower)


def _reach(like: NDArray[np.float64]) -> float:
    """How far from a lip, as a share of the opening, teeth reach that begin beside it, where samples (S,) from there on are as `like` teeth as they are."""
    beside = like[: int(LIP_SHARE * len(like))]
    first = int(beside.argmax())
    run = np.minimum.accumulate(like[first:])
    return float(beside[first] * (first / len(like)) + run.sum() / len(like))


def _redness(colour: NDArray[np.floating]) -> NDArray[np.float64]:
    """(...,) the share of the light of colours (..., 3) by which they are redder than green."""
    return np.asarray((colour[..., 0] - colour[..., 1]) / np.maximum(colour.sum(axis=-1), 1.0))
