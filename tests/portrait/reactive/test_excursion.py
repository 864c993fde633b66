"""Performances made to begin and to end in the target at rest."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_motion import ControlMotion
from engine.portrait.reactive.excursion import LEAD_FRAMES, SETTLE_SECONDS, Pose, excursion

FPS = 20.0
REST = np.linspace(-5, 5, 4, dtype=np.float32)
"""Depth of four control points at rest."""


def motion(frame: int, far: float) -> ControlMotion:
    """All that moves is moved by `far`."""
    offsets = np.full((4, 2), far, np.float32)
    return ControlMotion(frame, offsets, REST + np.float32(far), np.full((2, 2), far, np.float32), offsets)


def is_at_rest(pose: Pose) -> bool:
    moved = (pose.motion.offsets, pose.motion.look, pose.motion.behind, pose.motion.depth - REST)
    return pose.creases == 0 and not any(one.any() for one in moved)


def offsets(poses: tuple[Pose, ...]) -> NDArray[np.float32]:
    return np.array([pose.motion.offsets[0, 0] for pose in poses])


def test_it_begins_and_ends_at_rest_and_is_what_it_was_in_between() -> None:
    acted = [motion(frame, 8.0) for frame in range(40)]
    poses = excursion(acted, REST, FPS, loops=False)
    assert is_at_rest(poses[0]) and is_at_rest(poses[-1])
    whole = slice(LEAD_FRAMES, len(poses) - 1 - round(SETTLE_SECONDS * FPS))
    np.testing.assert_array_equal(offsets(poses)[whole], 8.0)
    assert [pose.creases for pose in poses][whole] == [1.0] * len(poses[whole])
    assert (np.diff(offsets(poses)[: LEAD_FRAMES + 1]) > 0).all() and (np.diff(offsets(poses)[whole.stop :]) < 0).all()


@pytest.mark.parametrize("waiting", [0, 12])
def test_waiting_at_both_ends_is_left_out_but_for_room_to_set_out(waiting: int) -> None:
    far = [0.1] * waiting + [8.0] * 20 + [0.1] * waiting
    poses = excursion([motion(frame, one) for frame, one in enumerate(far)], REST, FPS, loops=False)
    assert len(poses) == 20 + 2 * min(waiting, LEAD_FRAMES)
    assert poses[0].motion.frame == max(waiting - LEAD_FRAMES, 0)


def test_one_that_loops_is_kept_whole_and_its_end_leads_into_its_beginning() -> None:
    far = [0.1] * 10 + [8.0] * 20 + [0.1] * 10
    poses = excursion([motion(frame, one) for frame, one in enumerate(far)], REST, FPS, loops=True)
    assert [pose.motion.frame for pose in poses] == list(range(40))
    assert is_at_rest(poses[0])
    once = offsets(excursion([motion(frame, 8.0) for frame in range(40)], REST, FPS, loops=True))
    np.testing.assert_allclose(once[1:], once[:0:-1], rtol=1e-6, err_msg="it goes to rest as it came from there")
    assert 0 < once[-1] < 8.0
