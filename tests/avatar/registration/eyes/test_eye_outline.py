"""Outlines of lids, and rims between them."""

from __future__ import annotations

import numpy as np

from engine.avatar.registration.eyes.eye_outline import outline_of_landmarks, outline_of_rim, within

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
ALMOND = np.stack([10 * np.cos(TURN), 4 * np.sin(TURN)], 1)
TIP = np.array([-13.0, -0.5])


def test_an_outline_passes_through_its_rim() -> None:
    outline = outline_of_rim(ALMOND, TIP)
    above = (ALMOND[:, 1] > 0.1) & (ALMOND[:, 0] > -7)
    low, high = outline.lids(outline.share(ALMOND[above, 0]))
    assert np.allclose(high, ALMOND[above, 1])
    assert (low < high).all()
    assert outline.width == 23


def test_a_rim_stays_in_its_own_outline_and_goes_with_one_that_is_larger_and_elsewhere() -> None:
    own = outline_of_rim(ALMOND, TIP)
    assert np.allclose(within(ALMOND, own, own), ALMOND)
    moved = 2 * ALMOND + [3, 5]
    assert np.allclose(within(ALMOND, own, outline_of_rim(moved, 2 * TIP + [3, 5])), moved)


def test_an_upper_lid_that_is_lower_lowers_the_upper_rim_alone() -> None:
    own = outline_of_rim(ALMOND, TIP)
    lids = np.zeros((16, 2))
    share = np.arange(9) / 8
    low, high = own.lids(share)
    lids[:9, 0] = own.outer[0] - share * own.width
    lids[:9, 1] = high - 1.5 * np.sin(np.pi * share)
    lids[9:, 0] = lids[7:0:-1, 0]
    lids[9:, 1] = low[7:0:-1]
    found = within(ALMOND, own, outline_of_landmarks(lids)) - ALMOND
    top, bottom = np.argmax(ALMOND[:, 1]), np.argmin(ALMOND[:, 1])
    assert abs(found[top, 1] + 1.5) < 0.2
    assert abs(found[bottom, 1]) < 0.2
    assert np.abs(found[0]).max() < 1e-9
