"""The mouth of a persona: in the puppet, whose texture has none of its own, and in its model."""

from __future__ import annotations

from dataclasses import dataclass

from engine.face_animation.mouth.modelled.modelled_mouth import ModelledMouth
from engine.face_animation.mouth.modelled.mouth_colours import MouthColours, mouth_colours
from engine.face_animation.mouth.modelled.picture_softness import picture_softness
from engine.face_animation.mouth.modelled.resting_mouth import RestingMouth, resting_mouth
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth, teeth_gain
from engine.face_animation.mouth.pictured.teeth_strip import teeth_strip
from engine.perception.face.landmarks import eye_distance
from engine.persona.persona import Persona


@dataclass(frozen=True)
class PersonaMouth:
    """at : how the face rests.
    colours : of what is modelled.
    photo : the upper teeth of a photograph; None where none shows any that can be told apart, and all is modelled.
    softness : of the puppet's texture (`picture_softness`).
    """

    at: RestingMouth
    colours: MouthColours
    photo: PhotoTeeth | None
    softness: float

    @property
    def interior(self) -> MouthInterior:
        """What draws it."""
        return self.photo or ModelledMouth(self.at, self.colours, True, softness=self.softness)


def puppet_mouth(persona: Persona) -> PersonaMouth:
    """What is between the puppet's lips, in the light of its texture at rest: upper teeth of one photograph, since the mean of several is a
    ghost; the rest is modelled."""
    at, average, mesh = resting_mouth(persona.neutral, persona.neutral), persona.average, persona.frame.places[:478]
    softness = picture_softness(average, mesh)
    if persona.teeth is None:
        return PersonaMouth(at, mouth_colours(average, mesh), None, softness)
    strip = teeth_strip(persona.teeth, float(eye_distance(mesh[:, :2])))
    if not strip.has_crowns:  # a band tells of no colour, either: it is as much of lips and shadow
        return PersonaMouth(at, mouth_colours(average, mesh), None, softness)
    colours = mouth_colours(average, mesh, strip.usual() * teeth_gain(average, mesh, persona.teeth, strip))
    behind = ModelledMouth(at, colours, False, softness=softness)
    open_mouth = persona.mesh[None, :, :2]
    return PersonaMouth(at, colours, PhotoTeeth(at, average, mesh, persona.teeth, behind, open_mouth), softness)
