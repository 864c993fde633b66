"""How sharp a picture is, by the blur of its edges."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.imaging.edge_blur import edge_blur

SIDE, FINER = 200, 8


@pytest.fixture(scope="module")
def disks() -> np.ndarray:
    rng = np.random.default_rng(0)
    large = np.full((SIDE * FINER, SIDE * FINER), 60, np.float32)
    for _ in range(12):
        middle = [int(one) for one in rng.integers(200, 1400, 2)]
        cv2.circle(large, middle, int(rng.integers(60, 300)), float(rng.integers(0, 255)), -1)
    return np.asarray(cv2.resize(large, (SIDE, SIDE), interpolation=cv2.INTER_AREA))


@pytest.mark.parametrize(
    ("blur", "noise", "off"), [(0.8, 0, 0.1), (1.5, 0, 0.1), (3.0, 0, 0.1), (0.8, 2, 0.1), (1.5, 2, 0.2)]
)
def test_the_blur_of_edges_is_found(disks: np.ndarray, blur: float, noise: float, off: float) -> None:
    soft = cv2.GaussianBlur(disks, (0, 0), blur) + np.random.default_rng(1).normal(0, noise, disks.shape)
    assert edge_blur(soft, np.ones(disks.shape, bool)) == pytest.approx(blur, rel=off)


def test_only_what_is_asked_for_counts(disks: np.ndarray) -> None:
    half = disks.copy()
    half[:, SIDE // 2 :] = cv2.GaussianBlur(disks, (0, 0), 2.0)[:, SIDE // 2 :]
    left = np.zeros(disks.shape, bool)
    left[:, : SIDE // 2 - 8] = True
    assert edge_blur(half, left) < 0.5 < 1.5 < edge_blur(half, np.roll(left, SIDE // 2 + 8, axis=1))


def test_without_edges_there_is_no_sharpness() -> None:
    flat = np.full((60, 60), 100, np.uint8)
    assert edge_blur(flat, np.ones(flat.shape, bool)) is None
    assert edge_blur(flat, np.zeros(flat.shape, bool)) is None
