"""Sizes and edges of resampled pictures."""

from __future__ import annotations

import numpy as np

from engine.imaging.alpha.guided_upsample import upsample_guided
from engine.imaging.resample import even_size, resized, size_within


def test_shrinking_keeps_the_mean_and_the_axes() -> None:
    image = np.random.default_rng(0).random((60, 80, 1)).astype(np.float32)
    small = resized(image, (20, 15))
    assert small.shape == (15, 20, 1)
    assert small.dtype == np.float32
    np.testing.assert_allclose(small.mean(), image.mean(), rtol=1e-5)
    assert resized(np.zeros((60, 80), np.uint8), (1, 1)).shape == (1, 1)


def test_size_within_keeps_the_shape_and_never_enlarges() -> None:
    assert size_within((1000, 2000, 3), 500) == (500, 250)
    assert size_within((100, 200), 500) == (200, 100)
    assert size_within((1, 4000), 500) == (500, 1)


def test_guided_upsampling_finds_the_large_pictures_edge() -> None:
    ys, xs = np.mgrid[:256, :256]
    disk = (np.hypot(xs - 128, ys - 128) < 80).astype(np.float32)
    picture = np.where(disk[..., None] > 0, np.uint8([200, 120, 90]), np.uint8([40, 60, 110])).astype(np.uint8)
    small_disk, small = resized(disk, (64, 64)), resized(picture, (64, 64))
    guided = upsample_guided(small_disk, small, picture)
    plain = resized(small_disk, (256, 256))
    assert np.abs(guided - disk).mean() < 0.25 * np.abs(plain - disk).mean()


def test_even_size() -> None:
    assert even_size(601, 799) == (600, 800)
    assert even_size(1, 2.4) == (2, 2)
