"""What one frame's mask lets in is taken out by what the others have there."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from engine.avatar.capture.carved_masks import within_hull
from engine.geometry.camera import Camera

TOP = 1.4
"""Metres: above there is a disk, as a brim is."""
BRIM_LOST = range(0, 12, 2)
"""Views that do not show the disk."""


def _scene() -> tuple[np.ndarray, np.ndarray]:
    """Points of two legs and a trunk, and of the disk above them."""
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0, TOP, 150))
    leg = np.column_stack([0.07 * np.cos(turn.ravel()), height.ravel(), 0.07 * np.sin(turn.ravel())])
    trunk = np.column_stack([0.2 * np.cos(turn.ravel()), 1 + 0.3 * height.ravel(), 0.2 * np.sin(turn.ravel())])
    legs = np.concatenate([trunk, *(leg + np.array([x, 0, 0]) for x in (-0.14, 0.14))])
    x, z = np.meshgrid(np.linspace(-0.3, 0.3, 120), np.linspace(-0.3, 0.3, 120))
    on = np.hypot(x, z) < 0.3
    return legs, np.column_stack([x[on], np.full(int(on.sum()), TOP + 0.25), z[on]])


def _mask(camera: Camera, points: np.ndarray) -> np.ndarray:
    at = camera.project(points)[:, :2].round().astype(int)
    out = np.zeros(camera.size, np.uint8)
    out[at[:, 1], at[:, 0]] = 1
    return np.asarray(cv2.morphologyEx(out, cv2.MORPH_CLOSE, np.ones((9, 9), np.uint8)) > 0)


@pytest.fixture(scope="module", params=[(), (0.06, -0.01, 0.0, 0.0)], ids=["straight", "bent"])
def views(request: pytest.FixtureRequest) -> tuple[list[Camera], list[np.ndarray], list[np.ndarray]]:
    """Cameras around, the body alone, and with the disk."""
    lens = replace(Camera((0.0, 0.0, 0.0), 300.0, (134.5, 239.5), (480, 270)), distortion=request.param)
    legs, disk = _scene()
    cameras = [lens.aimed((2 * np.sin(a), 0.8, 2 * np.cos(a)), (0, 0.75, 0)) for a in np.arange(12) * np.pi / 6]
    bare = [_mask(camera, legs) for camera in cameras]
    brims = [_mask(camera, disk) for camera in cameras]
    shown = [b | (d & (k not in BRIM_LOST)) for k, (b, d) in enumerate(zip(bare, brims, strict=True))]
    return cameras, bare, shown


def test_a_gap_that_one_frame_fills_is_open_again(
    views: tuple[list[Camera], list[np.ndarray], list[np.ndarray]],
) -> None:
    cameras, bare, shown = views
    gap = (
        np.asarray(cv2.morphologyEx(bare[0].astype(np.uint8), cv2.MORPH_CLOSE, np.ones((41, 41), np.uint8)) > 0)
        & ~bare[0]
    )
    gap[:300] = False
    filled = [shown[0] | gap, *shown[1:]]
    found = within_hull(filled, cameras, TOP)
    assert gap.sum() > 300
    assert (found[0] & gap).sum() < 0.25 * gap.sum()  # what is left lies along the legs
    for mask, true in zip(found, bare, strict=True):
        assert (mask & true).sum() > 0.995 * true.sum()


def test_what_stands_out_above_the_shoulders_stays(
    views: tuple[list[Camera], list[np.ndarray], list[np.ndarray]],
) -> None:
    cameras, bare, shown = views
    found = within_hull(shown, cameras, TOP)
    for mask, whole, legs in zip(found, shown, bare, strict=True):
        brim = whole & ~legs
        assert (mask & brim).sum() == brim.sum()


def test_a_mask_of_which_hardly_anything_would_stay_is_left(
    views: tuple[list[Camera], list[np.ndarray], list[np.ndarray]],
) -> None:
    cameras, bare, _ = views
    elsewhere = [np.roll(bare[0], 60, axis=1), *bare[1:]]
    np.testing.assert_array_equal(within_hull(elsewhere, cameras, TOP)[0], elsewhere[0])


def test_masks_that_share_nothing_stay(views: tuple[list[Camera], list[np.ndarray], list[np.ndarray]]) -> None:
    cameras, bare, _ = views
    empty = [np.zeros_like(mask) for mask in bare]
    for mask in within_hull(empty, cameras, TOP):
        assert not mask.any()
