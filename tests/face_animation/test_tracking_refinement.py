"""What a second look finds amiss on real faces."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from made_clip import OPENS
from made_face import driver as made_driver
from made_face import opened, placed

from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import detail_region, keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.face_rig import rig_target
from engine.face_animation.tracking_refinement import OBSERVED_FRAMES, ObservedDriver, observe_driver, refine_tracking
from engine.face_animation.warping.layers import separate_layers
from engine.media.excerpt import Excerpt
from engine.media.limits import Limits
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER
from engine.perception.face_track.face_crop import CROP_SHAPE, crop_place
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face

REST = placed(60, (150, 150))


def test_the_neutral_frame_is_glanced_at_first_and_the_others_differ(tmp_path: Path) -> None:
    meshes = [opened(REST, 0.02 * k) for k in range(60)]
    observations = observe_driver(made_driver(tmp_path, meshes), 7)
    assert observations.frames[0] == 7 and 59 in observations.frames
    assert len(set(observations.frames.tolist())) == len(observations.frames) == OBSERVED_FRAMES + 1
    assert np.isnan(observations.seen).all()  # the pictures are plain skin


def test_a_driver_that_never_moves_is_glanced_at_once(tmp_path: Path) -> None:
    assert observe_driver(made_driver(tmp_path, [REST] * 30), 4).frames.tolist() == [4]


def test_the_made_face_comes_nearer_to_the_driver_s_in_a_tracker_s_eyes(small, mouth_opens) -> None:
    """Frames that were not looked at, too: where the mouth opens, lips are nearer by a twentieth, seen as the driver's are seen,
    and the face as a whole is no further off. (On much smaller pictures the tracker's scatter is as large as what is amiss.)"""
    options = PortraitOptions()
    target = find_target_face(small("photo_woman_white.png", 600), options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    rig = rig_target(target, layers)
    track = track_driver(Excerpt(mouth_opens, trim=(OPENS[0], OPENS[0] + 1.2)))
    track = replace(track, meshes=register_track(track, 0).meshes)
    ratios, observations = keep_ratio_images(track, 0), observe_driver(track, 0)
    residuals = refine_tracking(ObservedDriver(track, 0, observations, ratios), target, rig.details, options.acting())
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
    assert left["better"][lips].mean() < 0.95 * left["plain"][lips].mean()
    assert left["better"].mean() < 1.02 * left["plain"].mean()


def test_where_the_tracker_sees_no_face_nothing_is_corrected(woman_white, mouth_opens) -> None:
    """A picture whose face only its user sees, with placed landmarks."""
    options = PortraitOptions()
    target = find_target_face(woman_white, options, Limits(), lambda code, message: None)
    target = replace(target, rgb=np.full_like(target.rgb, 128))
    track = track_driver(Excerpt(mouth_opens, trim=(OPENS[0], OPENS[0] + 0.3)))
    driver = ObservedDriver(track, 0, observe_driver(track, 0), keep_ratio_images(track, 0))
    assert len(refine_tracking(driver, target, detail_region(target.rgb, target.mesh), options.acting()).faces) == 0
