"""The picture without those who walk out of it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.film.cast_shadow import CastShadow, find_cast_shadow
from engine.imaging.filling.background_plate import background_plate
from engine.media.image import is_cut_out, over_white

HOLE_MARGIN_SHARE = 0.012
"""How far the hole behind the person reaches beyond the mask, as a share of the picture's longer side: hair and the
shadow at the feet are not in the mask."""
MIN_FILLED_ALPHA = 0.02
"""Alpha below which nothing is seen."""


@dataclass(frozen=True)
class Background:
    """The picture without the person: `rgb` (H, W, 3), over white where it is cut out; the shadow that they cast in it has
    gone, too. `empty`: of a cut-out picture, nothing is left."""

    rgb: NDArray[np.uint8]
    shadow: CastShadow
    empty: bool = False


def fill_background(figure: Figure, silhouettes: tuple[Silhouette, ...]) -> Background:
    """Fill the hole that those leave who walk out."""
    radius = max(3, round(HOLE_MARGIN_SHARE * max(figure.rgb.shape[:2])))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    alpha = np.max([one.alpha for one in silhouettes], axis=0)
    seen = over_white(figure.rgb, figure.alpha)
    shadow = find_cast_shadow(seen, alpha)
    gone = np.maximum(alpha > 0.02, shadow.mask > 0.1).astype(np.float32)
    hole = np.asarray(cv2.dilate(gone, disk), np.float32)
    plate = background_plate(seen, hole, reach=float(np.sqrt(hole.sum())))
    left = np.zeros_like(alpha) if figure.alpha is None else figure.alpha * (1 - hole)
    return Background(plate, shadow, is_cut_out(figure.alpha) and bool(left.max() < MIN_FILLED_ALPHA))
