"""A target and a driver made ready to act, and the frames they give, as the pipeline does it stage by stage."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.animation import (
    ALL_PARTS,
    FaceAnimation,
    Parts,
    RegisteredDriver,
    RiggedTarget,
    draw_in_order,
)
from engine.face_animation.creases.fine_details import RatioImages, keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.lid_speed import slow_lids
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame
from engine.face_animation.face_rig import FaceRig, rig_target
from engine.face_animation.target_face import TargetFace
from engine.face_animation.tracking_refinement import ObservedDriver, observe_driver, refine_tracking
from engine.face_animation.warping.layers import Layers, separate_layers
from engine.media.excerpt import Excerpt
from engine.media.image import write_image
from engine.media.limits import Limits
from engine.perception.face_track.track import FaceTrack
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face


@dataclass(frozen=True)
class Acting:
    """Everything that `render` needs."""

    track: FaceTrack
    neutral: int
    target: TargetFace
    layers: Layers
    rig: FaceRig
    options: ActingOptions
    looked: bool = True
    """Whether a second look corrects it."""

    def frames(self, parts: Parts = ALL_PARTS, refined: bool = True, step: int = 1) -> Iterator[NDArray[np.uint8]]:
        """Every `step`-th frame of the animation; the others are not drawn."""
        given = self.track, self.neutral
        residuals = None
        if self.looked:
            driver = ObservedDriver(*given, observe_driver(*given), keep_ratio_images(*given))
            residuals = refine_tracking(driver, self.target, self.rig.details, self.options)
        animation = FaceAnimation(
            RiggedTarget(self.target, self.layers, self.rig), RegisteredDriver(*given, residuals), self.options, parts
        )
        ratios = RatioImages(*given, outliers=refined, refined=refined)
        moments = zip(animation.motions(), ratios, strict=True)
        yield from draw_in_order(animation.draw, (moment for moment in moments if moment[0].frame % step == 0))


def read_target(folder: Path, rgb: NDArray[np.uint8], options: PortraitOptions) -> tuple[TargetFace, Layers, FaceRig]:
    """A picture (H, W, 3) as a target; `folder` takes its file."""
    height, width = (side - side % 2 for side in rgb.shape[:2])
    path = folder / "target.png"
    write_image(path, np.ascontiguousarray(rgb[:height, :width]))
    target = find_target_face(path, options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    return target, layers, rig_target(target, layers)


def read_driver(path: Path, target: TargetFace, neutral: int | None) -> tuple[FaceTrack, int]:
    """A clip as a driver for a target, its meshes on the skin."""
    track = track_driver(Excerpt(path))
    chosen = choose_neutral_frame(track, target.mesh, neutral).frame
    meshes = register_track(track, chosen).meshes
    slow_lids(meshes, chosen, track.fps)
    return replace(track, meshes=meshes), chosen
