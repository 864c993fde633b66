"""What a picture wears goes as its face does not make it, also where the driver's creases are not carried."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from made_clip import OPENS

from engine.face_animation.animation import FaceAnimation, Parts, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import RatioStrip
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.face_rig import rig_target
from engine.face_animation.warping.layers import separate_layers
from engine.media.excerpt import Excerpt
from engine.media.limits import Limits
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER, MOUTH_CORNER_VERTICES
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face


def test_corners_of_a_rounded_mouth_lose_the_line_of_the_closed_one(woman_white: Path, mouth_opens: Path) -> None:
    options = PortraitOptions()
    target = find_target_face(woman_white, options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    rigged = RiggedTarget(target, layers, rig_target(target, layers))
    driver = RegisteredDriver(track_driver(Excerpt(mouth_opens, trim=OPENS)), 0)
    drawn = {}
    for eased in (True, False):
        animation = FaceAnimation(rigged, driver, options.acting(), Parts(details=False, own_folds=eased))
        motion = list(animation.motions())[-1]
        face, lips = animation.face(motion), sorted({*LIPS_INNER, *LIPS_OUTER})
        offsets = motion.offsets.copy()
        offsets[lips, 0] += 0.35 * (face[lips, 0].mean() - face[lips, 0])
        motion = replace(motion, offsets=offsets)
        drawn[eased] = animation.draw(motion, RatioStrip().ratio(0)).astype(int)
        corners = np.rint(animation.face(motion)[list(MOUTH_CORNER_VERTICES)]).astype(int)
    lighter = (drawn[True] - drawn[False]).sum(axis=2)
    assert all(lighter[y - 4 : y + 5, x - 4 : x + 5].max() > 20 for x, y in corners)
    far = np.ones(lighter.shape, bool)
    (left, top), (right, bottom) = corners.min(axis=0) - 60, corners.max(axis=0) + 60
    far[top:bottom, left:right] = False
    assert not lighter[far].any()
