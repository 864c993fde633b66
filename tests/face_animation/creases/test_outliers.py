"""A shadow that moved is taken out of the ratio images, a new crease is kept (figure 5)."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import SKIN, driver, in_crop, placed, smiling
from numpy.typing import NDArray

from engine.face_animation.creases.fine_details import MIN_RATIO, RatioImages
from engine.face_animation.creases.outliers import SEARCH_RADIUS_PIXELS, SIGNIFICANT_RATIO, match_differences
from engine.perception.face_track.face_crop import CROP_EYES, CROP_SHAPE
from engine.perception.face_track.track import FaceTrack

FACE = placed(70, (100, 100))
ACTED = smiling(FACE, 0.2)
SHADOW, CREASE = (130, 165), (90, 175)
"""Beside the nose, and on the cheek; x and y in the crop."""


def skin() -> NDArray[np.float64]:
    """Skin with soft blotches, as all skin has."""
    rng = np.random.default_rng(0)
    blotches = cv2.GaussianBlur(rng.normal(0, 1, CROP_SHAPE), (0, 0), 6)
    return np.array(SKIN, float) + 4 * (blotches / blotches.std())[..., None]


def darkened(picture: NDArray, centre: tuple[float, float], size: tuple[float, float], depth: float) -> NDArray:
    """A soft dark spot."""
    ys, xs = np.mgrid[: CROP_SHAPE[0], : CROP_SHAPE[1]]
    spot = np.exp(-0.5 * (((xs - centre[0]) / size[0]) ** 2 + ((ys - centre[1]) / size[1]) ** 2))
    return picture * (1 - depth * spot)[..., None]


def pictures(shift: tuple[float, float] = (4.0, 2.0)) -> list[NDArray[np.uint8]]:
    """The neutral crop with a shadow; the smiling one with the shadow moved and a crease that is new."""
    neutral = darkened(skin(), SHADOW, (4, 7), 0.45)
    acted = darkened(skin(), (SHADOW[0] + shift[0], SHADOW[1] + shift[1]), (4, 7), 0.45)
    acted = darkened(acted, CREASE, (2, 14), 0.45)
    return [np.clip(p, 0, 255).astype(np.uint8) for p in (neutral, acted)]


@pytest.fixture
def track(tmp_path: Path) -> FaceTrack:
    """Neutral, half-way, smiling."""
    neutral, acted = pictures()
    half = ((neutral.astype(int) + acted) // 2).astype(np.uint8)
    return driver(tmp_path, [FACE, smiling(FACE, 0.1), ACTED], [neutral, half, acted])


def at(image: NDArray, place: tuple[int, int], reach: int = 9) -> NDArray:
    x, y = place
    return image[y - reach : y + reach + 1, x - reach : x + reach + 1]


def test_a_moved_shadow_is_removed_and_a_new_crease_is_kept(track: FaceTrack) -> None:
    raw = RatioImages(track, 0, outliers=False).single(2)
    refined = RatioImages(track, 0, outliers=True).single(2)
    assert at(raw, SHADOW, 14).min() < 1 / SIGNIFICANT_RATIO - 0.1  # without it, the shadow would be carried over
    assert at(refined, SHADOW, 14).min() > 0.99
    assert at(refined, CREASE).min() <= MIN_RATIO + 1e-6
    assert at(refined, CREASE).min() == pytest.approx(at(raw, CREASE).min(), abs=0.05)


def test_it_is_removed_from_every_frame(track: FaceTrack) -> None:
    """Judged once, in the most expressive frame, and propagated by similarities (section 6)."""
    images = RatioImages(track, 0, outliers=True)
    assert at(images.single(1), SHADOW, 14).min() > 0.99
    assert at(images.single(1), CREASE).min() < 0.85


def test_the_footprint_moves_with_the_head(tmp_path: Path) -> None:
    """The head tilts and shifts in the picture: the crop follows the eyes, the outlier the face."""
    neutral, acted = pictures()
    a = np.deg2rad(12)
    turned = ((FACE - FACE.mean(axis=0)) @ np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]])
              + FACE.mean(axis=0) + (20, 10, 0)).astype(np.float32)  # fmt: skip
    track = driver(tmp_path, [FACE, turned, ACTED], [neutral, acted, acted])
    assert at(RatioImages(track, 0, outliers=True).single(1), SHADOW, 14).min() > 0.99


def test_without_outliers_nothing_is_removed(tmp_path: Path) -> None:
    neutral = np.clip(skin(), 0, 255).astype(np.uint8)
    acted = np.clip(darkened(skin(), CREASE, (2, 14), 0.45), 0, 255).astype(np.uint8)
    track = driver(tmp_path, [FACE, ACTED], [neutral, acted])
    images = RatioImages(track, 0, outliers=True)
    assert images.outliers is not None
    assert images.outliers.distance.min() > 100
    assert at(images.single(1), CREASE).min() <= MIN_RATIO + 1e-6


@pytest.mark.parametrize("shift", [(3, 0), (-6, 5), (0, -9)])
def test_a_patch_is_found_again_within_the_search(shift: tuple[int, int]) -> None:
    rng = np.random.default_rng(0)
    neutral = rng.integers(40, 200, (*CROP_SHAPE, 3), np.uint8)
    frame = np.roll(neutral, (-shift[1], -shift[0]), axis=(0, 1))
    where = np.zeros(CROP_SHAPE, np.uint8)
    where[100:104, 100:104] = 1
    best = match_differences(frame, neutral, _identity(), where)
    assert best[where > 0].max() == 0
    assert not best[where == 0].any()


def test_beyond_the_search_it_is_not_found() -> None:
    rng = np.random.default_rng(0)
    neutral = rng.integers(40, 200, (*CROP_SHAPE, 3), np.uint8)
    where = np.zeros(CROP_SHAPE, np.uint8)
    where[100:104, 100:104] = 1
    best = match_differences(np.roll(neutral, 14, axis=1), neutral, _identity(), where)
    assert best[where > 0].min() > 20


@pytest.mark.parametrize("degrees", [-30, 30])
def test_a_turned_patch_is_found(degrees: int) -> None:
    """Turned texture is found better than by a search that only shifts, made here the plain way."""
    rng = np.random.default_rng(0)
    texture = cv2.GaussianBlur(rng.normal(0, 1, (*CROP_SHAPE, 3)), (0, 0), 1.6)
    neutral = np.clip(128 + 50 * texture / texture.std(), 0, 255).astype(np.uint8)
    places = [(60 + 40 * i, 80 + 50 * j) for i in range(4) for j in range(4)]
    turned, shifted = [], []
    for x, y in places:
        about = cv2.getRotationMatrix2D((float(x), float(y)), degrees, 1.0)
        frame = cv2.warpAffine(
            neutral, about, CROP_SHAPE[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
        where = np.zeros(CROP_SHAPE, np.uint8)
        where[y, x] = 1
        turned.append(match_differences(frame, neutral, _identity(), where)[y, x])
        patch = frame[y - 1 : y + 2, x - 1 : x + 2].astype(int)
        shifted.append(
            min(
                int(np.abs(patch - neutral[v - 1 : v + 2, u - 1 : u + 2]).max())
                for v in range(y - SEARCH_RADIUS_PIXELS, y + SEARCH_RADIUS_PIXELS)
                for u in range(x - SEARCH_RADIUS_PIXELS, x + SEARCH_RADIUS_PIXELS)
            )
        )
    assert np.mean(turned) < 0.85 * np.mean(shifted)


def _identity() -> NDArray[np.float32]:
    ys, xs = np.mgrid[: CROP_SHAPE[0], : CROP_SHAPE[1]].astype(np.float32)
    return np.stack([xs, ys], axis=-1)


def test_shadows_of_a_real_face_are_judged_alike_on_both_sides() -> None:
    """Mirrored pictures give mirrored verdicts: the search has no preferred side by more than its even width."""
    neutral, acted = pictures((0.0, 4.0))
    where = np.zeros(CROP_SHAPE, np.uint8)
    where[150:185, 115:146] = 1
    straight = match_differences(acted, neutral, _identity(), where)
    flipped = match_differences(
        np.ascontiguousarray(acted[:, ::-1]), np.ascontiguousarray(neutral[:, ::-1]), _identity(), where[:, ::-1].copy()
    )[:, ::-1]
    assert np.abs(straight - flipped)[where > 0].mean() < 0.5


def test_crops_of_made_faces_lie_where_the_track_says() -> None:
    """The test's own pictures are painted in the crop's frame: eyes at the crop's eye places."""

    mesh = in_crop(placed(33, (61, 47), roll=25))
    eyes = np.array([mesh[[33, 133], :2].mean(axis=0), mesh[[263, 362], :2].mean(axis=0)])
    np.testing.assert_allclose(eyes, CROP_EYES, atol=1e-3)
