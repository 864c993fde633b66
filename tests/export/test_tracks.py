"""Keyframes and weights, small enough to check by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from engine.export.animation_tracks import SINGLE_FRAME_SECONDS, closing_root, tracks
from engine.export.influences import FULL_INFLUENCE, quantise_influences
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip

BONE = Skeleton(("Hips",), np.array([-1], np.int32), np.zeros((1, 3), np.float32))


def test_rotations_take_the_short_way_and_stay_what_they_are() -> None:
    rng = np.random.default_rng(0)
    turning = Rotation.from_euler("y", np.linspace(0, 4 * np.pi, 40)[:, None]).as_quat()[:, None]
    signs = rng.choice([-1, 1], (40, 1, 1))
    clip = Clip("spin", 30, (turning * signs).astype(np.float32), np.zeros((40, 3), np.float32))
    found = tracks(clip, BONE).rotations
    assert ((found[1:] * found[:-1]).sum(-1) > 0).all()
    np.testing.assert_allclose(np.abs((found * turning).sum(-1)), 1, atol=1e-6)


def test_a_loop_is_closed_and_a_single_frame_held() -> None:
    turn = Rotation.from_euler("x", [[0.0], [0.3], [0.1]]).as_quat()[:, None].astype(np.float32)
    closed = tracks(Clip("nod", 10, turn, np.zeros((3, 3), np.float32), loops=True), BONE)
    np.testing.assert_allclose(closed.times, [0, 0.1, 0.2, 0.3])
    np.testing.assert_array_equal(closed.rotations[3], closed.rotations[0])
    held = tracks(Clip("still", 10, turn[1:2], np.ones((1, 3), np.float32)), BONE)
    np.testing.assert_allclose(held.times, [0, SINGLE_FRAME_SECONDS])
    assert held.turning.all() and not held.moving.any()


def swaying(root: np.ndarray) -> Clip:
    return Clip("sway", 24, np.tile(np.array([0, 0, 0, 1], np.float32), (len(root), 1, 1)), root, loops=True)


def test_what_a_loop_travels_is_told_from_how_it_sways() -> None:
    phase = 2 * np.pi * np.arange(24) / 24
    sway = np.stack([0.05 * np.sin(phase), 0.02 * np.cos(2 * phase), 0.03 * np.cos(phase)], 1)
    np.testing.assert_allclose(closing_root(swaying(sway)), sway[0])
    forward = sway + np.outer(np.arange(24) / 24, [0, 0, 1.4])
    np.testing.assert_allclose(closing_root(swaying(forward)), sway[0] + [0, 0, 1.4], atol=2e-3)


def test_no_loop_travels_off_the_ground() -> None:
    """Who climbs through a loop is down again where it begins anew."""
    climbing = np.outer(np.arange(24) / 24, [0, 1.5, 1.4]).astype(np.float32)
    np.testing.assert_allclose(closing_root(swaying(climbing)), [0, 0, 1.4], atol=1e-5)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 5), st.floats(0, 1)), min_size=4, max_size=4).filter(
        lambda row: sum(weight for _, weight in row) > 0.01
    )
)
def test_whole_weights_sum_to_one_and_name_no_joint_twice(row: list[tuple[int, float]]) -> None:
    bones, weights = np.array([[joint for joint, _ in row]]), np.array([[weight for _, weight in row]])
    joints, whole = quantise_influences(bones, weights)
    used = joints[0][whole[0] > 0]
    assert whole.sum() == FULL_INFLUENCE and len(set(used)) == len(used) and (np.diff(whole[0].astype(int)) <= 0).all()
    assert not joints[0][whole[0] == 0].any()
    for joint in range(6):
        exact = weights[bones == joint].sum() / weights.sum()
        assert abs(whole[joints == joint].sum() / FULL_INFLUENCE - exact) <= 3 / FULL_INFLUENCE


def test_a_vertex_without_weight_is_refused() -> None:
    with pytest.raises(ValueError, match="no joint"):
        quantise_influences(np.zeros((1, 4), int), np.zeros((1, 4)))
