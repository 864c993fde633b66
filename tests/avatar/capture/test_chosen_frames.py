"""Chosen frames: sharp ones with equal movement between them, as they were filmed; clips of no use are refused."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from made_clip import write_frames
from numpy.typing import NDArray

from engine.avatar.capture.chosen_frames import choose_frames
from engine.errors import InputError
from engine.media.limits import Limits

BLOCKS = np.random.default_rng(8).integers(0, 256, (12, 75, 3), np.uint8)
WIDE = cv2.GaussianBlur(BLOCKS.repeat(8, axis=0).repeat(8, axis=1), (0, 0), 1.0)


def pan(shifts: list[int]) -> list[NDArray[np.uint8]]:
    """A camera that looks at a wide picture, each frame so many pixels further right."""
    return [np.ascontiguousarray(WIDE[:, shift : shift + 128]) for shift in np.cumsum(shifts)]


def refusal(path: Path) -> InputError:
    with pytest.raises(InputError) as refused:
        choose_frames(path, 12, "body", Limits())
    return refused.value


def test_frames_lie_where_the_camera_moves_and_come_back_as_they_were_filmed(tmp_path: Path) -> None:
    shifts = [0] + [1] * 40 + [3] * 40
    film = pan(shifts)
    chosen = choose_frames(write_frames(tmp_path / "body.mp4", film), 20, "body", Limits())
    assert len(chosen) == 20 and chosen.size == (96, 128)
    travelled = np.cumsum(shifts)[chosen.indices]
    steps = np.diff(travelled)
    assert np.abs(steps - steps.mean()).max() < 0.7 * steps.mean()  # each up to two frames from where it was aimed
    for k in (0, 10, 19):
        error = chosen.picture(k).mean(axis=2) - film[chosen.indices[k]].mean(axis=2)
        assert np.sqrt((error**2).mean()) < 9
    assert chosen.seconds == pytest.approx(chosen.indices / 25, abs=0.001)
    assert chosen.picture(3, longest=64).shape == (48, 64, 3)

    left_out = chosen.indices[[0, 4, 19]].tolist()
    kept = chosen.without([*left_out, 9999], "body")
    assert kept.indices.tolist() == [index for index in chosen.indices if index not in left_out]
    assert np.array_equal(kept.picture(0), chosen.picture(1)) and np.array_equal(kept.picture(16), chosen.picture(18))
    assert kept.seconds[16] == chosen.seconds[18] and len(kept) == 17
    with pytest.raises(InputError, match="only 8 frames are left") as refused:
        chosen.without(chosen.indices[:12].tolist(), "body")
    assert refused.value.correctable == ("body_frames_left_out",)


def test_a_dark_a_blurred_and_a_short_clip_are_refused_by_the_name_of_their_input(tmp_path: Path) -> None:
    film = pan([4] * 30)
    dark = write_frames(tmp_path / "dark.mp4", [(frame // 16).astype(np.uint8) for frame in film])
    blurred = write_frames(tmp_path / "blurred.mp4", [cv2.GaussianBlur(frame, (0, 0), 6) for frame in film])
    short = write_frames(tmp_path / "short.mp4", film[:6])
    for path, code in ((dark, "too_dark"), (blurred, "too_blurred"), (short, "clip_too_short")):
        refused = refusal(path)
        assert refused.code == code
        assert "body" in refused.detail
