"""Features are found again where the picture was carried to, and only there."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.imaging.feature_matching import guided_matches, match_features, overlaps, verified_matches
from engine.imaging.features import Features, find_features


def wall(seed: int, size: tuple[int, int] = (240, 320)) -> NDArray[np.uint8]:
    """A picture with detail at several scales."""
    random = np.random.default_rng(seed)
    total = np.zeros((*size, 3), np.float32)
    for sigma in (1.5, 4.0, 10.0):
        layer = cv2.GaussianBlur(random.standard_normal((*size, 3)).astype(np.float32), (0, 0), sigma)
        total += layer / layer.std()
    return np.clip(128 + 30 * total, 0, 255).astype(np.uint8)


MOVE = np.array([[0.9, -0.25, 60.0], [0.25, 0.9, -20.0]])


@pytest.fixture(scope="module")
def pair() -> tuple[Features, Features]:
    """A wall, and the wall turned, shrunk by 7% and darker."""
    picture = wall(0)
    moved = (0.7 * cv2.warpAffine(picture, MOVE, (320, 240), flags=cv2.INTER_AREA)).astype(np.uint8)
    return find_features(picture, 1000), find_features(moved, 1000)


def test_features_are_found_again_where_the_picture_was_carried_to(pair: tuple[Features, Features]) -> None:
    a, b = pair
    matches = match_features(a, b)
    off = np.linalg.norm(a.pixels[matches[:, 0]] @ MOVE[:, :2].T + MOVE[:, 2] - b.pixels[matches[:, 1]], axis=1)
    assert len(matches) > 150
    assert (off < 1).mean() > 0.95 and np.median(off) < 0.3
    assert len(np.unique(matches[:, 0])) == len(np.unique(matches[:, 1])) == len(matches)


def test_places_are_not_shifted(pair: tuple[Features, Features]) -> None:
    """Of a picture and its mirror image, the middle of which is at (W - 1) / 2."""
    picture = wall(1)
    a, b = find_features(picture, 300), find_features(np.ascontiguousarray(picture[:, ::-1]), 300)
    mirrored = np.stack([picture.shape[1] - 1 - b.pixels[:, 0], b.pixels[:, 1]], axis=1)
    apart = a.pixels[:, None] - mirrored[None]
    nearest = np.linalg.norm(apart, axis=2).argmin(axis=1)
    offset = apart[np.arange(len(a)), nearest]
    near = np.linalg.norm(offset, axis=1) < 1.5
    assert near.mean() > 0.8
    assert np.abs(np.median(offset[near], axis=0)).max() < 0.05


def test_verified_matches_follow_one_motion(pair: tuple[Features, Features]) -> None:
    a, b = pair
    matches = verified_matches(a, b, 320)
    off = np.linalg.norm(a.pixels[matches[:, 0]] @ MOVE[:, :2].T + MOVE[:, 2] - b.pixels[matches[:, 1]], axis=1)
    assert len(matches) > 150 and (off < 1.5).mean() > 0.97
    assert len(verified_matches(a, find_features(wall(7), 1000), 320)) == 0


def test_of_two_that_are_alike_none_is_taken() -> None:
    """By hand: the second feature has two of the same looks in the other picture; the third is the nearest of nothing."""
    looks = np.eye(128, dtype=np.float32)
    place = np.zeros((3, 2), np.float32)
    a = Features(place, np.ones(3, np.float32), looks[[0, 1, 2]])
    b = Features(place, np.ones(3, np.float32), looks[[1, 1, 0]])
    assert match_features(a, b).tolist() == [[0, 2]]
    assert len(match_features(a, b[np.zeros(0, np.intp)])) == 0


def test_half_of_the_features_come_from_where_they_are_favoured() -> None:
    picture = wall(2)
    picture[:, :100] = 128 + (picture[:, :100].astype(int) - 128) // 8  # faint there
    favoured = np.zeros(picture.shape[:2], np.bool_)
    favoured[:, :100] = True
    plain, shared = find_features(picture, 200), find_features(picture, 200, favoured)
    assert len(plain) == len(shared) == 200
    assert (plain.pixels[:, 0] < 99.5).sum() < 20
    assert (shared.pixels[:, 0] < 99.5).sum() == 100


def test_descriptors_are_unit_vectors_and_a_plain_picture_has_none() -> None:
    assert np.linalg.norm(find_features(wall(3), 50).descriptors, axis=1) == pytest.approx(1, abs=1e-5)
    assert len(find_features(np.full((60, 80, 3), 90, np.uint8), 50)) == 0


def test_pictures_of_the_same_overlap(pair: tuple[Features, Features]) -> None:
    found = overlaps([*pair, find_features(wall(9), 1000)])
    assert found[0, 1] == found[1, 0] > 30
    assert found[0, 2] < 10 and found[1, 2] < 10


def test_along_an_epipolar_line_features_are_found_that_look_like_others_elsewhere() -> None:
    """By hand: the camera moved sideways, so rows are epipolar lines; two features look alike, one of them in the row."""
    looks = np.eye(128, dtype=np.float32)
    sideways = np.array([[0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
    a = Features(np.array([[10, 20], [90, 50]], np.float32), np.ones(2, np.float32), looks[[0, 1]])
    b = Features(np.array([[30, 20.5], [50, 80], [70, 90]], np.float32), np.ones(3, np.float32), looks[[0, 0, 1]])
    assert match_features(a, b).tolist() == [[1, 2]]
    assert guided_matches(a, b, sideways, 1.0).tolist() == [[0, 0]]
