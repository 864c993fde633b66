"""The stages that make a target and a driver ready, walked beside each other: what every system that animates a face runs.

Their names are those of the runs' reports and of what is stored; whoever runs them plans their shares of the time.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.creases.fine_details import DetailRegion, RatioStrip, detail_region, keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.lid_speed import slow_lids
from engine.face_animation.driver_tracking.neutral import NeutralFrame
from engine.face_animation.face_rig import FaceRig, rig_target
from engine.face_animation.loop import close_loop
from engine.face_animation.motion_transfer.landmark_residuals import LandmarkResiduals
from engine.face_animation.target_face import TargetFace
from engine.face_animation.tracking_refinement import (
    DriverObservations,
    ObservedDriver,
    observe_driver,
    refine_tracking,
)
from engine.face_animation.warping.layers import Layers, separate_layers
from engine.media.excerpt import Excerpt
from engine.perception.face_track.track import FaceTrack
from engine.perception.masks.matting_network import matting_model
from engine.run import ConcurrentStage, Run


@dataclass(frozen=True)
class PreparedTarget:
    """A target's `face`, and what is made of it on another core meanwhile: the region that `details` go to, the `layers`
    and the `rig`."""

    face: TargetFace
    details: ConcurrentStage[DetailRegion]
    layers: ConcurrentStage[Layers]
    rig: ConcurrentStage[FaceRig]


def prepare_target(face: TargetFace, run: Run) -> PreparedTarget:
    """Begin everything that depends on the picture alone."""
    model = matting_model(os.environ)
    details = run.beside("detail_region", detail_region, face.rgb, face.mesh)
    layers = run.beside("separate_layers", separate_layers, face, model, model and model.file.sha256)
    return PreparedTarget(face, details, layers, run.beside("rig_target", rig_target, face, layers, details))


@dataclass(frozen=True)
class DriverPerformance:
    """A driver's performance: its `track` on the skin, the `choice` of its neutral frame, its `ratios`, the `observations`
    of it."""

    track: FaceTrack
    choice: NeutralFrame
    ratios: RatioStrip
    observations: DriverObservations

    @property
    def neutral(self) -> int:
        """The neutral frame's index."""
        return self.choice.frame

    def residuals_on(self, target: PreparedTarget, options: ActingOptions, run: Run) -> LandmarkResiduals:
        """By how much the target's landmarks miss where it acts this out."""
        driver = ObservedDriver(self.track, self.neutral, self.observations, self.ratios)
        given = driver, target.face, target.details(), options
        return run.stage("look_again", refine_tracking, *given, run.tick, run.idle_cores)


def follow_driver(
    driver: Path, fps: float | None, trim: tuple[float, float] | None, face_index: int, run: Run
) -> ConcurrentStage[FaceTrack]:
    """Begin to follow one of the driver's faces, which nothing else has to wait for."""
    excerpt = Excerpt(driver, fps, trim, run.limits)
    return run.beside("track_driver", track_driver, excerpt, face_index, run.tick, run.warn, shared=True)


def analyse_driver(
    tracking: ConcurrentStage[FaceTrack],
    neutral_of: Callable[[FaceTrack], NeutralFrame],
    run: Run,
    loop: bool = False,
    creases: bool = True,
) -> DriverPerformance:
    """Everything that depends on the driver alone, but for the choice of its neutral frame. `creases` : whether they are carried over."""
    track = tracking.once()
    choice = neutral_of(track)
    neutral = choice.frame
    registered = run.stage("register_driver", register_track, track, neutral, run.tick, track.meshes, shared=True)
    slow_lids(registered.meshes, neutral, track.fps)
    track = replace(track, meshes=registered.meshes)
    if loop:
        track = close_loop(track)
    observations = run.beside("glance_at_driver", observe_driver, track, neutral, shared=True)
    ratios = RatioStrip()
    if creases:
        ratios = run.stage("ratio_images", keep_ratio_images, track, neutral, run.tick, shared=True)
    return DriverPerformance(track, choice, ratios, observations())
