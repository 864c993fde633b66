"""A loop without a jump."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_face import driver, in_crop, opened, painted, placed

from engine.face_animation.creases.fine_details import keep_ratio_images
from engine.face_animation.loop import close_loop
from engine.perception.face_track.face_crop import CROP_SHAPE


@pytest.mark.parametrize("count", [2, 3, 10, 100])
def test_the_end_leads_to_the_beginning(tmp_path: Path, count: int) -> None:
    """A head that drifts away: from the last frame to the first is one step of the way back, no jump."""
    drift = np.array([1.0, 0.5, 0.0], np.float32)
    meshes = [placed(50, (100, 100)) + i * drift for i in range(count)]
    around = np.arange(count, dtype=np.float32)[:, None, None] * np.ones((1, 3, 2), np.float32)
    track = driver(tmp_path, meshes, periphery=around)
    closed = close_loop(track)
    assert len(closed) == count
    for path in (closed.meshes, closed.periphery):
        steps = np.linalg.norm(np.diff(np.concatenate([path, path[:1]]), axis=0), axis=-1).max(axis=1)
        assert steps[-1] <= steps[:-1].max() + 1e-4
    kept = count - min(15, count // 2)
    np.testing.assert_array_equal(closed.meshes[:kept], track.meshes[:kept])
    np.testing.assert_array_equal(track.meshes[-1], np.array(meshes[-1], np.float32))  # the given one is not changed


def test_looks_lead_to_the_beginning_with_the_face(tmp_path: Path) -> None:
    """A mouth that opens and a cheek that darkens, from the first frame to the last: across the seam both are led back."""
    count = 40
    meshes = [opened(placed(60, (100, 100)), 0.4 * i / count) for i in range(count)]
    pictures = [painted(in_crop(mesh), CROP_SHAPE[::-1]) for mesh in meshes]
    cheek = (slice(150, 180), slice(70, 90))
    for i, picture in enumerate(pictures):
        picture[cheek] = picture[cheek] * (1 - 0.2 * i / count)
    track = driver(tmp_path, meshes, pictures)
    closed = close_loop(track)
    ratios = np.stack([ratio[165, 80] for ratio in keep_ratio_images(closed, 0)])
    for shown in (ratios, [closed.crop(frame)[165, 80].mean() for frame in range(count)]):
        steps = np.abs(np.diff(np.append(shown, shown[0])))
        assert steps[-1] <= steps[:-1].max() + 1e-2 and np.ptp(shown) > 0.05
    for frame, mesh in enumerate(closed.meshes):
        drawn = painted(in_crop(mesh), CROP_SHAPE[::-1])
        shown, meant = ((crop[:, 144].astype(int).sum(axis=1) < 250).sum() for crop in (closed.crop(frame), drawn))
        assert abs(shown - meant) <= 3  # the dark of the mouth is as high as the mesh has it


def test_the_beginning_is_reached_just_after_the_last_frame(tmp_path: Path) -> None:
    """The frame before the seam is the nearest to the first, and it comes to rest there."""
    meshes = [placed(50, (100 + 2.0 * i, 100)) for i in range(60)]
    closed = close_loop(driver(tmp_path, meshes))
    away = np.linalg.norm(closed.meshes[..., :2] - closed.meshes[0, :, :2], axis=-1).max(axis=1)
    assert away[-1] < 0.05 * away.max()
    assert (np.diff(away[-8:]) < 0).all()
