"""The one inside of the mouth that a target has through a whole clip: modelled, in its own light and palette, behind the upper
teeth that its picture shows.

Section 5 pastes the driver's. A driver that laughs is blurred, turned and in another light: its teeth come as a violet or
flesh-coloured plug, and come and go from frame to frame. What is modelled stays the same, wherever jaw and lips go.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.closing import PARTED_OPENINGS
from engine.face_animation.mouth.lip_contours import MIN_TEETH_OPENING
from engine.face_animation.mouth.lip_seam import LipSeam
from engine.face_animation.mouth.modelled.modelled_mouth import ModelledMouth
from engine.face_animation.mouth.modelled.mouth_colours import lip_colour, mouth_colours
from engine.face_animation.mouth.modelled.picture_softness import picture_softness
from engine.face_animation.mouth.modelled.resting_mouth import resting_mouth
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth, appearing_opening, teeth_gain
from engine.face_animation.mouth.pictured.pictured_face import PicturedFace
from engine.face_animation.mouth.pictured.teeth_strip import teeth_strip
from engine.face_animation.skin_colour import skin_colour
from engine.face_animation.target_face import TargetFace
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import eye_distance, mouth_opening


def target_mouth(target: TargetFace, shown: NDArray[np.floating] | None = None) -> MouthInterior:
    """The inside of a target's mouth. Where its picture shows crowns of upper teeth, which are lighter than skin, these are it. Anything else that
    parted lips show there, a tongue or teeth in the dark, is never seen: as the mouth moved it would be a grey plug, and give way to
    teeth from one frame to the next. Lips that are parted there meet in a line (`LipSeam`). `shown` : (N, 2) how much of its teeth the driver shows in each
    of its frames (`seen_teeth`): the target shows no more."""
    if float(mouth_opening(target.mesh)) <= PARTED_OPENINGS[0]:
        return _inside(target, appearing_opening(target.mesh), shown)
    return LipSeam(_inside(target, 0.0, shown), lip_colour(target.rgb, target.mesh))


def _inside(target: TargetFace, appearing: float, shown: NDArray[np.floating] | None) -> MouthInterior:
    """The inside of a target's mouth without the line between its lips. Where it is modelled it is seen from an opening
    of `appearing` on."""
    rgb, mesh = target.rgb, target.mesh
    general = frontalise(canonical_face()[None].astype(np.float64))[0]
    at, softness = resting_mouth(frontalise(mesh[None])[0], general), picture_softness(rgb, mesh)
    if float(mouth_opening(mesh)) > MIN_TEETH_OPENING:
        photo = PicturedFace(rgb, mesh)
        strip = teeth_strip(photo, float(eye_distance(mesh[:, :2])))
        if strip.has_crowns and _lightness(strip.usual(), rgb, mesh) > 1:
            colours = mouth_colours(rgb, mesh, strip.usual() * teeth_gain(rgb, mesh, photo, strip))
            none: NDArray[np.float32] = np.zeros((0, *mesh[:, :2].shape), np.float32)  # as large as in the picture
            behind = ModelledMouth(at, colours, False, softness=softness, shown=shown)
            return PhotoTeeth(at, rgb, mesh, photo, behind, none, shown=shown)
    return ModelledMouth(at, mouth_colours(rgb, mesh), True, appearing, softness, shown)


def _lightness(colour: NDArray[np.floating], rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """The luminance of a colour (3,), as a share of the skin's."""
    return float(colour @ LUMINANCE_WEIGHTS) / max(float(skin_colour(rgb, mesh) @ LUMINANCE_WEIGHTS), 1.0)
