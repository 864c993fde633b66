"""Further charts on a texture: in its free room, not on each other, and not distorted."""

from __future__ import annotations

import numpy as np
import pytest

from engine.geometry.texture_charts.atlas_room import ATLAS_ROOM_CELLS, cells_of, placed_between
from engine.geometry.texture_charts.texture_atlas import TextureAtlas


def squares(count: int, side: float) -> TextureAtlas:
    """So many squares of two triangles each, of sides from `side` down to half of it, all in one place."""
    sides = side * np.linspace(1, 0.5, count)
    uv = np.concatenate([s * np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) for s in sides]).astype(np.float32)
    corners = np.concatenate([4 * k + np.array([[0, 1, 2], [0, 2, 3]]) for k in range(count)]).astype(np.int32)
    return TextureAtlas(uv, corners, np.arange(count).repeat(2).astype(np.int32))


def halves_taken() -> np.ndarray:
    taken = np.zeros((ATLAS_ROOM_CELLS, ATLAS_ROOM_CELLS), bool)
    taken[:, : ATLAS_ROOM_CELLS // 2] = True
    return taken


def test_charts_lie_in_the_free_half_and_not_on_each_other() -> None:
    atlas, taken = squares(9, 0.1), halves_taken()
    placed = placed_between(taken, atlas, 1.0)
    cover = np.zeros((ATLAS_ROOM_CELLS, ATLAS_ROOM_CELLS), int)
    for chart in range(9):
        own = TextureAtlas(placed.uv, placed.corners[placed.charts == chart], np.zeros(2, np.int32))
        cover += cells_of(own)
    assert not cover[taken].any() and cover.max() == 1
    assert placed.uv.min() >= 0 and placed.uv.max() <= 1


def test_charts_keep_their_shape_and_all_the_same_size() -> None:
    atlas = squares(5, 0.1)
    placed = placed_between(halves_taken(), atlas, 0.8)
    before, after = (np.linalg.norm(np.diff(a.uv[a.corners][:, :2], axis=1)[:, 0], axis=1) for a in (atlas, placed))
    assert after == pytest.approx(0.8 * before, rel=1e-4)
    first, second = (
        placed.uv[placed.corners[:, 1]] - placed.uv[placed.corners[:, 0]],
        (placed.uv[placed.corners[:, 2]] - placed.uv[placed.corners[:, 0]]),
    )
    assert (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] > 0).all(), "none is mirrored"


def test_charts_that_do_not_fit_become_smaller() -> None:
    placed = placed_between(halves_taken(), squares(4, 0.4), 2.0)
    assert 0.05 < np.ptp(placed.uv[:4, 0]) < 0.5


def test_a_full_texture_has_no_room() -> None:
    with pytest.raises(ValueError, match="no room"):
        placed_between(np.ones((ATLAS_ROOM_CELLS, ATLAS_ROOM_CELLS), bool), squares(1, 0.5), 1.0)
