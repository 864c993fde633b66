"""The mouth of a photograph of the persona that acts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.modelled.modelled_mouth import ModelledMouth
from engine.face_animation.mouth.modelled.mouth_colours import mouth_colours
from engine.face_animation.mouth.modelled.picture_softness import picture_softness
from engine.face_animation.mouth.modelled.resting_mouth import resting_mouth
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth, appearing_opening, teeth_gain
from engine.face_animation.mouth.pictured.teeth_strip import teeth_strip
from engine.face_animation.target_face import TargetFace
from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import eye_distance
from engine.persona.persona import Persona
from engine.run import Run


def acting_mouth(persona: Persona, target: TargetFace, faces: NDArray[np.floating], run: Run) -> MouthInterior:
    """What is between the lips of the persona's photograph `target`, whose face does `faces` (F, 478, 2). The upper
    teeth of one photograph stand before what is modelled, in the target's light. Warns where no photograph has any."""
    rgb, mesh = target.rgb, target.mesh
    at = resting_mouth(frontalise(mesh[None])[0], persona.neutral)
    appearing, softness = appearing_opening(mesh), picture_softness(rgb, mesh)
    strip = None if persona.teeth is None else teeth_strip(persona.teeth, float(eye_distance(mesh[:, :2])))
    if persona.teeth is None or strip is None or not strip.has_crowns:
        run.warn(
            "no_teeth_shown",
            "None of the photos shows the person's upper teeth from before, large and sharp enough: those between the lips are modelled. Add"
            " a larger photo with a smile.",
        )
        return ModelledMouth(at, mouth_colours(rgb, mesh), True, appearing, softness)
    colours = mouth_colours(rgb, mesh, strip.usual() * teeth_gain(rgb, mesh, persona.teeth, strip))
    behind = ModelledMouth(at, colours, False, appearing, softness)
    return PhotoTeeth(at, rgb, mesh, persona.teeth, behind, faces, appearing)
