"""Small real portraits and drivers, for the tests of what finds, follows and animates faces."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.media.image import read_image, write_image
from engine.media.video import read_video

Media = Callable[[str], Path]


@pytest.fixture(scope="session")
def small(media: Media, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, int], Path]:
    """`small("photo_biden.jpg", 300)` is that portrait with a longest side of 300 pixels."""
    folder = tmp_path_factory.mktemp("small")

    def make(name: str, longest: int) -> Path:
        path = folder / f"{longest}-{Path(name).stem}.png"
        if not path.exists():
            rgb = read_image(media(f"portraits/{name}")).rgb
            scale = longest / max(rgb.shape[:2])
            size = [2 * round(s * scale / 2) for s in rgb.shape[1::-1]]
            write_image(path, np.asarray(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)))
        return path

    return make


@pytest.fixture(scope="session")
def clip(media: Media) -> Callable[[str, float, float], list[NDArray[np.uint8]]]:
    """`clip("man_talk_tps.mp4", 1.0, 2.0)`: the frames of that part of a driving clip."""

    def make(name: str, start: float, end: float) -> list[NDArray[np.uint8]]:
        return [f.rgb.copy() for f in read_video(media(f"driving/{name}"), trim=(start, end))]

    return make


@pytest.fixture(scope="session")
def mouth_opens(media: Media) -> Path:
    return media("driving/man_mouth_open_d18.mp4")


@pytest.fixture(scope="session")
def woman_white(small: Callable[[str, int], Path]) -> Path:
    return small("photo_woman_white.png", 300)
