"""Clips that last ten minutes or are 8K large are refused by what their headers say; 4K at 60 frames a second is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_clip import write_frames

from engine.avatar.capture.chosen_frames import choose_frames
from engine.errors import InputError
from engine.media.limits import Limits


def code(path: Path) -> str:
    with pytest.raises(InputError) as refused:
        choose_frames(path, 12, "body", Limits())
    return refused.value.code


def test_ten_minutes_and_8k_are_refused(tmp_path: Path) -> None:
    small = [np.full((48, 64, 3), 120, np.uint8)] * 61
    assert code(write_frames(tmp_path / "long.mp4", small, fps=0.1)) == "video_too_long"
    vast = [np.zeros((4320, 7680, 3), np.uint8)] * 2
    assert code(write_frames(tmp_path / "vast.mp4", vast, fps=30, crf=40)) == "video_too_large"


def test_4k_at_60_frames_a_second_is_let_in(tmp_path: Path) -> None:
    """It is three frames long, and that is what it is refused for."""
    sharp = [np.zeros((2160, 3840, 3), np.uint8)] * 3
    assert code(write_frames(tmp_path / "sharp.mp4", sharp, fps=60, crf=40)) == "clip_too_short"
