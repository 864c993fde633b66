"""A loop without a jump."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_face import driver, placed

from engine.portrait.loop import close_loop


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


def test_the_beginning_is_reached_just_after_the_last_frame(tmp_path: Path) -> None:
    """The frame before the seam is the nearest to the first, and it comes to rest there."""
    meshes = [placed(50, (100 + 2.0 * i, 100)) for i in range(60)]
    closed = close_loop(driver(tmp_path, meshes))
    away = np.linalg.norm(closed.meshes[..., :2] - closed.meshes[0, :, :2], axis=-1).max(axis=1)
    assert away[-1] < 0.05 * away.max()
    assert (np.diff(away[-8:]) < 0).all()
