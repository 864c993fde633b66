"""Frames are chosen of films that show something, and others are refused with a word."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from made_room import pattern
from numpy.typing import NDArray

from engine.avatar.capture.chosen_frames import blur, choose_frames
from engine.errors import InputError


def film(path: Path, frames: list[NDArray[np.uint8]]) -> Path:
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(30))
        stream.height, stream.width = frames[0].shape[:2]
        stream.pix_fmt, stream.options = "yuv420p", {"crf": "10"}
        for frame in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame, "rgb24")))
        container.mux(stream.encode(None))
    return path


@pytest.fixture(scope="module")
def frames() -> list[NDArray[np.uint8]]:
    """A camera that passes a wall."""
    wall = pattern(3, 120, 320).astype(np.uint8)
    return [np.ascontiguousarray(wall[:, 3 * k : 3 * k + 160]) for k in range(40)]


def test_so_many_frames_in_their_order_and_not_too_large(frames: list, tmp_path: Path) -> None:
    path = film(tmp_path / "clip.mp4", frames)
    chosen = choose_frames(path, 8)
    assert len(chosen) == 8 and all(one.rgb.shape == (120, 160, 3) for one in chosen)
    assert np.diff([one.index for one in chosen]) == pytest.approx(5, abs=4)  # each within two frames of its place
    assert [one.rgb.shape for one in choose_frames(path, 2, longest_side=80)] == [(60, 80, 3)] * 2


def test_a_dark_film_is_refused(frames: list, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        choose_frames(film(tmp_path / "clip.mp4", [frame // 8 for frame in frames]), 5)
    assert error.value.code == "too_dark"


def test_a_blurred_film_is_refused(frames: list, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        choose_frames(film(tmp_path / "clip.mp4", [cv2.GaussianBlur(frame, (0, 0), 4) for frame in frames]), 5)
    assert error.value.code == "too_blurred"


def test_blur_grows_with_the_radius(frames: list) -> None:
    grey = cv2.cvtColor(frames[0], cv2.COLOR_RGB2GRAY)
    values = [blur(grey), *(blur(cv2.GaussianBlur(grey, (0, 0), sigma)) for sigma in (1, 2, 4))]
    assert values == sorted(values)
    assert values[0] < 0.35 and values[-1] > 0.7
    assert blur(np.full((50, 60), 80, np.uint8)) == 1
