"""A persona in another light, and one of its photographs in the light of a texture."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import box_around
from engine.imaging.filling.nearest import nearest_values
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.face_tessellation import face_triangles, opening_triangles
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, eye_distance
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.light.directions import LIGHT_DIRECTIONS, RATIO_OFFSET_LEVELS, DirectedLight, directed_light
from engine.persona.light.low_frequencies import low_frequencies
from engine.persona.persona import Persona
from engine.persona.texture.texture_frame import sampled

LIGHT_GAIN_RANGE = (0.4, 2.5)
"""By which light may change."""
LIGHT_FALLOFF_EYE_DISTANCES = 1.3
"""Eye distances from the face at which a third of its change is left: hair and neck go along, a wall behind them does not."""
MIN_STRENGTH = 0.12
"""Of a light from a side (`DirectedLight.strength`) that is seen to come from there."""
RIM_LIGHT_WIDTH_EYE_DISTANCES = 0.35
"""Eye distances over which what is beside the face takes the light of its rim."""


def regenerated(persona: Persona, number: int) -> NDArray[np.uint8]:
    """(H, W, 3) what one of the photographs shows, in the collection's average light, in the persona's frame: its own texture among
    those whose expressions are like it."""
    return persona.synthesis(persona.weights_of_points(persona.points[number : number + 1].astype(np.float64)))[0]


def in_light(persona: Persona, light: str) -> tuple[Persona, float]:
    """The persona in the `average` light of its photographs, or in that from one of `LIGHT_DIRECTIONS`, and how strong
    that is. The photograph that acts is brought into it, too."""
    even = np.ones((*persona.frame.size, 3), np.float32)
    directed = directed_light(persona, light) if light in LIGHT_DIRECTIONS else DirectedLight(even, 1.0)
    portrait = persona.portrait
    if portrait is not None:
        becomes = regenerated(persona, portrait.number) * directed.gain
        portrait = replace(portrait, rgb=np.clip(np.rint(relit(persona, portrait, becomes)), 0, 255).astype(np.uint8))
    colours = np.array([np.clip(np.rint(one * directed.gain), 0, 255).astype(np.uint8) for one in persona.colours])
    return replace(persona, colours=colours, portrait=portrait), directed.strength


def relit(persona: Persona, photo: FacePhoto, texture: NDArray[np.floating]) -> NDArray[np.float32]:
    """(h, w, 3) one of the persona's photographs in the light that a `texture` (H, W, 3) of its face shows; what is close to the face, hair and
    neck, goes along with its rim."""
    at = over_photo(persona, photo)
    if at is None:
        return photo.rgb.astype(np.float32)
    frame = persona.frame
    own = sampled(photo.rgb, frame.lookup(photo.mesh))
    believed = frame.face * persona.belief[photo.number].astype(np.float32) / 255
    was, becomes = (low_frequencies(one, believed, frame.scale) for one in (own, texture.astype(np.float32)))
    gain = np.clip((becomes + RATIO_OFFSET_LEVELS) / (was + RATIO_OFFSET_LEVELS), *LIGHT_GAIN_RANGE)
    found = cv2.remap(gain, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    known = at[..., 0] >= 0
    unit = float(eye_distance(photo.mesh[:, :2]))
    beside = cv2.GaussianBlur(
        nearest_values(np.asarray(found, np.float32), known), (0, 0), RIM_LIGHT_WIDTH_EYE_DISTANCES * unit
    )
    away = cv2.distanceTransform((~known).astype(np.uint8), cv2.DIST_L2, 3) / (LIGHT_FALLOFF_EYE_DISTANCES * unit)
    gains = 1 + np.exp(-(away**2))[..., None] * (np.asarray(beside) - 1)
    return np.asarray(
        (photo.rgb + np.float32(RATIO_OFFSET_LEVELS)) * gains - np.float32(RATIO_OFFSET_LEVELS), np.float32
    )


def over_photo(persona: Persona, photo: FacePhoto) -> NDArray[np.float32] | None:
    """(h, w, 2) where in the persona's frame each pixel of the photograph is, negative beside the face; None where it shows none of it."""
    height, width = photo.rgb.shape[:2]
    face = photo.mesh[:MESH_SIZE, :2].astype(np.float32)
    if box_around(face[list(FACE_OVAL)], (height, width)) is None:
        return None
    source = persona.frame.places[:MESH_SIZE, :2].astype(np.float32)
    triangles = np.concatenate([face_triangles(), opening_triangles()])
    return inverse_map(face, source, triangles, (height, width), photo.mesh[:, 2].astype(np.float32))
