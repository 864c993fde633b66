"""Blur: it grows with the radius, and a plain picture shows nothing."""

import cv2
import numpy as np
import pytest

from engine.imaging.blur import blur_effect


def test_blur_grows_with_the_radius() -> None:
    blocks = np.random.default_rng(4).integers(0, 256, (12, 16), np.uint8).repeat(10, axis=0).repeat(10, axis=1)
    values = [blur_effect(blocks), *(blur_effect(cv2.GaussianBlur(blocks, (0, 0), sigma)) for sigma in (1, 2, 4, 8))]
    assert values == sorted(values)
    assert values[0] < 0.35
    assert values[-1] > 0.7


def test_a_plain_picture_counts_as_blurred_and_one_edge_as_sharp() -> None:
    assert blur_effect(np.full((50, 60), 80, np.uint8)) == 1
    edge = np.zeros((50, 60), np.uint8)
    edge[:, 30:] = edge[30:] = 200
    assert blur_effect(edge) == pytest.approx(
        1 / 9, abs=0.03
    )  # blurred over nine pixels, an edge keeps a ninth in each
