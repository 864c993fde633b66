"""What is seen between the lips: one interface, behind which other systems may put a mouth of their own."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import match_palette, transfer_mouth, unseen_mouth_share
from engine.face_animation.mouth.teeth import draw_teeth, find_teeth
from engine.face_animation.target_face import TargetFace
from engine.perception.face_track.track import FaceTrack


class MouthInterior(Protocol):
    """Draws the inside of a mouth. Frames are drawn side by side: drawing changes nothing but the frame."""

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """Draw between the lips of a `face` (478, 2), in place, pixels of the `frame` (H, W, 3), what the driver shows in
        its `driver_frame`."""


class DriverMouth:
    """The driver's mouth in the target's colours (section 5), where the target's lips part further than in its picture; up
    to there the teeth that the picture itself shows."""

    def __init__(self, target: TargetFace, track: FaceTrack, neutral: int):
        self._track = track
        self._teeth = find_teeth(target.rgb, target.mesh)
        self._palette = match_palette(target.rgb, target.mesh, track.crop(neutral), track.in_crop(neutral))

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """As `MouthInterior.draw`."""
        share = unseen_mouth_share(face, self._palette)
        if self._teeth is not None:
            draw_teeth(frame, self._teeth, face, 1 - share)
        if share > 0:
            crop, inside = self._track.crop(driver_frame), self._track.in_crop(driver_frame)
            transfer_mouth(frame, face, crop, inside, self._palette)
