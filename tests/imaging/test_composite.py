"""A moved layer over a background that stays."""

from __future__ import annotations

import cv2
import numpy as np

from engine.imaging.composite import composite_over, upsample_twice, warp_layer


def _layer() -> np.ndarray:
    noise = np.random.default_rng(0).integers(0, 255, (60, 80, 4)).astype(np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 3)


def _identity(shape: tuple[int, int]) -> np.ndarray:
    ys, xs = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
    return np.dstack([2 * xs + 0.5, 2 * ys + 0.5])


def test_a_layer_that_does_not_move_stays_as_it_is() -> None:
    layer = _layer()
    same = warp_layer(upsample_twice(layer), _identity(layer.shape[:2]))
    assert np.abs(same.astype(int) - layer)[2:-2, 2:-2].max() <= 1


def test_a_shift_by_whole_pixels_shifts() -> None:
    layer = _layer()
    moved = warp_layer(upsample_twice(layer), _identity(layer.shape[:2]) + np.float32([2 * 5, 2 * 3]))
    assert np.abs(moved[2:50, 2:70].astype(int) - layer[5:53, 7:75]).max() <= 1


def test_alpha_decides_between_layer_and_plate() -> None:
    plate = np.full((4, 3, 3), 100, np.uint8)
    layer = np.full((4, 3, 4), 200, np.uint8)
    layer[..., 3] = np.array([0, 255, 51, 128], np.uint8)[:, None]
    out = composite_over(layer, plate)
    assert (out[0] == 100).all() and (out[1] == 200).all() and (out[2] == 120).all() and (out[3] == 150).all()
