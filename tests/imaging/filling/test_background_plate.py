"""Plates of scenes whose hidden part is known."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.imaging.filling.background_plate import background_plate, hole_behind

HEIGHT, WIDTH = 240, 320
PERSON = np.float32([220, 30, 30])


def bust() -> np.ndarray:
    """Alpha (H, W) of a head on shoulders that the picture's lower border cuts, soft at its edge."""
    mask = np.zeros((HEIGHT, WIDTH), np.float32)
    cv2.ellipse(mask, (160, 100), (48, 60), 0, 0, 360, 1, -1)
    cv2.ellipse(mask, (160, 250), (110, 90), 0, 0, 360, 1, -1)
    return cv2.GaussianBlur(mask, (0, 0), 1.5)


def with_person(scene: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    return np.clip(alpha[..., None] * PERSON + (1 - alpha[..., None]) * scene, 0, 255).astype(np.uint8)


def behind(alpha: np.ndarray, reach: float) -> np.ndarray:
    """The band of the hidden part that a moving head lays bare."""
    depth = cv2.distanceTransform((alpha > 0.02).astype(np.uint8), cv2.DIST_L2, 5)
    return (depth > 0) & (depth < reach)


def lit_wall() -> np.ndarray:
    ys, xs = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    wall = np.stack([120 + 0.2 * xs, 130 + 0.15 * ys, 150 - 0.1 * xs], -1)
    return wall + np.random.default_rng(1).normal(0, 3, wall.shape)


def panelled_wall() -> np.ndarray:
    wall = np.full((HEIGHT, WIDTH, 3), 190, np.float32)
    for y in (60, 110):
        wall[y : y + 6] = (90, 70, 60)
    return wall


def woven_wall() -> np.ndarray:
    ys, xs = np.mgrid[:HEIGHT, :WIDTH]
    weave = 130 + 50 * np.sign(np.sin(xs * 2 * np.pi / 12) * np.sin(ys * 2 * np.pi / 12))
    return np.repeat(weave[..., None], 3, 2).astype(np.float32)


def test_far_from_the_person_nothing_changes() -> None:
    picture, alpha = with_person(lit_wall(), bust()), bust()
    plate = background_plate(picture, alpha)
    away = ~hole_behind(alpha)
    np.testing.assert_array_equal(plate[away], picture[away])
    assert plate.dtype == np.uint8


@pytest.mark.parametrize(("scene", "error"), [(lit_wall, 5.0), (panelled_wall, 6.0), (woven_wall, 12.0)])
def test_what_was_hidden_comes_back(scene, error: float) -> None:  # type: ignore[no-untyped-def]
    """Walls, lines and weave within 20 pixels behind the outline, in grey levels of mean error."""
    alpha = bust()
    plate = background_plate(with_person(scene(), alpha), alpha, reach=24)
    assert np.abs(plate - scene())[behind(alpha, 20)].mean() < error


def test_lines_continue_behind_the_head() -> None:
    alpha = bust()
    plate = background_plate(with_person(panelled_wall(), alpha), alpha, reach=24)
    for y in (60, 110):
        columns = np.flatnonzero(behind(alpha, 15)[y + 3] & (np.arange(WIDTH) < 160))
        assert (plate[y + 2 : y + 4, columns].mean((0, 2)) < 130).mean() > 0.8


def test_no_ghost_of_the_person_is_left() -> None:
    alpha = bust()
    plate = background_plate(with_person(lit_wall(), alpha), alpha).astype(np.float32)
    redness = plate[..., 0] - plate[..., 1]
    assert redness.max() < 80  # the person's is 190, the wall's at most 75


def test_grain_is_kept() -> None:
    alpha = bust()
    plate = background_plate(with_person(lit_wall(), alpha), alpha, reach=24).astype(np.float32)
    grain = plate - cv2.GaussianBlur(plate, (0, 0), 2)
    band = behind(alpha, 15)
    assert grain[band].std() > 0.7 * grain[~hole_behind(alpha)].std()


def test_same_seed_same_plate() -> None:
    picture, alpha = with_person(woven_wall(), bust()), bust()
    first = background_plate(picture, alpha, seed=3)
    np.testing.assert_array_equal(first, background_plate(picture, alpha, seed=3))


def test_hole_at_the_border_and_little_left_to_copy_from() -> None:
    scene = np.full((HEIGHT, WIDTH, 3), (90, 120, 140), np.float32)
    alpha = np.ones((HEIGHT, WIDTH), np.float32)
    alpha[:, :16] = 0
    plate = background_plate(with_person(scene, alpha), alpha)
    assert np.abs(plate - scene).max() <= 2


def test_nobody_and_nothing_but_the_person() -> None:
    picture = with_person(lit_wall(), bust())
    np.testing.assert_array_equal(background_plate(picture, np.zeros((HEIGHT, WIDTH), np.float32)), picture)
    plate = background_plate(picture, np.ones((HEIGHT, WIDTH), np.float32))
    assert np.ptp(plate.reshape(-1, 3), axis=0).max() == 0


def test_pictures_of_few_pixels() -> None:
    tiny = np.full((5, 6, 3), 77, np.uint8)
    alpha = np.zeros((5, 6), np.float32)
    alpha[2, 2] = 1
    assert background_plate(tiny, alpha).shape == (5, 6, 3)
