"""What is behind the puppet: a plain colour, or a picture of one's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized
from engine.media.image import read_image
from engine.media.limits import Limits


def backdrop(
    colour: tuple[int, int, int], size: tuple[int, int], picture: Path | None, limits: Limits
) -> NDArray[np.uint8]:
    """(h, w, 3) what is behind a puppet of `size` (width, height). The `picture` is as large as covers all of it, about
    its own middle. The `colour` is seen where that lets it through, or where there is none.

    Raises
    ------
    InputError : what reading a picture raises.
    """
    width, height = size
    plain = np.empty((height, width, 3), np.uint8)
    plain[:] = colour
    if picture is None:
        return plain
    given = read_image(picture, limits)
    factor = max(width / given.rgb.shape[1], height / given.rgb.shape[0])
    whole = (max(round(given.rgb.shape[1] * factor), width), max(round(given.rgb.shape[0] * factor), height))
    top, left = (whole[1] - height) // 2, (whole[0] - width) // 2
    part = np.s_[top : top + height, left : left + width]
    covering = resized(given.rgb, whole)[part]
    if given.alpha is None:
        return np.ascontiguousarray(covering)
    alpha = resized(np.asarray(given.alpha, np.float32), whole)[part][..., None]
    return np.rint(covering * alpha + plain * (1 - alpha)).clip(0, 255).astype(np.uint8)
