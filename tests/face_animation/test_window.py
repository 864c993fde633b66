"""A part of a frame is drawn as it is in the whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from made_clip import OPENS

from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import keep_ratio_images
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.face_rig import rig_target
from engine.face_animation.warping.layers import separate_layers
from engine.imaging.window import Window
from engine.media.excerpt import Excerpt
from engine.media.limits import Limits
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face


def test_a_window_of_a_frame_is_that_part_of_it(woman_white: Path, mouth_opens: Path) -> None:
    options = PortraitOptions()
    target = find_target_face(woman_white, options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    track = track_driver(Excerpt(mouth_opens, trim=OPENS))
    ratios = keep_ratio_images(track, 0)
    animation = FaceAnimation(
        RiggedTarget(target, layers, rig_target(target, layers)), RegisteredDriver(track, 0), options.acting()
    )
    motion = list(animation.motions())[-1]
    whole = animation.draw(motion, ratios.ratio(motion.frame)).astype(int)
    face = animation.face(motion)
    (left, top), (right, bottom) = face.min(axis=0).astype(int), face.max(axis=0).astype(int)
    window = Window(int(left) - 5, int(top) - 9, int(right) + 5, int(bottom) + 9)
    part = animation.draw(motion, ratios.ratio(motion.frame), window).astype(int)
    assert part.shape[:2] == window.shape
    apart = np.abs(part - whole[window.pixels]).max(axis=2)
    assert (apart > 1).mean() < 0.001, "rounding at a few edges alone"
