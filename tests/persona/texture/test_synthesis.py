"""Textures mixed of photographs: band by band, by expression and detail."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.persona.texture.expression_weights import (
    MAX_EFFECTIVE_PHOTOS,
    MIN_EFFECTIVE_PHOTOS,
    SIGMA_PIXELS,
    effective_photos,
    expression_weights,
)
from engine.persona.texture.laplacian_pyramid import collapsed, laplacian_pyramid, levels_of
from engine.persona.texture.synthesis import UNIFORM_WEIGHT_DECAY_PER_LEVEL, texture_synthesis
from engine.persona.texture.white_balance import balanced, is_grey

SIZE = (97, 78)


def noise(seed: int, sigma: float = 2.0, mean: float = 128.0, contrast: float = 25.0) -> np.ndarray:
    found = cv2.GaussianBlur(np.random.default_rng(seed).normal(size=(*SIZE, 3)), (0, 0), sigma)
    return np.clip(mean + contrast * found / found.std(), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("shape", [(97, 78, 3), (64, 64), (31, 200)])
def test_a_pyramid_collapses_to_its_picture(shape: tuple[int, ...]) -> None:
    picture = np.random.default_rng(0).normal(size=shape).astype(np.float32)
    bands = laplacian_pyramid(picture, levels_of(shape))
    np.testing.assert_allclose(collapsed(bands), picture, atol=1e-5)


def test_levels_go_down_to_a_few_pixels() -> None:
    assert levels_of((244, 194)) == 4 and levels_of((500, 400)) == 5 and levels_of((20, 20)) == 1


def points(count: int, spread: float) -> np.ndarray:
    return np.random.default_rng(2).normal(size=(count, 51, 2)) * spread


@pytest.mark.parametrize("spread", [0.05, 0.7, 3.0])
def test_eight_to_sixteen_photographs_count_for_any_expression(spread: float) -> None:
    photos = points(60, spread)
    targets = np.concatenate([photos[:3], photos[:3] * 5])  # usual ones, and ones that no photograph shows
    count = effective_photos(expression_weights(targets, photos))
    assert (count > MIN_EFFECTIVE_PHOTOS - 0.1).all() and (count < MAX_EFFECTIVE_PHOTOS + 0.1).all()


def test_the_papers_sigma_stays_where_it_lets_as_many_count() -> None:
    photos = np.zeros((40, 51, 2))
    photos[:, 0, 0] = np.linspace(0, 60, 40)
    weights = expression_weights(photos[:1], photos)
    np.testing.assert_allclose(weights[0], np.exp(-(photos[:, 0, 0] ** 2) / (2 * SIGMA_PIXELS**2)), rtol=1e-5)


def test_few_photographs_all_count() -> None:
    assert effective_photos(expression_weights(points(1, 1.0), points(5, 1.0)))[0] == pytest.approx(5, abs=0.01)


def test_weights_of_frames_are_smooth_in_time() -> None:
    photos = points(40, 1.0)
    targets = photos[np.arange(30) % 7]
    hard, soft = (expression_weights(targets, photos, smoothing) for smoothing in (0.0, 2.0))
    assert np.abs(np.diff(soft, axis=0)).mean() < 0.2 * np.abs(np.diff(hard, axis=0)).mean()


def test_weights_of_an_expression_that_is_held_are_the_same_in_all_frames() -> None:
    photos = points(40, 1.0)
    held = photos[np.zeros(12, int)]
    np.testing.assert_allclose(expression_weights(held, photos, 2.0), expression_weights(held, photos), rtol=1e-5)


def test_photographs_that_are_all_the_same_are_the_texture() -> None:
    photo = noise(1)
    synthesis = texture_synthesis(np.array([photo] * 5), np.ones((5, *SIZE)))
    found = synthesis(np.random.default_rng(0).uniform(0.1, 1, (3, 5)).astype(np.float32))
    assert found.shape == (3, *SIZE, 3)
    assert np.abs(found.astype(int) - photo).max() <= 1


def test_fine_detail_is_the_expressions_and_tone_is_everybodys() -> None:
    dark, light = noise(1, mean=90), noise(2, mean=170)
    photos = np.array([dark] * 4 + [light] * 4)
    synthesis = texture_synthesis(photos, np.ones((8, *SIZE)))
    weights = np.repeat([[1.0], [0.0]], 4, 1).ravel()[None].astype(np.float32)  # of the dark ones alone
    found = synthesis(weights)[0].astype(np.float32)
    fine = [laplacian_pyramid(picture.astype(np.float32), 3)[0].ravel() for picture in (found, dark, light)]
    assert np.corrcoef(fine[0], fine[1])[0, 1] > 0.99 > 0.2 > abs(np.corrcoef(fine[0], fine[2])[0, 1])
    # of the coarsest level four photographs have the weight 1 + 1, four have 0 + 1
    assert found.mean() == pytest.approx((2 * dark.mean() + light.mean()) / 3, abs=3)
    assert UNIFORM_WEIGHT_DECAY_PER_LEVEL**-1 < 0.1, "of the level above it, a twentieth"


def test_what_is_not_believed_is_not_seen() -> None:
    photo = noise(1)
    covered = photo.copy()
    covered[30:60, 20:50] = (255, 0, 0)
    belief = np.ones((4, *SIZE), np.float32)
    belief[0, 24:66, 14:56] = 0
    found = texture_synthesis(np.array([covered, photo, photo, photo]), belief)(np.ones((1, 4), np.float32))[0]
    assert np.abs(found.astype(int) - photo).mean() < 1.5


def test_detail_comes_from_those_that_have_it() -> None:
    sharp = noise(1, sigma=1.0)
    soft = cv2.GaussianBlur(sharp, (0, 0), 3)
    photos = np.array([sharp] + [soft] * 4)
    found = texture_synthesis(photos, np.ones((5, *SIZE)))(np.ones((1, 5), np.float32))[0]
    detail = [
        laplacian_pyramid(picture.astype(np.float32), 2)[0].std() for picture in (found, photos.mean(axis=0), sharp)
    ]
    assert detail[0] > 1.5 * detail[1]


def test_a_hair_that_one_photograph_shows_is_left_out() -> None:
    photos = np.array([noise(k, contrast=4) for k in range(10)])
    plain = texture_synthesis(photos, np.ones((10, *SIZE)))(np.ones((1, 10), np.float32))[0].astype(int)
    haired = photos.copy()
    cv2.line(haired[3], (15, 10), (60, 80), (20, 20, 20), 1, cv2.LINE_AA)
    alone = np.full((1, 10), 0.5, np.float32)
    alone[0, 3] = 1  # the photograph that shows the hair counts most
    found = texture_synthesis(haired, np.ones((10, *SIZE)))(alone)[0].astype(int)
    hair = np.abs(haired[3].astype(int) - photos[3]).max(axis=-1) > 60
    drawn = plain[hair].mean() - found[hair].mean()
    assert drawn < 0.04 * (photos[3][hair].mean() - haired[3][hair].mean()), "a plain mean has a sixth of it"


def test_photographs_are_balanced_to_one_tone() -> None:
    face = np.zeros(SIZE, np.bool_)
    face[20:80, 20:60] = True
    first = noise(3, contrast=12, mean=110)
    casts = np.array([[1, 1, 1], [1.3, 1, 0.8], [0.6, 0.6, 0.6]])
    photos = np.clip(first * casts[:, None, None], 0, 255).astype(np.uint8)
    found = balanced(photos, np.ones((3, *SIZE)), face)
    means = found[:, face].mean(axis=1)
    assert np.abs(means - means[0]).max() < 1.5
    assert np.abs(means[0] - first[face].mean(axis=0) * np.median(casts, axis=0)).max() < 1.5


def test_black_and_white_is_told_and_gets_the_others_tone() -> None:
    colour = np.clip(noise(3, contrast=12) * [1.2, 0.9, 0.7], 0, 255).astype(np.uint8)
    grey = np.repeat(colour.mean(axis=2, keepdims=True), 3, 2).astype(np.uint8)
    photos = np.array([colour, colour, grey])
    assert is_grey(photos).tolist() == [False, False, True]
    found = balanced(photos, np.ones((3, *SIZE)), np.ones(SIZE, np.bool_))
    assert np.abs(found[2].mean((0, 1)) - colour.mean((0, 1))).max() < 2


def test_where_most_are_in_black_and_white_the_tone_is_of_those_in_colour() -> None:
    colour = np.clip(noise(3, contrast=12) * [1.2, 0.9, 0.7], 0, 255).astype(np.uint8)
    grey = np.repeat(colour.mean(axis=2, keepdims=True), 3, 2).astype(np.uint8)
    found = balanced(np.array([grey, colour, grey]), np.ones((3, *SIZE)), np.ones(SIZE, np.bool_))
    assert np.abs(found.mean((1, 2)) - colour.mean((0, 1))).max() < 2
