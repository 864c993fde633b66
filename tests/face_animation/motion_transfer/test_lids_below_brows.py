"""Lids stay below brows, and below a frame that stays with the skull."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.face_animation.motion_transfer.lids_below_brows import (
    BROW_VERTICES,
    LID_COLUMNS,
    MIN_SKIN_ABOVE_LID_SHARE,
    keep_lids_below_brows,
)

FACE = placed(90, (300, 300))[None, :, :2].astype(np.float64)
ORDER = np.array(
    [
        [*column, brow]
        for lid, brows in zip(LID_COLUMNS, BROW_VERTICES, strict=True)
        for column, brow in zip(lid, brows, strict=True)
    ]
)
BARE = np.ones(478)


def _gaps(face: np.ndarray) -> np.ndarray:
    """(14, 3) upwards, from lid to brow."""
    return -np.diff(face[0, ORDER, 1], axis=1)


def test_a_face_at_rest_stays() -> None:
    face = FACE.copy()
    keep_lids_below_brows(face, FACE, BARE)
    np.testing.assert_allclose(face, FACE, atol=1e-9)


@pytest.mark.parametrize("lowered", [0.5, 1.0])
def test_where_a_brow_comes_down_on_a_raised_lid_the_lid_stops(lowered: float) -> None:
    face = FACE.copy()
    face[:, ORDER[:, -1], 1] += lowered * _gaps(FACE).sum(axis=1)
    face[:, ORDER[:, 0], 1] -= 6
    brows = face[:, ORDER[:, -1]].copy()
    keep_lids_below_brows(face, FACE, BARE)
    np.testing.assert_array_equal(face[:, ORDER[:, -1]], brows)
    least = np.minimum(MIN_SKIN_ABOVE_LID_SHARE * _gaps(FACE), _gaps(FACE))
    assert (_gaps(face) >= least - 1).all(), (
        "pixels of a face whose eyes are 90 apart: columns draw those beside them along"
    )


def test_what_does_not_move_by_itself_stays_and_the_lid_stops_below_it() -> None:
    skin, bare = ORDER[:, 1], BARE.copy()
    bare[skin] = 0
    face = FACE.copy()
    face[:, ORDER[:, 0], 1] -= 12
    keep_lids_below_brows(face, FACE, bare)
    np.testing.assert_allclose(face[:, skin], FACE[:, skin], atol=1e-6)
    assert (_gaps(face)[:, 0] >= MIN_SKIN_ABOVE_LID_SHARE * _gaps(FACE)[:, 0] - 0.5).all()


def test_a_shut_eye_stays_shut() -> None:
    face = FACE.copy()
    face[:, ORDER[:, 0], 1] += 10
    shut = face.copy()
    keep_lids_below_brows(face, FACE, BARE)
    np.testing.assert_allclose(face, shut, atol=1e-9)
