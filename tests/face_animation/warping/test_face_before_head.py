"""A face drawn before what it hides: two sheets of one picture, each where its map says."""

from __future__ import annotations

import numpy as np
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import rim_distance
from engine.face_animation.warping.face_before_head import SKIN_RIM_EYE_DISTANCES, FaceBeforeHead
from engine.imaging.composite import upsample_twice, warp_layer
from engine.imaging.warping.mesh_warp import UNCOVERED_ORIGIN_PIXELS

UNIT, SHAPE, SHIFT = 40.0, (200, 240), 12


def into_twice(shift: float) -> NDArray[np.float32]:
    """An inverse map into a picture at twice its size; it goes to the right by `shift` pixels."""
    ys, xs = np.mgrid[: SHAPE[0], : SHAPE[1]].astype(np.float32)
    return 2 * np.stack([xs - np.float32(shift), ys], axis=-1) + np.float32(0.5)


def test_the_face_is_seen_where_it_went_and_beside_it_what_stayed() -> None:
    mesh = placed(UNIT, (110.0, 90.0))
    ys, xs = np.mgrid[: SHAPE[0], : SHAPE[1]]
    picture = np.stack([xs, ys, xs // 2 + ys // 2, np.full(SHAPE, 255)], axis=-1).astype(np.uint8)
    layer = warp_layer(upsample_twice(picture), into_twice(SHIFT))
    FaceBeforeHead(mesh, SHAPE).draw(layer, upsample_twice(picture), 0, into_twice(SHIFT), into_twice(0))
    away = rim_distance(mesh, np.column_stack([(xs - SHIFT).ravel(), ys.ravel()])).reshape(SHAPE)
    inside, beside = away < -2, away > SKIN_RIM_EYE_DISTANCES * UNIT + 2
    seen = layer[..., :3].astype(int)
    assert (np.abs(seen[inside][:, 0] - (xs[inside] - SHIFT)) <= 1).all()
    assert (np.abs(seen[beside] - picture[beside][:, :3].astype(int)) <= 1).all()
    assert (layer[..., 3] == 255).all()


def test_what_is_transparent_in_both_stays_so() -> None:
    mesh = placed(UNIT, (110.0, 90.0))
    layer = np.zeros((*SHAPE, 4), np.uint8)
    clear = upsample_twice(np.dstack([np.full((*SHAPE, 3), 90, np.uint8), np.zeros(SHAPE, np.uint8)]))
    FaceBeforeHead(mesh, SHAPE).draw(layer, clear, 0, into_twice(SHIFT), into_twice(0))
    assert not layer[..., 3].any()


def test_what_the_sheet_behind_leaves_out_stays_as_it_is() -> None:
    mesh = placed(UNIT, (110.0, 90.0))
    layer = np.random.default_rng(5).integers(0, 255, (*SHAPE, 4)).astype(np.uint8)
    before, nothing = layer.copy(), np.full((*SHAPE, 2), UNCOVERED_ORIGIN_PIXELS, np.float32)
    FaceBeforeHead(mesh, SHAPE).draw(layer, upsample_twice(before), 0, into_twice(SHIFT), nothing)
    np.testing.assert_array_equal(layer, before)
