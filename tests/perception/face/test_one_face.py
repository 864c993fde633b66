"""One of several faces, followed."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.media.image import read_image
from engine.perception.face.one_face import OneFace

SHIFTS = (0, 4, 8, 12, 16)
"""Pixels to the right in each frame."""


@pytest.fixture(scope="module")
def pair(media) -> list[NDArray[np.uint8]]:
    """Two people side by side, the one on the right half as large, who both move to the right."""
    left = cv2.resize(read_image(media("portraits/pair1_neutral.png")).rgb, (320, 320), interpolation=cv2.INTER_AREA)
    right = cv2.resize(read_image(media("portraits/photo_biden.jpg")).rgb, (200, 260), interpolation=cv2.INTER_AREA)
    scene = np.full((340, 620, 3), 120, np.uint8)
    scene[10:330, 10:330] = left
    scene[40:300, 380:580] = right
    moved = [np.float32([[1, 0, shift], [0, 1, 0]]) for shift in SHIFTS]
    return [np.asarray(cv2.warpAffine(scene, m, scene.shape[1::-1], borderValue=(120,) * 3), np.uint8) for m in moved]


def middles(follow: OneFace, frames: list[NDArray[np.uint8]]) -> NDArray[np.float32]:
    """(N,) the middle of the face in each frame, from the left."""
    return np.array([mesh[:, 0].mean() if (mesh := follow(frame)) is not None else np.nan for frame in frames])


@pytest.mark.parametrize(("index", "left", "right"), [(0, 10, 330), (1, 380, 580)])
def test_the_chosen_one_is_followed(pair, index: int, left: int, right: int) -> None:
    with OneFace(index) as follow:
        seen = middles(follow, pair)
        assert ((seen > np.add(SHIFTS, left)) & (seen < np.add(SHIFTS, right))).all()
        np.testing.assert_allclose(seen - seen[0], SHIFTS, atol=1.5)
        assert len(follow.boxes) == 2
        assert follow.boxes[0, 2:].prod() > follow.boxes[1, 2:].prod()


def test_where_it_is_gone_nobody_else_is_taken_for_it(pair) -> None:
    """The larger one is covered for two frames: it is not seen there, and seen again afterwards."""
    hidden = [frame.copy() for frame in pair]
    for frame in hidden[1:3]:
        frame[:, :360] = 120
    with OneFace() as follow:
        assert np.isfinite(middles(follow, hidden)).tolist() == [True, False, False, True, True]


def test_more_than_there_are_cannot_be_chosen(pair) -> None:
    with OneFace(2) as follow:
        with pytest.raises(IndexError):
            follow(pair[0])
        assert len(follow.boxes) == 2


def test_before_anybody_is_seen_nothing_is_chosen(pair) -> None:
    with OneFace() as follow:
        assert follow(np.full_like(pair[0], 120)) is None
        assert follow(pair[0]) is not None and len(follow.boxes) == 2


def test_one_who_is_small_beside_a_large_face_is_followed(media) -> None:
    """The tracker does not see that one in the whole frame; it goes as far as its own width, and back."""
    large = cv2.resize(read_image(media("portraits/photo_man_suit.png")).rgb, (1200, 1200))
    small = cv2.resize(
        read_image(media("portraits/photo_woman_white.png")).rgb, (400, 400), interpolation=cv2.INTER_AREA
    )
    shifts = [0, 20, 40, 60, 80, 100, 120, 100, 80]
    frames = []
    for shift in shifts:
        frame = np.full((1200, 1760, 3), 128, np.uint8)
        frame[:, :1200] = large
        frame[300:700, 1210 + shift : 1610 + shift] = small
        frames.append(frame)
    with OneFace(1) as follow:
        seen = middles(follow, frames)
        np.testing.assert_allclose(seen - seen[0], shifts, atol=2)
        assert 1330 < seen[0] < 1480 and len(follow.boxes) == 2
