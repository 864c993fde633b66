"""The mouth of a persona: in the puppet, whose texture has none of its own, and in its model."""

from __future__ import annotations

from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.perception.landmarks import eye_distance
from engine.persona.mouth.modelled_mouth import ModelledMouth
from engine.persona.mouth.mouth_colours import mouth_colours
from engine.persona.mouth.photo_teeth import PhotoTeeth, teeth_gain
from engine.persona.mouth.resting_mouth import resting_mouth
from engine.persona.mouth.teeth_strip import teeth_strip
from engine.persona.persona import Persona


def puppet_mouth(persona: Persona) -> MouthInterior:
    """What is between the puppet's lips, in the light of its texture at rest: upper teeth of one photograph, where one shows any, and of no
    other, since the mean of several is a ghost; the rest is modelled."""
    average = persona.average
    at = resting_mouth(persona.neutral, persona.neutral)
    mesh = persona.frame.places[:478]
    if persona.teeth is None:
        return ModelledMouth(at, mouth_colours(average, mesh), True)
    strip = teeth_strip(persona.teeth, float(eye_distance(mesh[:, :2])))
    gain = teeth_gain(average, mesh, persona.teeth, strip)
    behind = ModelledMouth(at, mouth_colours(average, mesh, strip.usual() * gain), False)
    return PhotoTeeth(at, average, mesh, persona.teeth, behind, persona.mesh[None, :, :2], True)
