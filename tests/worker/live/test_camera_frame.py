"""Frames of a camera: JPEG and WebP of a camera's size; nothing else is decoded."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from worker.live.camera_frame import UnreadableFrame, read_frame

MAX_PIXELS = 640 * 480


def encoded(format: str, size: tuple[int, int] = (320, 240)) -> bytes:
    file = BytesIO()
    Image.new("RGB", size, (200, 40, 90)).save(file, format, quality=95)
    return file.getvalue()


@pytest.mark.parametrize("format", ["JPEG", "WEBP"])
def test_a_frame_comes_in_its_colours(format: str) -> None:
    rgb = read_frame(encoded(format), MAX_PIXELS)
    assert rgb.shape == (240, 320, 3)
    np.testing.assert_allclose(rgb.reshape(-1, 3).mean(axis=0), (200, 40, 90), atol=4)


@pytest.mark.parametrize(
    "data",
    [
        b"\xff\xd8\xff\xe0 no picture",
        encoded("JPEG")[:200],
        encoded("PNG"),
        encoded("JPEG", (1000, 1000)),
        encoded("WEBP", (8, 8)),
        b"",
    ],
    ids=["garbage", "cut off", "png", "too large", "too small", "nothing"],
)
def test_what_is_no_frame_is_not_read(data: bytes) -> None:
    with pytest.raises(UnreadableFrame):
        read_frame(data, MAX_PIXELS)
