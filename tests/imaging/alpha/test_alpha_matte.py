"""Alpha mattes of pictures that were composed here, and the Laplacian against its definition."""

from __future__ import annotations

import cv2
import numpy as np

from engine.imaging.alpha.alpha_matte import alpha_matte, laplacian_rows
from engine.imaging.alpha.colour_pairs import alpha_from_colour_pairs

HEIGHT, WIDTH = 120, 160


def ramped_disk() -> np.ndarray:
    ys, xs = np.mgrid[:HEIGHT, :WIDTH]
    away = np.hypot(xs - 80, ys - 60)
    return np.clip((46 - away) / 12, 0, 1).astype(np.float32)


def ring_trimap(alpha: np.ndarray, width: int) -> np.ndarray:
    side = 2 * width + 1
    sure = cv2.erode((alpha == 1).astype(np.uint8), np.ones((side, side)))
    off = cv2.erode((alpha == 0).astype(np.uint8), np.ones((side, side)))
    return np.where(sure > 0, 1, np.where(off > 0, 0, 0.5)).astype(np.float32)


def compose(alpha: np.ndarray, front: np.ndarray, back: np.ndarray) -> np.ndarray:
    return np.clip(alpha[..., None] * front + (1 - alpha[..., None]) * back + 0.5, 0, 255).astype(np.uint8)


def test_laplacian_is_that_of_the_paper() -> None:
    """Equation 12 of Levin et al., window by window, on a small picture."""
    pixels = np.random.default_rng(0).random((7, 8, 3)).astype(np.float32)
    noise = 1e-3
    number = np.arange(56, dtype=np.int32).reshape(7, 8)
    dense = np.zeros((56, 56))
    for cy in range(1, 6):
        for cx in range(1, 7):
            window = [(y, x) for y in range(cy - 1, cy + 2) for x in range(cx - 1, cx + 2)]
            colours = np.array([pixels[p] for p in window], float)
            centred = colours - colours.mean(0)
            inverse = np.linalg.inv(centred.T @ centred / 9 + noise * np.eye(3))
            affinity = (1 + centred @ inverse @ centred.T) / 9
            indices = [number[p] for p in window]
            dense[np.ix_(indices, indices)] += np.eye(9) - affinity
    rows = laplacian_rows(pixels, number, 56, noise)
    for (y, x), i in np.ndenumerate(number):
        for k in range(25):
            ny, nx = y + k // 5 - 2, x + k % 5 - 2
            if 0 <= ny < 7 and 0 <= nx < 8:
                assert abs(rows[i, k] - dense[i, number[ny, nx]]) < 1e-4
    np.testing.assert_allclose(rows.sum(1), 0, atol=1e-4)  # a constant alpha costs nothing


def test_two_plain_colours_give_their_mixture_back() -> None:
    alpha = ramped_disk()
    picture = compose(alpha, np.float32([180, 60, 40]), np.float32([40, 90, 200]))
    found = alpha_matte(picture, ring_trimap(alpha, 4))
    assert np.abs(found - alpha).max() < 0.02


def test_strands_over_a_lit_wall() -> None:
    big = np.zeros((HEIGHT * 4, WIDTH * 4), np.uint8)
    cv2.circle(big, (320, 240), 130, 255, -1)
    rng = np.random.default_rng(2)
    for angle in rng.uniform(0, 2 * np.pi, 50):
        end = (int(320 + 190 * np.cos(angle)), int(240 + 190 * np.sin(angle)))
        cv2.line(big, (320, 240), end, 255, 5)
    alpha = (cv2.resize(big, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA) / 255).astype(np.float32)
    wall = np.linspace(150, 230, WIDTH, dtype=np.float32)[None, :, None] * np.float32([1, 0.95, 0.85])
    picture = compose(alpha, np.float32([50, 35, 25]), np.broadcast_to(wall, (HEIGHT, WIDTH, 3)))
    ys, xs = np.mgrid[:HEIGHT, :WIDTH]
    away = np.hypot(xs - 80, ys - 60)
    trimap = np.where(away < 28, 1, np.where(away > 52, 0, 0.5)).astype(np.float32)
    band = trimap == 0.5
    found = alpha_matte(picture, trimap)
    assert np.abs(found - alpha)[band].mean() < 0.02
    assert np.abs(found - (alpha > 0.5))[band].mean() > 0.05  # strands are soft: no hard mask comes near


def test_settled_pixels_stay() -> None:
    alpha = ramped_disk()
    trimap = ring_trimap(alpha, 3)
    noise = (255 * np.random.default_rng(3).random((HEIGHT, WIDTH, 3))).astype(np.uint8)
    found = alpha_matte(noise, trimap)
    np.testing.assert_array_equal(found[trimap == 1], 1)
    np.testing.assert_array_equal(found[trimap == 0], 0)
    assert found.min() >= 0
    assert found.max() <= 1
    np.testing.assert_array_equal(alpha_matte(noise, (trimap > 0.6).astype(np.float32)), trimap > 0.6)


def test_belief_decides_where_colours_say_nothing() -> None:
    trimap = ring_trimap(ramped_disk(), 6)
    left = (np.mgrid[:HEIGHT, :WIDTH][1] < 80).astype(np.float32)
    grey = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
    found = alpha_matte(grey, trimap, prior=left, prior_weight=np.full(left.shape, 0.5, np.float32))
    unknown = (trimap == 0.5) & (np.abs(np.mgrid[:HEIGHT, :WIDTH][1] - 80) > 15)
    assert (np.abs(found - left)[unknown] < 0.5).mean() > 0.9


def test_colour_pairs_know_what_they_cannot_tell() -> None:
    alpha = ramped_disk()
    trimap = ring_trimap(alpha, 3)
    band = trimap == 0.5
    clear = compose(alpha, np.float32([200, 40, 40]), np.float32([30, 80, 220]))
    found, confidence = alpha_from_colour_pairs(clear, trimap)
    assert np.abs(found - alpha)[band].max() < 0.03
    assert confidence[band].min() > 0.9
    alike = compose(alpha, np.float32([100, 100, 100]), np.float32([103, 100, 100]))
    _, confidence = alpha_from_colour_pairs(alike, trimap)
    assert confidence[band].max() < 0.1
