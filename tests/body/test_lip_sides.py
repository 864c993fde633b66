"""Which skin is of which lip."""

from __future__ import annotations

import numpy as np

from engine.body.lip_sides import lip_rims, lip_sides


def test_of_two_sheets_that_touch_each_keeps_what_hangs_together_with_it() -> None:
    """Two strips of skin, a tenth of a millimetre apart, that meet at neither end."""
    along = np.arange(5) * 0.004
    strips = [np.array([[x, y, z] for x in along for z in (0, 0.004)]) for y in (0.0, -0.0001)]
    quads = np.array([[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(4)])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    upper, lower = lip_sides(
        np.concatenate(strips), np.concatenate([faces, faces + 10]), np.array([0, 1]), np.array([10, 11])
    )
    assert np.array_equal(np.flatnonzero(upper), np.arange(10))
    assert np.array_equal(np.flatnonzero(lower), np.arange(10, 20))


def test_the_rims_are_both_ways_around_a_hole_from_corner_to_corner() -> None:
    """A disc, three quarters as high as wide, whose middle is the mouth's inside."""
    turn = np.arange(12) * np.pi / 6
    ring = np.stack([np.cos(turn), 0.75 * np.sin(turn), 0 * turn], 1)
    vertices = np.concatenate([ring, 2 * ring, [[0, 0, 0]]])
    here, after = np.arange(12), (np.arange(12) + 1) % 12
    skin = np.concatenate([np.stack([here, here + 12, after + 12], 1), np.stack([here, after + 12, after], 1)])
    inside = np.stack([here, after, np.full(12, 24)], 1)
    within = np.arange(36) >= 24
    upper, lower = lip_rims(vertices, np.concatenate([skin, inside]).astype(np.int32), within)
    assert sorted(upper) == [1, 2, 3, 4, 5] and sorted(lower) == [7, 8, 9, 10, 11]
