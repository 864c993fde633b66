"""The edges where a warped picture folds over itself."""

from __future__ import annotations

import numpy as np

from engine.imaging.warping.fold_edges import smooth_folds
from engine.imaging.warping.mesh_warp import inverse_map

SIZE = 40
TRIANGLES = np.array([(0, 1, 2), (1, 3, 2), (2, 3, 4), (3, 5, 4), (4, 5, 6), (5, 7, 6)], np.int32)
"""Three slanting strips side by side, from left to right."""


def _strips(*right_edges: float) -> np.ndarray:
    """(8, 2) the corners of strips whose edges stand at these places, and lean by a third."""
    return np.array([corner for x in right_edges for corner in ((x, -2.0), (x + 14.0, SIZE + 2.0))], np.float32)


def _warped(moved: np.ndarray, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The frame that the mesh makes of the picture, by its nearest pixels, and the inverse map."""
    depth = np.array([0, 0, 0, 0, 1, 1, 1, 1], np.float32)  # what the left strip does not cover the others do
    origin = inverse_map(moved, _strips(-20, 10, 30, 60), TRIANGLES, (SIZE, SIZE), depth)
    at = np.clip(origin.round().astype(int), 0, SIZE - 1)
    return picture[at[..., 1], at[..., 0]].copy(), origin


def test_nothing_changes_where_nothing_folds() -> None:
    """A strip that is squeezed to a quarter is no fold: every pixel stays."""
    picture = np.random.default_rng(1).integers(0, 256, (SIZE, SIZE, 3)).astype(np.uint8)
    moved = _strips(-20, 10, 15, 60)
    frame, origin = _warped(moved, picture)
    before = frame.copy()
    smooth_folds(frame, origin, 8.0, moved, TRIANGLES)
    assert np.array_equal(frame, before)


def test_a_fold_loses_its_steps_and_nothing_else() -> None:
    """The middle strip is turned over, so that black comes to lie beside white along a slanting line."""
    picture = np.full((SIZE, SIZE, 3), 255, np.uint8)
    picture[np.arange(SIZE)[:, None] * 14 / 44 + 20 > np.arange(SIZE)] = 0
    moved = _strips(-20, 20, 4, 60)
    frame, origin = _warped(moved, picture)
    before = frame.copy()
    smooth_folds(frame, origin, 8.0, moved, TRIANGLES)
    jumps = np.abs(np.diff(before[..., 0].astype(int), axis=1)) > 0
    assert jumps.any(axis=1).all()  # every row holds one edge from black to white
    beside = np.zeros((SIZE, SIZE), bool)
    beside[:, :-1] |= jumps
    beside[:, 1:] |= jumps
    changed = (frame != before).any(axis=2)
    assert changed[1:-1][beside[1:-1]].mean() > 0.95
    near = np.zeros_like(beside)
    near[:, 1:-1] = beside[:, 2:] | beside[:, :-2] | beside[:, 1:-1]
    assert not changed[~near].any()
    assert (np.abs(np.diff(frame[1:-1, :, 0].astype(int), axis=1)).max(axis=1) < 170).all()


def test_a_step_by_hand() -> None:
    """Beside a straight edge from 0 to 160 a pixel takes a quarter of the other side."""
    ys, xs = np.mgrid[:6, :6].astype(np.float32)
    origin = np.stack([xs + 100 * (xs > 2), ys], -1)
    frame = np.zeros((6, 6, 3), np.uint8)
    frame[:, 3:] = 160
    corners = np.array([(0, 0), (6, 0), (0, 6), (6, 6), (0, 0)], np.float32)
    folded = np.array([(0, 1, 2), (1, 3, 2), (0, 1, 2), (4, 2, 1)], np.int32)  # the last one lies face down
    smooth_folds(frame, origin, 8.0, corners, folded)
    assert frame[2, :, 0].tolist() == [0, 0, 40, 120, 160, 160]


def test_pictures_too_small_to_have_neighbours_stay() -> None:
    frame = np.full((2, 2, 3), 7, np.uint8)
    corners = np.array([(0, 0), (2, 0), (0, 2)], np.float32)
    smooth_folds(frame, np.zeros((2, 2, 2), np.float32), 1.0, corners, np.array([(0, 1, 2), (0, 2, 1)], np.int32))
    assert (frame == 7).all()
