"""The texture of an eyeball: an iris completed to its disk, and the white, of the photograph that shows them best."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import EYE_OUTLINE_IRIS_CORNERS, prepare_eyes
from engine.face_animation.eyes.eyeball import Eyeball as EyeLayer
from engine.face_animation.skin_colour import skin_colour
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.persona.eyes.eyeball import CAP_RADIANS
from engine.persona.persona import Persona

EYE_TEXTURE_SIZE_TEXELS = 192
"""Texels of the side of an eye's texture."""
MIN_PHOTO_EYE_WIDTH_PIXELS = 28.0
"""Pixels of a photograph's eye whose iris is more than a blot."""
EYE_SIDES = ("Right", "Left")
"""In the order of `prepare_eyes`."""
WHITE_EDGE = 0.55
"""Share of its light that the white of an eye keeps where it turns away."""
EYE_GAIN_RANGE = (0.6, 1.6)


def eye_textures(persona: Persona, radii: dict[str, float]) -> dict[str, NDArray[np.uint8]]:
    """(S, S, 3) of both sides, in the light of the average face. It is that of the persona's portrait, or of the
    photograph that lends its teeth, if eyes are large and open in it. Else it is that of the average itself. `radii` :
    of the eyeballs, in widths of their eyes."""
    average, mesh = persona.average, persona.frame.places[:478].astype(np.float32)
    skin = skin_colour(average, mesh)
    for photo in (persona.portrait, persona.teeth):
        if photo is None:
            continue
        found = prepare_eyes(photo.rgb, photo.mesh)
        if all(eye is not None and eye.width >= MIN_PHOTO_EYE_WIDTH_PIXELS for eye in found):
            gain = float(skin @ LUMINANCE_WEIGHTS) / max(
                float(skin_colour(photo.rgb, photo.mesh) @ LUMINANCE_WEIGHTS), 1
            )
            return _both(found, photo.mesh, radii, float(np.clip(gain, *EYE_GAIN_RANGE)))
    return _both(prepare_eyes(average, mesh), mesh, radii, 1.0)


def _both(
    found: tuple[EyeLayer | None, EyeLayer | None], mesh: NDArray[np.floating], radii: dict[str, float], gain: float
) -> dict[str, NDArray[np.uint8]]:
    """An eye that is not seen has the other's colours."""
    out = {}
    for number, side in enumerate(EYE_SIDES):
        seen = number if found[number] is not None else 1 - number
        eye = found[seen]
        if eye is None:
            out[side] = np.full((EYE_TEXTURE_SIZE_TEXELS, EYE_TEXTURE_SIZE_TEXELS, 3), 128, np.uint8)
            continue
        iris = mesh[EYE_OUTLINE_IRIS_CORNERS[seen][1][0], :2] - eye.corner
        out[side] = texture_of(eye, iris, radii[side] * eye.width, gain)
    return out


def texture_of(eye: EyeLayer, iris: NDArray[np.floating], radius: float, gain: float) -> NDArray[np.uint8]:
    """`iris` (2,) : its middle in the layer, pixels. `radius` : of the eyeball, pixels of the layer."""
    places = (np.arange(EYE_TEXTURE_SIZE_TEXELS) + 0.5) / EYE_TEXTURE_SIZE_TEXELS * 2 - 1
    x, y = np.meshgrid(places, places)
    share = np.hypot(x, y)
    angle = np.minimum(share, 1) * CAP_RADIANS
    reach = radius * np.sin(angle) / np.maximum(share, 1e-6)
    at = (iris[0] + reach * x).astype(np.float32), (iris[1] + reach * y).astype(np.float32)
    whole, disk, alpha = (
        np.asarray(cv2.remap(layer, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float32)
        for layer in (eye.white, eye.iris, eye.iris_alpha)
    )
    light = 1 - (1 - WHITE_EDGE) * (angle / CAP_RADIANS) ** 2
    colours = (whole * light[..., None].astype(np.float32)) + alpha[..., None] * (disk - whole * light[..., None])
    return np.clip(np.rint(gain * colours), 0, 255).astype(np.uint8)
