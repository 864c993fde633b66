"""Eyes whose iris is not to be seen any more are shut, whatever the tracker says."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import driver, in_crop, painted, placed, shut
from numpy.typing import NDArray

from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.unseen_blinks import eye_contrast, shut_by_contrast
from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS, LID_SKIN_VERTEX_PAIRS, lid_ratio
from engine.media.excerpt import Excerpt
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE
from engine.perception.face_track.face_crop import CROP_EYES, CROP_SHAPE

FACE = placed(70, (100, 100))
OPEN = painted(in_crop(FACE), CROP_SHAPE[::-1])
SHUT = painted(in_crop(shut(FACE)), CROP_SHAPE[::-1])
HALF = CROP_SHAPE[1] // 2


def ratios(folder: Path, pictures: list[NDArray[np.uint8]]) -> NDArray[np.float64]:
    """(N, 2) how far the eyes are open at last, of a tracker that saw them open in all frames."""
    track = driver(folder, [FACE] * len(pictures), pictures)
    return lid_ratio(register_track(track, 0).meshes, FACE)[:, [3, 10]]


def test_an_eye_is_shut_where_its_lid_is_seen_each_by_itself(tmp_path: Path) -> None:
    wink = OPEN.copy()
    wink[:, :HALF] = SHUT[:, :HALF]
    seen = ratios(tmp_path, [OPEN, SHUT, SHUT, SHUT, wink, OPEN])
    np.testing.assert_allclose(seen, [[1, 1], [0, 0], [0, 0], [0, 0], [0, 1], [1, 1]], atol=1e-6)


def test_what_is_gone_for_a_moment_is_no_blink(tmp_path: Path) -> None:
    """A frame blurred by motion, or a reflection in glasses: shorter than any blink, however often it comes."""
    pictures = [OPEN, SHUT, OPEN, SHUT, SHUT, OPEN, SHUT]
    np.testing.assert_allclose(ratios(tmp_path, pictures), 1, atol=1e-6)
    blink = ratios(tmp_path, [OPEN, SHUT, SHUT, SHUT, OPEN, SHUT, OPEN])
    np.testing.assert_allclose(blink[:, 0], [1, 0, 0, 0, 1, 1, 1], atol=1e-6)


def test_an_eye_behind_a_reflection_stays_open_beside_an_open_one() -> None:
    """Half of the contrast of both eyes is gone: they are shut. Of one alone: one glass of spectacles mirrors a lamp."""
    veiled, gone = np.full((9, 2, 2), 0.3), np.full((9, 2, 2), 0.3)
    veiled[3:6, 1] = 0.15
    gone[3:6] = 0.15
    for contrast, open_by in ((veiled, [1, 1]), (gone, [0, 0])):
        meshes = np.repeat(FACE[None], 9, axis=0).copy()
        shut_by_contrast(meshes, contrast, 0, 25.0)
        np.testing.assert_allclose(lid_ratio(meshes, FACE)[4, [3, 10]], open_by, atol=1e-6)


def test_the_light_is_not_the_eye_s(tmp_path: Path) -> None:
    dim, warm = (OPEN * 0.6).astype(np.uint8), np.clip(OPEN * (1.2, 1.0, 0.8), 0, 255).astype(np.uint8)
    np.testing.assert_allclose(ratios(tmp_path, [OPEN, dim, warm]), 1, atol=1e-6)


def test_eyes_that_are_shut_in_the_neutral_frame_tell_nothing(tmp_path: Path) -> None:
    """Dark lashes are no iris."""
    lashes = SHUT.copy()
    for eye in (RIGHT_EYE, LEFT_EYE):
        cv2.fillPoly(lashes, [np.round(in_crop(FACE)[list(eye), :2]).astype(np.int32)], (60, 40, 25))
    track = driver(tmp_path, [shut(FACE, 0.3), FACE], [lashes, SHUT])
    np.testing.assert_array_equal(register_track(track, 0).meshes[1, list(LEFT_EYE)], FACE[list(LEFT_EYE)])


def test_eyes_that_never_had_contrast_are_left_to_the_tracker(tmp_path: Path) -> None:
    np.testing.assert_allclose(ratios(tmp_path, [SHUT, SHUT, OPEN]), 1, atol=1e-6)


def test_the_contrast_of_an_eye_by_hand() -> None:
    """Openings of 60 in skin of 200 and 100: 1 - 60/200, 1 - 60/100. Of a ramp of 2 a pixel: 2 by the skin's 200."""
    grey, face = np.full(CROP_SHAPE, 200, np.uint8), in_crop(FACE)[:, :2]
    grey[:, HALF:] = 100
    for eye in (RIGHT_EYE, LEFT_EYE):
        cv2.fillPoly(grey, [np.round(face[list(eye)]).astype(np.int32)], 60)
    assert eye_contrast(grey, face, face)[:, 0] == pytest.approx([0.7, 0.4], abs=0.03)
    ramp = np.tile(np.clip(200 + 2 * (np.arange(CROP_SHAPE[1]) - CROP_EYES[0][0]), 0, 255), (CROP_SHAPE[0], 1)).astype(
        np.uint8
    )
    assert eye_contrast(ramp, face, face)[0, 1] == pytest.approx(0.01, rel=0.05)


def test_an_eye_out_of_sight_has_no_contrast() -> None:
    face = in_crop(FACE)[:, :2]
    assert not eye_contrast(np.full(CROP_SHAPE, 100, np.uint8), face - (400, 0), face).any()


def test_lids_and_their_skin_are_paired_in_the_same_order() -> None:
    assert [edge for _, edge in LID_SKIN_VERTEX_PAIRS] == [upper for upper, _ in LID_EDGE_VERTEX_PAIRS]


def test_a_blink_that_the_tracker_misses(media) -> None:
    """A lowered head whose lids have no lashes to be seen: the tracker opens the left eye half for a fifth of a
    second, and whoever looks sees both eyes shut."""
    track = track_driver(Excerpt(media("driving/man_talk_tps.mp4"), trim=(5.2, 6.4)))
    tracked = lid_ratio(track.meshes, track.meshes[0])
    seen = lid_ratio(register_track(track, 0).meshes, track.meshes[0])
    middles = [3, 10]
    assert (tracked[20:25, 10] > 0.5).all()
    assert (seen[:, middles] < 0.05).all(axis=1).sum() >= 5
    np.testing.assert_allclose(seen[:15, middles], tracked[:15, middles], atol=0.02)


def test_eyes_that_the_tracker_follows_stay_as_tracked(media) -> None:
    """Open, narrowed and shut, on a face that moves its brows and its head, beginning with shut ones."""
    track = track_driver(Excerpt(media("driving/woman_frown_surprise_d3.mp4"), trim=(6.0, 10.0)))
    for neutral in (0, 119):
        rest = track.meshes[neutral]
        tracked, seen = (lid_ratio(m, rest) for m in (track.meshes, register_track(track, neutral).meshes))
        np.testing.assert_allclose(seen, tracked, atol=0.05)


def test_eyes_stay_open_behind_glasses_on_a_head_that_moves_fast(media) -> None:
    """Frames in which blur or a reflection takes the iris' contrast, among others in which whoever looks sees open eyes."""
    track = track_driver(Excerpt(media("driving/man_laugh_d12.mp4"), trim=(0.0, 1.76)))
    seen = lid_ratio(register_track(track, 1).meshes, track.meshes[1])
    assert seen[18:44, [3, 10]].min() > 0.6
