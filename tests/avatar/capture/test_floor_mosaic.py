"""The floor is known from frames that show it, also where a foot hides it in others."""

import numpy as np

from engine.avatar.capture.floor_mosaic import MOSAIC_SPACING_METRES, FloorView, floor_mosaic
from tests.avatar.capture.standing_scene import FOOT, filmed, floor_colours

TURNS = np.arange(16) * np.pi / 8


def test_the_floor_has_its_colours_and_height_and_nothing_beneath_a_foot() -> None:
    frames = [filmed(turn, 0.006, seed) for seed, turn in enumerate(TURNS)]
    floor = floor_mosaic([FloorView(frame.image, true, frame.room) for frame, true in frames], FOOT.corners)
    assert floor is not None
    assert abs(floor.height - 0.006) <= 0.003
    rows, columns = np.indices(floor.colours.shape[:2])
    x, z = floor.corner[0] + MOSAIC_SPACING_METRES * columns, floor.corner[1] + MOSAIC_SPACING_METRES * rows
    beneath = (np.abs(x) < 0.03) & (np.abs(z) < 0.1)
    assert np.isnan(floor.colours[beneath]).all()
    beside = (np.abs(x) < 0.2) & (np.abs(z) < 0.2) & ~((np.abs(x) < 0.07) & (np.abs(z) < 0.15))
    known = np.isfinite(floor.colours[beside, 0])
    assert known.mean() > 0.95
    off = np.abs(floor.colours[beside][known] - floor_colours(x, z)[beside][known])
    assert np.median(off) < 8
    gains = floor.gains / np.array([1 + 0.1 * np.sin(5 * turn) for turn in TURNS])[:, None]
    assert np.ptp(gains) / gains.mean() < 0.08


def test_frames_that_show_no_floor_give_none() -> None:
    frame, _ = filmed(0.3)
    everywhere = np.ones(frame.mask.shape, np.bool_)
    assert floor_mosaic([FloorView(frame.image, everywhere, frame.room)] * 4, FOOT.corners) is None
