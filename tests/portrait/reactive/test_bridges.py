"""Bridges of a clip: where they lie in their file, and that they end at rest."""

from __future__ import annotations

import numpy as np
import pytest

from engine.face_animation.motion_transfer.control_motion import ControlMotion
from engine.portrait.reactive.bridges import (
    HOLD_FRAMES,
    MAX_BRIDGE_FRAMES,
    MAX_FRAMES_PER_KEYFRAME,
    MIN_BRIDGE_FRAMES,
    BridgeSegment,
    ExitBridges,
    bridge,
    ease_in_out,
)
from engine.portrait.reactive.excursion import Pose


@pytest.mark.parametrize("seed", range(20))
def test_bridges_lie_one_after_another_and_none_goes_on_beyond_what_one_whole_picture_may_carry(seed: int) -> None:
    lengths = np.random.default_rng(seed).integers(MIN_BRIDGE_FRAMES, MAX_BRIDGE_FRAMES + 1, 30).tolist()
    segments = ExitBridges(tuple(range(30)), tuple(lengths), ()).segments()
    assert [one.length for one in segments] == lengths
    assert segments[0].opens and segments[0].start == 1, "a whole picture comes first"
    since = 0
    for one, following in zip(segments, [*segments[1:], None], strict=True):
        since = (0 if one.opens else since) + one.length + HOLD_FRAMES
        assert since <= MAX_FRAMES_PER_KEYFRAME
        if following is not None:
            assert following.start == one.start + one.length + HOLD_FRAMES + following.opens
            room = MAX_FRAMES_PER_KEYFRAME - since
            assert following.opens == (room < following.length + HOLD_FRAMES), "no more whole pictures than it takes"


@pytest.mark.parametrize("opens", [False, True])
def test_a_bridge_leads_evenly_to_rest_and_stays(opens: bool) -> None:
    offsets = np.full((3, 2), 12.0, np.float32)
    pose = Pose(ControlMotion(0, offsets, np.ones(3, np.float32), np.ones((2, 2), np.float32), offsets))
    frames = list(bridge(pose, BridgeSegment(0, 9, opens), np.zeros(3, np.float32)))
    far = [float(one.motion.offsets[0, 0]) for one in frames]
    assert len(frames) == opens + 9 + HOLD_FRAMES
    assert far[-HOLD_FRAMES:] == [0.0] * HOLD_FRAMES and (not opens or far[0] == 0)
    steps = np.diff([12.0, *far[opens : opens + 9], 0.0])
    assert (steps < 0).all() and np.abs(steps).max() < 2 * 12.0 / 10


def test_easing_goes_from_nought_to_one_as_much_before_the_middle_as_after() -> None:
    t = np.linspace(0, 1, 101)
    way = ease_in_out(t)
    assert (way[0], way[50], way[-1]) == pytest.approx((0, 0.5, 1))
    np.testing.assert_allclose(way, 1 - way[::-1], atol=1e-12)
    assert (np.diff(way) > 0).all()
