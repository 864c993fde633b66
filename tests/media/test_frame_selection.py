"""Frames with equal motion between them, and each the sharpest around: on clips whose motion and sharpness are known."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from footage import quadrants, write_clip
from numpy.typing import NDArray

from engine.media.clip import Clip
from engine.media.frame_selection import (
    NEIGHBOURHOOD_FRAMES,
    equal_movement,
    measure_movement,
    neighbourhoods,
    read_selected,
    select_frames,
    sharpness,
)
from engine.media.video import read_video

SIZE = (160, 90)


def panned(places: NDArray[np.floating], seed: int = 3) -> list[NDArray[np.uint8]]:
    """Frames of SIZE over a wall of soft spots, so many pixels from its left end each."""
    noise = np.random.default_rng(seed).random((SIZE[1], int(places.max()) + SIZE[0] + 2)).astype(np.float32)
    wall = cv2.GaussianBlur(noise, (0, 0), 3)
    wall = np.uint8(255 * (wall - wall.min()) / np.ptp(wall))
    moves = [np.array([[1, 0, -x], [0, 1, 0]], np.float64) for x in places]
    return [np.repeat(cv2.warpAffine(wall, move, SIZE)[..., None], 3, axis=2) for move in moves]


@pytest.fixture(scope="module")
def uneven(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, NDArray[np.float64]]:
    """A camera that goes slowly, hurries, and goes slowly again, and where it is in each frame, pixels; four frames of
    five are out of focus."""
    speed = np.repeat([0.8, 3.0, 0.8], [50, 40, 50])
    places = np.concatenate([[0], np.cumsum(speed)])
    frames = panned(places)
    frames = [one if k % 5 == 0 else cv2.GaussianBlur(one, (0, 0), 2.5) for k, one in enumerate(frames)]
    return write_clip(tmp_path_factory.mktemp("uneven") / "clip.mp4", frames, 30), places


def test_movement_is_the_flow_s_mean_length(uneven: tuple[Path, NDArray[np.float64]]) -> None:
    path, places = uneven
    for step in (1, 2):
        movement = measure_movement(path, step=step) * SIZE[0]
        assert len(movement) == len(places) - 1
        assert movement[5:45].mean() == pytest.approx(0.8, rel=0.15)
        assert movement[55:85].mean() == pytest.approx(3.0, rel=0.15)


def test_equal_movement_lies_between_the_frames() -> None:
    """By hand: one pixel a frame, then three: of 400 in all, forty pixels between ten frames."""
    movement = np.repeat([1.0, 3.0], 100)
    travelled = np.concatenate([[0], np.cumsum(movement)])
    chosen = equal_movement(movement, 10)
    assert chosen[0] == 0 and len(chosen) == 10
    assert travelled[chosen] == pytest.approx(40 * np.arange(10), abs=3.01)
    assert (travelled[chosen[1:]] >= 40 * np.arange(1, 10) - 0.5).all(), "not before the threshold is reached"


@pytest.mark.parametrize("movement", [np.ones(99), np.zeros(99), np.r_[np.zeros(50), 9.0, np.zeros(48)]])
def test_as_many_frames_as_asked_for_and_none_twice(movement: NDArray[np.float64]) -> None:
    """Even of a camera that stands still, or that leaps once."""
    for count in (1, 7, 75, 100, 200):
        chosen = equal_movement(movement, count)
        assert len(chosen) == min(count, 100)
        assert (np.diff(chosen) > 0).all() and chosen[0] >= 0 and chosen[-1] < 100


def test_a_camera_that_stands_still_gives_frames_equally_far_apart_in_time() -> None:
    assert equal_movement(np.zeros(99), 4).tolist() == [0, 25, 50, 75]


def test_neighbourhoods_are_of_five_frames_and_share_none() -> None:
    assert neighbourhoods([0, 10, 13, 19], 20) == [range(0, 3), range(8, 12), range(12, 16), range(17, 20)]
    every = neighbourhoods(range(20), 20)
    assert every == [range(k, k + 1) for k in range(20)]


def test_sharpness_is_the_variance_of_the_laplacian() -> None:
    """A bright pixel of 10: the Laplacian is -40 there, 10 at its four neighbours, else 0, of mean 0."""
    picture = np.zeros((10, 20), np.uint8)
    picture[5, 7] = 10
    assert sharpness(picture) == pytest.approx((40**2 + 4 * 10**2) / 200)
    assert sharpness(np.full((10, 20), 77, np.uint8)) == 0


def test_frames_lie_equally_far_apart_and_are_sharp(uneven: tuple[Path, NDArray[np.float64]]) -> None:
    path, places = uneven
    chosen = list(select_frames(path, 12))
    at = [one.index for one in chosen]
    assert all(index % 5 == 0 for index in at), "every fifth is in focus"
    # the next frame in focus is two frames away at most, six pixels where the camera hurries; the threshold comes a frame late
    assert places[at] == pytest.approx(places[-1] / 12 * np.arange(12), abs=9.1)
    frames = [frame.rgb.copy() for frame in read_video(path)]
    for one in chosen:
        assert np.array_equal(one.rgb, frames[one.index])
        assert one.time == pytest.approx(one.index / 30)


def test_flow_over_two_frames_at_once_selects_the_same(tmp_path: Path) -> None:
    """At least 95% of the frames within one frame of the full computation's."""
    speed = 1.2 + np.sin(np.arange(159) / 17) + 0.3 * np.random.default_rng(5).standard_normal(159)
    path = write_clip(tmp_path / "clip.mp4", panned(np.concatenate([[0], np.cumsum(np.abs(speed))])), 30)
    full, quick = (equal_movement(measure_movement(path, step=step), 27) for step in (1, 2))
    assert (np.abs(full - quick) <= 1).mean() >= 0.95


def test_a_turned_clip_gives_upright_frames(tmp_path: Path) -> None:
    path = write_clip(
        tmp_path / "clip.mp4", [quadrants(160, 96)] * 6, dress=lambda stream: stream.set_display_rotation(90)
    )
    upright = next(iter(read_video(path))).rgb
    chosen = list(select_frames(path, 2))
    assert [one.rgb.shape for one in chosen] == [(160, 96, 3)] * 2
    assert np.array_equal(chosen[0].rgb, upright)


def test_no_more_of_the_video_is_read_than_a_frame_s_neighbourhood(
    uneven: tuple[Path, NDArray[np.float64]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each selected frame is given as soon as its last neighbour was seen: nothing is collected."""
    path, _ = uneven
    read = 0
    own = Clip.frames

    def counted(*given) -> Iterator:
        nonlocal read
        for one in own(*given):
            read += 1
            yield one

    monkeypatch.setattr(Clip, "frames", counted)
    chosen = [20, 60, 100]
    seen = [(one.index, read) for one in read_selected(path, chosen)]
    assert [count for _, count in seen] == [frame + NEIGHBOURHOOD_FRAMES // 2 + 1 for frame in chosen]
    assert all(abs(index - frame) <= NEIGHBOURHOOD_FRAMES // 2 for (index, _), frame in zip(seen, chosen, strict=True))
