"""Small pictures for lists stay small, whatever they show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from engine.export.still import THUMBNAIL_BYTES, write_first_impression
from engine.export.synthetic import SOURCE_TYPE


def gradient(height: int, width: int) -> np.ndarray:
    across = np.linspace(20, 235, width, dtype=np.float32)[None].repeat(height, 0)
    down = np.linspace(235, 20, height, dtype=np.float32)[:, None].repeat(width, 1)
    return np.stack([across, down, (across + down) / 2], axis=-1).astype(np.uint8)


@pytest.mark.parametrize("size", [(1200, 1920), (1920, 1200), (90, 120)])
def test_a_thumbnail_is_the_preview_within_320_pixels(tmp_path: Path, size: tuple[int, int]) -> None:
    preview, thumbnail = write_first_impression(tmp_path, gradient(*size), None, synthetic=True)
    assert (preview.name, thumbnail.name) == ("preview.jpg", "thumbnail.jpg")
    small, large = Image.open(thumbnail), Image.open(preview)
    assert large.size == size[::-1] and max(small.size) == min(320, max(size))
    same = np.asarray(large.resize(small.size, Image.Resampling.BOX)).astype(int)
    assert np.abs(np.asarray(small).astype(int) - same).mean() < 3
    assert SOURCE_TYPE.encode() in thumbnail.read_bytes()


def test_a_thumbnail_of_pure_noise_is_as_small_as_any(tmp_path: Path) -> None:
    noise = np.random.default_rng(0).integers(0, 256, (1000, 1000, 3)).astype(np.uint8)
    _, thumbnail = write_first_impression(tmp_path, noise[:320, :320], None, synthetic=True)
    assert thumbnail.stat().st_size <= THUMBNAIL_BYTES


def test_what_is_transparent_is_white_in_both(tmp_path: Path) -> None:
    rgb, alpha = np.full((64, 64, 3), (200, 20, 20), np.uint8), np.zeros((64, 64), np.float32)
    alpha[:, 32:] = 1
    for path in write_first_impression(tmp_path, rgb, alpha, synthetic=False):
        pixels = np.asarray(Image.open(path)).astype(int)
        assert np.abs(pixels[32, 8] - 255).max() < 4 and np.abs(pixels[32, 56] - (200, 20, 20)).max() < 6
