"""Feet are told from a floor that has their colours in places."""

import numpy as np

from engine.avatar.capture.foot_masks import feet_of, told_from_floor
from engine.avatar.landmarks.spatial import SpatialLandmarks
from tests.avatar.capture.standing_scene import FOOT, filmed

BODY = dict(zip(("LeftAnkle", "LeftHeel", "LeftFootIndex"), FOOT.corners, strict=True)) | {
    "LeftKnee": [0.0, 0.5, -0.07]
}


def test_a_dark_shoe_that_networks_lost_is_told_from_a_floor_with_dark_tiles() -> None:
    shown = [filmed(turn, 0.003, seed) for seed, turn in enumerate(np.arange(16) * np.pi / 8)]
    masks = told_from_floor([frame for frame, _ in shown], feet_of(SpatialLandmarks(BODY)))
    for (frame, true), mask in zip(shown, masks, strict=True):
        y = np.indices(mask.shape)[0]
        low = frame.person.project(FOOT.corners)[:, 1].min()  # above, the leg leaves what is looked at
        own, found = true[y > low], mask[y > low]
        assert (own & found).sum() / (own | found).sum() > 0.93


def test_without_landmarks_of_feet_masks_stay() -> None:
    frame, _ = filmed(1.0)
    lacking = {name: place for name, place in BODY.items() if name != "LeftHeel"}
    assert feet_of(SpatialLandmarks(lacking)) == []
    (mask,) = told_from_floor([frame], [])
    assert np.array_equal(mask, frame.mask)
