"""What is white in a picture's light and palette: the tint of teeth and of the whites of eyes.

Both are found on few pixels, among lashes, reflections and the noise of a JPEG. So what is measured decides one number only:
how much of the skin's own hue there is in what is white, from hardly any in a photograph to most of it under a brown
varnish. Violet, green or blue whites cannot come of it.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.skin_colour import skin_colour
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS

USUAL_WHITE_HUE_SHARE, WHITE_HUE_SHARE_RANGE = 0.25, (0.15, 0.45)
"""Of the skin's hue in what is white, where no eye shows it, and between which it is."""
WHITE_PERCENTILE = 60
"""Of the light beside an iris, from which on it is the white's: lids shade the rest."""
TEETH_HUE_SHARE = 0.38
"""Of the skin's hue in teeth: 0.2 to 0.6 in nineteen photographs of fourteen people, as little of it yellow as in their skin. Neither the whites of eyes nor the
lightest of the picture tell which of these (correlation 0.1)."""
IRIS_MARGIN_RADII = 1.2
"""Radii of the iris within which nothing is white."""
MIN_WHITE_PIXELS = 12


def white_tint(
    rgb: NDArray[np.uint8], mesh: NDArray[np.floating], shares: tuple[float, float] = WHITE_HUE_SHARE_RANGE
) -> NDArray[np.float64]:
    """(3,) the colour of what is white, at luminance 1, in a picture (H, W, 3) of a face at `mesh` (478, 2 or 3), with the skin's hue
    between two `shares`."""
    whites = np.concatenate([eye_whites(rgb, mesh, side) for side in range(2)])
    return _tint(rgb, mesh, float(np.clip(hue_share(rgb, mesh, whites), *shares)))


def teeth_tint(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) the colour of teeth, at luminance 1, in a picture (H, W, 3) of a face at `mesh` (478, 2 or 3): between lips and gums they have more of the skin's
    hue than what is white elsewhere."""
    return _tint(rgb, mesh, TEETH_HUE_SHARE)


def hue_share(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], colours: NDArray[np.floating]) -> float:
    """How much of the hue of the skin of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3) there is in the mean of `colours` (P, 3);
    `USUAL_WHITE_HUE_SHARE` where they are too few or the skin has none."""
    hue = _skin_hue(rgb, mesh)
    if len(colours) < MIN_WHITE_PIXELS or float(hue @ hue) <= 1e-4:
        return USUAL_WHITE_HUE_SHARE
    mean = np.maximum(colours.mean(axis=0), 1.0)
    return float(np.log(mean / float(mean @ LUMINANCE_WEIGHTS)) @ hue) / float(hue @ hue)


def _tint(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], share: float) -> NDArray[np.float64]:
    tint = np.exp(share * _skin_hue(rgb, mesh))
    return np.asarray(tint / float(tint @ LUMINANCE_WEIGHTS), np.float64)


def _skin_hue(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) the logarithms of the skin's channels at luminance 1."""
    skin = np.maximum(skin_colour(rgb, mesh), 1.0)
    return np.asarray(np.log(skin / float(skin @ LUMINANCE_WEIGHTS)), np.float64)


def white_luminance(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """The luminance of the whites of that eye of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3) whose are lighter; 0 where too little of either is
    seen."""
    seen = [whites for side in range(2) if len(whites := eye_whites(rgb, mesh, side)) >= MIN_WHITE_PIXELS]
    return max((float((whites @ LUMINANCE_WEIGHTS).mean()) for whites in seen), default=0.0)


def eye_whites(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float64]:
    """(P, 3) the lighter colours within the lids and beside the iris of an eye, 0 the right one, of a face at `mesh` (478, 2 or
    3); few or none where it is small or shut."""
    contour, iris = ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS))[side]
    low = np.maximum(np.floor(mesh[list(contour), :2].min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(mesh[list(contour), :2].max(axis=0)).astype(int) + 2, rgb.shape[1::-1])
    if (high - low).min() < 2:
        return np.zeros((0, 3))
    mask = np.zeros((high - low)[::-1], np.uint8)
    cv2.fillPoly(mask, [np.rint(mesh[list(contour), :2] - low).astype(np.int32)], 1)
    centre = mesh[iris[0], :2]
    radius = float(np.linalg.norm(mesh[list(iris[1:]), :2] - centre, axis=1).mean())
    mask = np.asarray(cv2.erode(mask, np.ones((3, 3), np.uint8)))
    cv2.circle(mask, np.rint(centre - low).astype(int).tolist(), max(round(IRIS_MARGIN_RADII * radius), 1), 0, -1)
    colours = rgb[low[1] : high[1], low[0] : high[0]][mask > 0].astype(np.float64)
    if not len(colours):
        return colours.reshape(0, 3)
    light = colours @ LUMINANCE_WEIGHTS
    return np.asarray(colours[light >= np.percentile(light, WHITE_PERCENTILE)], np.float64)
