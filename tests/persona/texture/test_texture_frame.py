"""Photographs laid on one frame: what is at a pixel is found where the mesh says."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.persona.texture.texture_frame import TextureFrame, sampled, texture_frame, with_rim

SIZE = (244, 194)


@pytest.fixture(scope="module")
def frame() -> TextureFrame:
    return texture_frame(canonical_face(), SIZE)


def turned(degrees: float) -> np.ndarray:
    angle = np.radians(degrees)
    return np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])


def test_face_and_rim_fill_the_frame_and_leave_no_hole(frame: TextureFrame) -> None:
    assert frame.size == SIZE
    rows, columns = np.nonzero(frame.covered)
    assert min(rows.min(), SIZE[0] - 1 - rows.max(), columns.min(), SIZE[1] - 1 - columns.max()) <= 3
    for area in (frame.covered, frame.face):
        outside = cv2.connectedComponents((~area).astype(np.uint8), connectivity=4)[0]
        assert outside - 1 <= 4, "nothing but the corners"
    assert (frame.face & ~frame.covered).sum() == 0 and frame.face.mean() < frame.covered.mean()


def test_a_pixel_of_the_frame_is_itself_in_the_frames_own_picture(frame: TextureFrame) -> None:
    ys, xs = np.mgrid[: SIZE[0], : SIZE[1]]
    found = frame.lookup(frame.places[:478])
    assert np.abs(found - np.stack([xs, ys], -1))[frame.covered].max() < 0.05


def test_a_photograph_turned_in_its_plane_and_larger_comes_back(frame: TextureFrame) -> None:
    random = np.random.default_rng(0)
    small = random.integers(40, 220, (12, 10, 3)).astype(np.uint8)
    picture = cv2.resize(small, SIZE[::-1], interpolation=cv2.INTER_CUBIC)
    matrix = cv2.getRotationMatrix2D((0, 0), 25, 3.0)
    matrix[:, 2] = (20, 420)
    photo = cv2.warpAffine(picture, matrix, (1100, 1100), flags=cv2.INTER_CUBIC)
    mesh = frame.places[:478, :2] @ matrix[:, :2].T + matrix[:, 2]
    found = sampled(photo, frame.lookup(mesh))
    inside = cv2.erode(frame.covered.astype(np.uint8), np.ones((9, 9))) > 0
    assert np.abs(found - picture)[inside].mean() < 1.5, "grey levels"


def test_what_is_smaller_than_the_frames_pixels_is_averaged(frame: TextureFrame) -> None:
    fine = (np.indices((2000, 2000)).sum(0) % 2 * 255).astype(np.uint8)
    mesh = frame.places[:478, :2] * 8
    found = sampled(np.repeat(fine[..., None], 3, 2), frame.lookup(mesh))
    assert np.abs(found[frame.face] - 127.5).max() < 5


def test_a_head_that_is_turned_shows_one_side_less(frame: TextureFrame) -> None:
    front = frame.facing(np.eye(3))
    assert front[frame.face].mean() > 0.8
    half = SIZE[1] // 2
    for degrees, hidden, seen in ((35, np.s_[:, :half], np.s_[:, half:]), (-35, np.s_[:, half:], np.s_[:, :half])):
        side = frame.facing(turned(degrees))
        assert side[hidden].sum() < 0.75 * front[hidden].sum()
        assert side[hidden].sum() < side[seen].sum()


def test_the_rim_is_the_oval_drawn_larger() -> None:
    whole = with_rim(canonical_face())
    assert whole.shape == (514, 3)
    assert np.ptp(whole[478:, 0]) == pytest.approx(1.22 * np.ptp(whole[:478, 0]), rel=1e-2)
