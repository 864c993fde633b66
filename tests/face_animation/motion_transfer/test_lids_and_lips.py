"""Closed on the driver is closed on the target, open as it was is open as it was, and lips never cross."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed, shut, smiling
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import (
    INNER_LIP_PAIRS,
    LID_EDGE_VERTEX_PAIRS,
    LID_SKIN_VERTEX_PAIRS,
    MAX_GAP_IRIS_DIAMETERS,
    MAX_GAP_RATIO,
    MIN_GAP_LIMIT,
    constrain_lids_and_lips,
    gap_limits,
    lid_ratio,
    open_lids,
)
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.perception.face.landmarks import eye_opening

UPPER, LOWER = np.array(LID_EDGE_VERTEX_PAIRS).T
LEFT_LIDS = [*UPPER[7:], *LOWER[7:]]
TOP, BOTTOM = np.array(INNER_LIP_PAIRS).T
BARE = np.ones(478)


@pytest.fixture(scope="module")
def target() -> NDArray[np.float32]:
    """Wider eyes than the driver's."""
    mesh = placed(90, (300, 200), roll=7)
    return shut(mesh, 1.3)


@pytest.fixture(scope="module")
def driver() -> NDArray[np.float32]:
    return placed(50, (120, 100))


def gap(mesh: NDArray) -> NDArray:
    return np.linalg.norm(mesh[..., UPPER, :] - mesh[..., LOWER, :], axis=-1)


def test_pairs_face_each_other() -> None:
    face, mirror = canonical_face(), mirror_vertices()
    assert (face[LOWER, 1] > face[UPPER, 1]).all() and (face[BOTTOM, 1] >= face[TOP, 1]).all()
    assert np.abs(face[LOWER, 0] - face[UPPER, 0]).max() < 0.04
    assert mirror[UPPER[:7]].tolist() == UPPER[7:].tolist() and mirror[LOWER[:7]].tolist() == LOWER[7:].tolist()
    assert mirror[TOP].tolist() == TOP[::-1].tolist()


def test_the_neutral_frame_has_ratio_one(driver: NDArray) -> None:
    np.testing.assert_allclose(lid_ratio(driver[None], driver), 1)


@pytest.mark.parametrize("left_over", [0.0, 0.1, 0.25])
def test_a_shut_eye_has_ratio_nought(driver: NDArray, left_over: float) -> None:
    """Also where the tracker sees a slit, as it always does."""
    np.testing.assert_array_equal(lid_ratio(shut(driver, left_over)[None], driver), 0)


def test_ratios_grow_with_the_gap_and_have_a_limit(driver: NDArray) -> None:
    shares = np.linspace(0, 2, 41)
    ratio = lid_ratio(np.stack([shut(driver, s) for s in shares]), driver)
    assert (np.diff(ratio, axis=0) >= 0).all()
    open_eyes = (shares > 0.6) & (shares < MAX_GAP_RATIO)
    np.testing.assert_allclose(ratio[open_eyes], np.repeat(shares[open_eyes, None], 14, axis=1), rtol=1e-3)
    assert ratio.max() == pytest.approx(MAX_GAP_RATIO)


def test_each_eye_is_its_own(driver: NDArray) -> None:
    wink = driver.copy()
    wink[UPPER[:7]] = shut(driver, 0.0)[UPPER[:7]]
    ratio = lid_ratio(wink[None], driver)[0]
    np.testing.assert_allclose(ratio[:7], 0)
    np.testing.assert_allclose(ratio[7:], 1)


def both_eyes(driver: NDArray, right: float, left: float) -> NDArray:
    """The driver with its eyes open by these shares."""
    face, other = shut(driver, right), shut(driver, left)
    face[LEFT_LIDS] = other[LEFT_LIDS]
    return face


@pytest.mark.parametrize(("right", "left"), [(0.62, 0.42), (0.42, 0.62), (0.45, 0.38), (1.0, 0.85), (1.1, 1.3)])
def test_eyes_that_open_and_close_together_do_so_alike(driver: NDArray, right: float, left: float) -> None:
    ratio = lid_ratio(both_eyes(driver, right, left)[None], driver)[0]
    np.testing.assert_allclose(ratio[:7], ratio[7:], atol=0.02)


@pytest.mark.parametrize(("right", "left"), [(1.0, 0.1), (0.15, 0.9), (1.2, 0.65), (0.15, 0.65)])
def test_a_wink_and_eyes_that_are_far_from_alike_stay_so(driver: NDArray, right: float, left: float) -> None:
    ratio = lid_ratio(both_eyes(driver, right, left)[None], driver)[0]
    for eye, share in ((ratio[:7], right), (ratio[7:], left)):
        np.testing.assert_allclose(eye, share if share > 0.6 else 0, atol=0.02)


def test_a_closed_driver_closes_the_target(driver: NDArray, target: NDArray) -> None:
    """Whatever offsets were carried over, and however much larger the target's eyes are: the gap is nought."""
    carried = (shut(driver, 0.15) - driver) * 1.1
    out = constrain_lids_and_lips((target + carried)[None], target, lid_ratio(shut(driver, 0.15)[None], driver), BARE)
    assert gap(out).max() < 1e-6
    assert eye_opening(out[0]).max() < 1e-6


def test_at_rest_nothing_changes(target: NDArray) -> None:
    out = constrain_lids_and_lips(target[None], target, np.ones((1, 14)), BARE)
    np.testing.assert_allclose(out[0], target, atol=1e-4)


def test_an_open_eye_keeps_its_own_gap_wherever_the_face_goes(target: NDArray) -> None:
    """Ratio 1 and an expression that shifts lids and brows: the gap is the target's own."""
    moved = smiling(target, 0.1) + np.array([3.0, -5.0, 0.0], np.float32)
    out = constrain_lids_and_lips(moved[None], target, np.ones((1, 14)), BARE)
    np.testing.assert_allclose(gap(out)[0], gap(target), atol=1e-3)


@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.4])
def test_gaps_are_carried_as_ratios(target: NDArray, ratio: float) -> None:
    out = constrain_lids_and_lips(target[None], target, np.full((1, 14), ratio), BARE)
    np.testing.assert_allclose(gap(out)[0], ratio * gap(target), rtol=1e-4)


def test_a_closing_lid_moves_and_the_lower_one_stays(target: NDArray) -> None:
    out = constrain_lids_and_lips(target[None], target, np.zeros((1, 14)), BARE)[0]
    np.testing.assert_allclose(out[LOWER], target[LOWER], atol=1e-4)
    below = out[UPPER] - target[UPPER]
    down = (target[152] - target[10]) / np.linalg.norm(target[152] - target[10])
    assert (below @ down > 0).all()


def test_lid_skin_follows_between_lid_and_brow(target: NDArray) -> None:
    from engine.face_animation.motion_transfer.lids_and_lips import LID_SKIN_VERTEX_PAIRS

    skin, edge = np.array(LID_SKIN_VERTEX_PAIRS).T
    out = constrain_lids_and_lips(target[None], target, np.zeros((1, 14)), BARE)[0]
    way = np.linalg.norm((out - target)[skin], axis=1) / np.linalg.norm((out - target)[edge], axis=1)
    np.testing.assert_allclose(way, 0.5, atol=1e-4)
    brows = [70, 63, 105, 66, 107, 336, 296, 334, 293, 300]
    np.testing.assert_allclose(out[brows], target[brows], atol=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_lips_never_cross(target: NDArray, seed: int) -> None:
    """Random offsets as large as the lips are thick: the lower lip is never above the upper one."""
    rng = np.random.default_rng(seed)
    positions = target + rng.normal(0, 15, (4, *target.shape)).astype(np.float32)
    out = constrain_lids_and_lips(positions, target, np.ones((4, 14)), BARE)
    down = (target[152] - target[10]) / np.linalg.norm(target[152] - target[10])
    assert ((out[:, BOTTOM] - out[:, TOP]) @ down).min() > -1e-4


def test_lips_that_do_not_cross_are_left_alone(target: NDArray) -> None:
    wide = opened(target, 0.3)
    out = constrain_lids_and_lips(wide[None], target, np.ones((1, 14)), BARE)[0]
    np.testing.assert_allclose(out[TOP], wide[TOP], atol=1e-4)
    np.testing.assert_allclose(out[BOTTOM], wide[BOTTOM], atol=1e-4)


def test_crossing_lips_meet_half_way(target: NDArray) -> None:
    crossed = target.copy()
    down = (target[152] - target[10]) / np.linalg.norm(target[152] - target[10])
    crossed[TOP] = target[TOP] + 10 * down
    crossed[BOTTOM] = target[TOP] + 4 * down
    out = constrain_lids_and_lips(crossed[None], target, np.ones((1, 14)), BARE)[0]
    np.testing.assert_allclose(out[TOP], target[TOP] + 7 * down, atol=1e-3)
    np.testing.assert_allclose(out[BOTTOM], out[TOP], atol=1e-3)


def test_what_is_left_of_wide_eyes_is_no_squint_of_narrower_ones(driver: NDArray) -> None:
    wide, calm, squint, closed = (shut(driver, share) for share in (1.3, 1.0, 0.8, 0.05))
    frames = np.stack([wide, calm, squint, closed])
    same_person, narrower = (lid_ratio(frames, wide, target)[:, [3, 10]] for target in (wide, calm))
    np.testing.assert_allclose(same_person, lid_ratio(frames, wide)[:, [3, 10]], atol=0.02)
    np.testing.assert_allclose(narrower[0], same_person[0])
    np.testing.assert_allclose(narrower[1], 1, rtol=0.02)  # as open as the driver's are
    assert (narrower[2] > same_person[2]).all() and (narrower[2] < 0.85).all()
    assert not narrower[3].any()


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.6, 1.0, 1.2])
def test_lids_are_as_far_open_as_they_are_told_wherever_the_face_ended_up(target: NDArray, ratio: float) -> None:
    """Points that something parted are put together in a shut eye, and those that it raised in one eye and lowered in the other are alike."""
    rigid = target[None, :, :2] + np.array([20.0, -8.0])
    parted = rigid + np.random.default_rng(4).normal(scale=2.0, size=rigid.shape)
    placed = parted.copy()
    open_lids(placed, rigid, np.full((1, 14), ratio))
    np.testing.assert_allclose(gap(placed), ratio * gap(rigid), atol=1e-6)
    rest = np.setdiff1d(np.arange(478), UPPER)
    np.testing.assert_array_equal(placed[:, rest], parted[:, rest])


def test_an_eye_opens_as_far_as_its_iris_is_high(target: NDArray) -> None:
    iris = 2 * np.linalg.norm(target[469:473] - target[468], axis=1).mean()
    for share, limit in ((1.0, MAX_GAP_IRIS_DIAMETERS), (0.05, None), (3.0, None)):
        eyes = shut(target, share * iris / gap(target)[2:5].mean())
        found = gap_limits(eyes)[0]
        if limit is not None:
            assert found == pytest.approx(max(limit, MIN_GAP_LIMIT), abs=0.02)
        else:
            assert found == (MAX_GAP_RATIO if share < 1 else MIN_GAP_LIMIT)


def test_skin_behind_a_frame_does_not_go_with_its_lid(target: NDArray) -> None:
    skin = np.array(LID_SKIN_VERTEX_PAIRS)[:, 0]
    bare = BARE.copy()
    bare[skin] = 0
    half = np.full((1, 14), 0.5)
    out = constrain_lids_and_lips(target[None], target, half, bare)[0]
    np.testing.assert_array_equal(out[skin], target[skin])
    assert np.abs(constrain_lids_and_lips(target[None], target, half, BARE)[0][skin] - target[skin]).max() > 1
