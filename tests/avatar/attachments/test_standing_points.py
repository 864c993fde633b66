"""Which points of a cloud are of what stands off: its own, and what it covers."""

from __future__ import annotations

import numpy as np

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.standing_off import StandingPiece, points_standing_off

SIDE = 41


def test_points_on_the_skin_are_of_the_piece_that_covers_it_there() -> None:
    """A flat skin, a brim 2 cm before it whose crown covers the right half, and points 5 mm before the skin."""
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    skin = np.stack([x - SIDE // 2, y - SIDE // 2, 0 * x], 1) * 0.005
    corner = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)[:-1, :-1].ravel()
    triangles = np.concatenate([corner[:, None] + [0, 1, SIDE], corner[:, None] + [1, SIDE + 1, SIDE]]).astype(np.int32)
    nowhere = np.zeros(len(skin), np.bool_)
    body = BodySurface(skin, triangles, nowhere, nowhere, nowhere)
    brim = StandingPiece(skin[np.abs(skin[:, 1]) < 0.004] + [0, 0, 0.02], covered=skin[:, 0] > 0)
    own, covered, bare, far, within = (
        [-0.03, 0.0, 0.02],
        [0.03, 0.0, 0.005],
        [-0.03, 0.0, 0.005],
        [0.03, 0.08, 0.005],
        [0.03, 0.0, -0.021],
    )
    found = points_standing_off(np.array([own, covered, bare, far, within]), body, [brim])
    np.testing.assert_array_equal(found, [own, covered])
    assert len(points_standing_off(np.array([own, covered]), body, [])) == 0
