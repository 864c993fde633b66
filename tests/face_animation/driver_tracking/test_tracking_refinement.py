"""What a second look found amiss, and how it is corrected: regressions by hand, and two looks at real faces."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_clip import OPENS
from made_face import driver as made_driver
from made_face import in_crop, opened, placed, smiling
from numpy.typing import NDArray

from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import detail_region, keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.landmark_residuals import (
    CORRECTED_SHARE,
    CORRECTED_SHARE_AT_LIPS,
    CROP_EYE_DISTANCE,
    MAX_RESIDUAL,
    REGRESSION_RIDGE,
    LandmarkResiduals,
    fit_residuals,
    no_residuals,
)
from engine.face_animation.driver_tracking.tracking_refinement import OBSERVED_FRAMES, observe_driver, refine_tracking
from engine.face_animation.motion_transfer.lids_and_lips import INNER_LIP_PAIRS, LID_PAIRS
from engine.face_animation.rig import rig_target
from engine.face_animation.warping.layers import separate_layers
from engine.media.limits import Limits
from engine.perception.face_track.face_crop import CROP_SHAPE, crop_place
from engine.perception.faces import FaceTracker
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face

REST = placed(60, (150, 150))
OPEN = opened(REST, 0.5)
FACES = np.stack([in_crop(REST)[:, :2], in_crop(OPEN)[:, :2]])
CHIN = 152


def amiss(x: float, y: float) -> NDArray[np.float64]:
    """Nothing at rest; all points off by so many eye distances when the mouth is open."""
    return np.stack([np.zeros((478, 2)), np.tile((x * CROP_EYE_DISTANCE, y * CROP_EYE_DISTANCE), (478, 1))])


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
    found = corrected(fit_residuals(FACES, amiss(10 * MAX_RESIDUAL, 0)), FACES[1], OPEN)[CHIN]
    assert found == pytest.approx((-CORRECTED_SHARE / (1 + REGRESSION_RIDGE) * 60 * MAX_RESIDUAL, 0), abs=0.02)


def test_frames_are_corrected_together_as_each_by_itself() -> None:
    rng = np.random.default_rng(3)
    residuals = fit_residuals(FACES, rng.normal(0, 0.03 * CROP_EYE_DISTANCE, (2, 478, 2)))
    placed = np.stack([REST[:, :2], OPEN[:, :2]])
    together = residuals.corrections(FACES, placed)
    for k in range(2):
        np.testing.assert_allclose(together[k], corrected(residuals, FACES[k], placed[k]), atol=1e-5)


def test_nothing_known_corrects_nothing() -> None:
    assert not corrected(no_residuals(), FACES[1], OPEN).any()


@pytest.mark.parametrize("pairs", [INNER_LIP_PAIRS, LID_PAIRS], ids=["lips", "lids"])
def test_what_is_closed_stays_closed(pairs) -> None:
    """A tracker that finds closed lips or lids apart moves both by the same; on open ones each by its own."""
    top, bottom = np.array(pairs).T
    wrong = amiss(0, 0)
    wrong[1, top, 1], wrong[1, bottom, 1] = 0.02 * CROP_EYE_DISTANCE, -0.02 * CROP_EYE_DISTANCE
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


def test_the_neutral_frame_is_glanced_at_first_and_the_others_differ(tmp_path: Path) -> None:
    meshes = [opened(REST, 0.02 * k) for k in range(60)]
    observations = observe_driver(made_driver(tmp_path, meshes), 7)
    assert observations.frames[0] == 7 and 59 in observations.frames
    assert len(set(observations.frames.tolist())) == len(observations.frames) == OBSERVED_FRAMES + 1
    assert np.isnan(observations.seen).all()  # the pictures are plain skin


def test_a_driver_that_never_moves_is_glanced_at_once(tmp_path: Path) -> None:
    assert observe_driver(made_driver(tmp_path, [REST] * 30), 4).frames.tolist() == [4]


def test_the_made_face_comes_nearer_to_the_driver_s_in_a_tracker_s_eyes(small, mouth_opens) -> None:
    """Frames that were not looked at, too: where the mouth opens, lips are nearer by a tenth, seen as the driver's are seen,
    and the face as a whole is no further off. (On much smaller pictures the tracker's scatter is as large as what is amiss.)"""
    options = PortraitOptions()
    target = find_target_face(small("photo_woman_white.png", 600), options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    rig = rig_target(target, layers)
    track = track_driver(mouth_opens, None, (OPENS[0], OPENS[0] + 2), Limits())
    track = replace(track, meshes=register_track(track, 0).meshes)
    ratios, observations = keep_ratio_images(track, 0), observe_driver(track, 0)
    residuals = refine_tracking(track, 0, observations, ratios, target, rig.details, options.acting())
    plain = FaceAnimation(RiggedTarget(target, layers, rig), RegisteredDriver(track, 0), options.acting())
    better = FaceAnimation(RiggedTarget(target, layers, rig), RegisteredDriver(track, 0, residuals), options.acting())
    meant = [plain.face(motion) for motion in plain.motions()]
    left = {}
    with FaceTracker(alone=True) as tracker:
        for name, animation in (("plain", plain), ("better", better)):
            apart = []
            for motion in animation.motions():
                frame, place = motion.frame, crop_place(meant[motion.frame])
                if frame in observations.frames[1:]:
                    continue
                picture = animation.draw(motion, ratios.ratio(frame))
                crop = cv2.warpAffine(picture, place, CROP_SHAPE[::-1], borderMode=cv2.BORDER_REPLICATE)
                ours, theirs = tracker(np.asarray(crop, np.uint8))[0], tracker(track.crop(frame))[0]
                carried = meant[frame] @ place[:, :2].T + place[:, 2]
                apart.append((ours[:, :2] - carried) - (theirs[:, :2] - track.in_crop(frame)))
            left[name] = np.linalg.norm(np.array(apart) - apart[0], axis=2).mean(axis=0)
    lips = list(LIPS_OUTER + LIPS_INNER)
    assert left["better"][lips].mean() < 0.9 * left["plain"][lips].mean()
    assert left["better"].mean() < 1.02 * left["plain"].mean()


def test_where_the_tracker_sees_no_face_nothing_is_corrected(woman_white, mouth_opens) -> None:
    """A picture whose face only its user sees, with placed landmarks."""
    options = PortraitOptions()
    target = find_target_face(woman_white, options, Limits(), lambda code, message: None)
    target = replace(target, rgb=np.full_like(target.rgb, 128))
    track = track_driver(mouth_opens, None, (OPENS[0], OPENS[0] + 0.3), Limits())
    given = track, 0, observe_driver(track, 0), keep_ratio_images(track, 0)
    assert len(refine_tracking(*given, target, detail_region(target.rgb, target.mesh), options.acting()).faces) == 0
