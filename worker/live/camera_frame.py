"""A frame of a camera, as a stranger sent it: looked at before it is decoded."""

from __future__ import annotations

from io import BytesIO

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

FRAME_FORMATS = ("JPEG", "WEBP")
MIN_CAMERA_SIDE_PIXELS = 64
"""Pixels: in less no face is followed."""


class UnreadableFrame(Exception):
    """It is no picture of the formats, has no face's size, or more pixels than one may have."""


def read_frame(data: bytes, most_pixels: int) -> NDArray[np.uint8]:
    """The frame (H, W, 3), RGB. Raises `UnreadableFrame`."""
    try:
        with Image.open(BytesIO(data), formats=FRAME_FORMATS) as picture:
            width, height = picture.size
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise UnreadableFrame("no picture") from error
    if width * height > most_pixels or min(width, height) < MIN_CAMERA_SIDE_PIXELS:
        raise UnreadableFrame("no such size")
    bgr = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    if bgr is None or bgr.shape[:2] != (height, width):
        raise UnreadableFrame("no whole picture")
    return np.asarray(cv2.cvtColor(bgr, cv2.COLOR_BGR2RGB), np.uint8)
