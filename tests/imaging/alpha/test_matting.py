"""Layers that were put together here are told apart again."""

from __future__ import annotations

import cv2
import numpy as np

from engine.imaging.alpha.matting import estimate_foreground, estimate_layers, reconcile_with_plate

HEIGHT, WIDTH = 160, 200


def hairy_disk() -> np.ndarray:
    """Alpha (H, W) of a disk with a soft rim from which thin strands stand out."""
    big = np.zeros((HEIGHT * 4, WIDTH * 4), np.uint8)
    cv2.circle(big, (WIDTH * 2, HEIGHT * 2), 200, 255, -1)
    rng = np.random.default_rng(1)
    for angle in rng.uniform(0, 2 * np.pi, 120):
        reach = rng.uniform(205, 260)
        end = (int(WIDTH * 2 + reach * np.cos(angle)), int(HEIGHT * 2 + reach * np.sin(angle)))
        cv2.line(big, (WIDTH * 2, HEIGHT * 2), end, 255, 3)
    return (cv2.resize(big, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA) / 255).astype(np.float32)


def smooth_colours(seed: int, low: float, high: float) -> np.ndarray:
    noise = cv2.GaussianBlur(np.random.default_rng(seed).normal(size=(HEIGHT, WIDTH, 3)), (0, 0), 30)
    noise = (noise - noise.min()) / np.ptp(noise)
    return (low + (high - low) * noise).astype(np.float32)


def test_layers_are_told_apart() -> None:
    alpha, front, back = hairy_disk(), smooth_colours(2, 20, 90), smooth_colours(3, 150, 240)
    image = alpha[..., None] * front + (1 - alpha[..., None]) * back
    found_front, found_back = estimate_layers(image, alpha)
    mixed = (alpha > 0.05) & (alpha < 0.95)
    seen_front, seen_back = mixed & (alpha > 0.3), mixed & (alpha < 0.7)
    assert np.abs(found_front - front)[seen_front].mean() < 4
    assert np.abs(found_back - back)[seen_back].mean() < 4
    again = alpha[..., None] * found_front + (1 - alpha[..., None]) * found_back
    assert np.abs(again - image).mean() < 0.5


def test_settled_pixels_keep_their_colours_exactly() -> None:
    alpha = hairy_disk()
    image = (255 * np.random.default_rng(4).random((HEIGHT, WIDTH, 3))).astype(np.uint8)
    front, back = estimate_layers(image, alpha)
    np.testing.assert_array_equal(front[alpha == 1], image[alpha == 1])
    np.testing.assert_array_equal(back[alpha == 0], image[alpha == 0])


def test_dark_hair_moved_off_a_white_wall_shows_no_halo() -> None:
    alpha = hairy_disk()[..., None]
    front, wall, night = smooth_colours(5, 20, 60), np.float32(245), np.float32(10)
    image = alpha * front + (1 - alpha) * wall
    truth = alpha * front + (1 - alpha) * night
    rim = ((alpha > 0.02) & (alpha < 0.98))[..., 0]
    plain = np.abs(alpha * image + (1 - alpha) * night - truth)[rim].mean()
    clean = np.abs(alpha * estimate_foreground(image, alpha[..., 0]) + (1 - alpha) * night - truth)[rim].mean()
    assert plain > 15  # the halo that a plain cut-out shows
    assert clean < 0.1 * plain


def test_colours_continue_outside_of_the_layer() -> None:
    alpha = hairy_disk()
    image = alpha[..., None] * np.float32([60, 30, 20]) + (1 - alpha[..., None]) * np.float32([200, 220, 255])
    front = estimate_foreground(image, alpha)
    near = (alpha == 0) & (cv2.dilate(alpha, np.ones((5, 5))) > 0.5)
    assert np.abs(front[near] - np.float32([60, 30, 20])).max() < 8


def test_whole_and_empty_layers() -> None:
    image = smooth_colours(6, 0, 255)
    np.testing.assert_array_equal(estimate_foreground(image, np.ones((HEIGHT, WIDTH), np.float32)), image)
    _, back = estimate_layers(image, np.zeros((HEIGHT, WIDTH), np.float32))
    np.testing.assert_array_equal(back, image)


def test_at_rest_the_layer_over_another_plate_gives_the_picture() -> None:
    alpha, front, back = hairy_disk(), smooth_colours(7, 20, 90), smooth_colours(8, 100, 200)
    image = alpha[..., None] * front + (1 - alpha[..., None]) * back
    plate = np.clip(back + 25, 0, 255).astype(np.uint8)
    found = estimate_foreground(image, alpha)
    reconciled = reconcile_with_plate(image, alpha, found, plate)

    def missed(colours: np.ndarray) -> float:
        composed = alpha[..., None] * colours + (1 - alpha[..., None]) * plate
        return float(np.abs(composed - image)[(alpha > 0.3) & (alpha < 1)].mean())

    assert missed(reconciled) < 0.4 * missed(found)
    np.testing.assert_array_equal(reconciled[alpha == 0], found[alpha == 0])
    np.testing.assert_allclose(reconciled[alpha == 1], image[alpha == 1], atol=1e-3)
