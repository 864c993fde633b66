"""What is found amiss with landmarks, and how it is corrected: regressions by hand."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import in_crop, opened, placed, smiling
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.landmark_residuals import (
    CORRECTED_SHARE,
    CORRECTED_SHARE_AT_LIPS,
    MAX_RESIDUAL_EYE_DISTANCES,
    REGRESSION_RIDGE,
    LandmarkResiduals,
    fit_residuals,
    no_residuals,
)
from engine.face_animation.motion_transfer.lids_and_lips import INNER_LIP_PAIRS, LID_EDGE_VERTEX_PAIRS
from engine.perception.face_track.face_crop import CROP_EYE_DISTANCE_PIXELS

REST = placed(60, (150, 150))
OPEN = opened(REST, 0.5)
FACES = np.stack([in_crop(REST)[:, :2], in_crop(OPEN)[:, :2]])
CHIN = 152


def amiss(x: float, y: float) -> NDArray[np.float64]:
    """Nothing at rest; all points off by so many eye distances when the mouth is open."""
    return np.stack(
        [np.zeros((478, 2)), np.tile((x * CROP_EYE_DISTANCE_PIXELS, y * CROP_EYE_DISTANCE_PIXELS), (478, 1))]
    )


def corrected(residuals: LandmarkResiduals, face: NDArray, placed: NDArray) -> NDArray[np.float32]:
    """The correction of one frame, (478, 2)."""
    return residuals.corrections(face[None], placed[None, :, :2])[0]


def test_a_frame_that_was_looked_at_loses_its_share_of_what_was_amiss() -> None:
    """The two faces are far apart, so that each weight is what was amiss over 1 + the ridge."""
    residuals = fit_residuals(FACES, amiss(0.02, -0.01))
    found = corrected(residuals, FACES[1], OPEN)[CHIN]
    assert found == pytest.approx(-CORRECTED_SHARE / (1 + REGRESSION_RIDGE) * 60 * np.array([0.02, -0.01]), abs=0.02)
    assert np.abs(corrected(residuals, FACES[0], REST)).max() < 0.02


def test_a_face_unlike_all_is_left_alone() -> None:
    other = smiling(placed(60, (150, 150), yaw=25), 0.4)
    assert np.abs(corrected(fit_residuals(FACES, amiss(0.05, 0)), in_crop(other)[:, :2], other)).max() < 0.05


def test_corrections_are_upright_and_as_large_as_the_face() -> None:
    """On a head that lies on its side and is twice as large, right is down, and twice as far."""
    residuals = fit_residuals(FACES, amiss(0.02, 0))
    one = corrected(residuals, FACES[1], OPEN)
    lying = opened(placed(120, (150, 150)), 0.5)[:, :2] @ np.array([[0, 1], [-1, 0]])
    two = corrected(residuals, FACES[1], lying)
    np.testing.assert_allclose(two[CHIN], 2 * one[CHIN] @ np.array([[0, 1], [-1, 0]]), atol=1e-4)


def test_no_more_is_believed_than_a_tracker_can_tell() -> None:
    found = corrected(fit_residuals(FACES, amiss(10 * MAX_RESIDUAL_EYE_DISTANCES, 0)), FACES[1], OPEN)[CHIN]
    assert found == pytest.approx(
        (-CORRECTED_SHARE / (1 + REGRESSION_RIDGE) * 60 * MAX_RESIDUAL_EYE_DISTANCES, 0), abs=0.02
    )


def test_frames_are_corrected_together_as_each_by_itself() -> None:
    rng = np.random.default_rng(3)
    residuals = fit_residuals(FACES, rng.normal(0, 0.03 * CROP_EYE_DISTANCE_PIXELS, (2, 478, 2)))
    placed = np.stack([REST[:, :2], OPEN[:, :2]])
    together = residuals.corrections(FACES, placed)
    for k in range(2):
        np.testing.assert_allclose(together[k], corrected(residuals, FACES[k], placed[k]), atol=1e-5)


def test_nothing_known_corrects_nothing() -> None:
    assert not corrected(no_residuals(), FACES[1], OPEN).any()


@pytest.mark.parametrize("pairs", [INNER_LIP_PAIRS, LID_EDGE_VERTEX_PAIRS], ids=["lips", "lids"])
def test_what_is_closed_stays_closed(pairs) -> None:
    """A tracker that finds closed lips or lids apart moves both by the same; on open ones each by its own."""
    top, bottom = np.array(pairs).T
    wrong = amiss(0, 0)
    wrong[1, top, 1], wrong[1, bottom, 1] = 0.02 * CROP_EYE_DISTANCE_PIXELS, -0.02 * CROP_EYE_DISTANCE_PIXELS
    residuals = fit_residuals(FACES, wrong)
    closed = REST.copy()
    closed[bottom] = closed[top]
    still = corrected(residuals, FACES[1], closed)
    np.testing.assert_allclose(still[top], still[bottom], atol=1e-6)
    moved = corrected(residuals, FACES[1], OPEN)
    middle = len(top) // 2 if pairs is INNER_LIP_PAIRS else 3
    share = CORRECTED_SHARE_AT_LIPS if pairs is INNER_LIP_PAIRS else CORRECTED_SHARE
    assert (moved[bottom[middle]] - moved[top[middle]])[1] == pytest.approx(
        2 * share / (1 + REGRESSION_RIDGE) * 1.2, abs=0.1
    )
