"""The colours of a mouth's inside, within a person's own: their lips', their teeth's, and the light on their skin."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.skin_colour import face_luminance, is_grey, skin_colour
from engine.face_animation.smoothstep import smoothstep
from engine.face_animation.whites import teeth_tint, white_luminance, white_tint
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER

ENAMEL_COLOUR, DENTINE_COLOUR = np.array([216, 209, 197.0]), np.array([198, 185, 162.0])
GUM_COLOUR, TONGUE_COLOUR = np.array([176, 96, 95.0]), np.array([196, 110, 108.0])
LINING_COLOUR, THROAT_COLOUR = np.array([160, 76, 74.0]), np.array([76, 32, 31.0])
"""Colours (sRGB) of mouths whose skin has the luminance `USUAL_SKIN_LUMINANCE`."""
USUAL_SKIN_LUMINANCE = 165.0
SKIN_LIGHT_RANGE = (0.35, 1.25)
LIP_HUE_SHARE = 0.5
"""Of the person's lips in what is flesh."""
TONGUE_LIT_SHARE, TONGUE_DARK_SHARE, TONGUE_SIDES_SHARE = 0.15, 0.75, 0.4
"""Shares of the tongue's length from its tip up to which it is in the light, and from which on it is not: half of it is left at the top of its arch, since an edge
between light and dark would cut it off. The last is the share of its half width from which on it turns to the cheeks."""
TONGUE_BACK_DARKNESS, TONGUE_SIDES_DARKNESS = 1.0, 0.9
"""Of the way from the lining's colour to the throat's, that of the tongue's back, and of its sides: as what is behind them, since an outline would
make it a block."""
TONGUE_FURROW_SHADE, TONGUE_FURROW_HALF_WIDTHS = 0.12, 0.12
"""By how much a tongue is darker along its middle, and over how much of its half width."""
MAX_TEETH_LEVEL = 250.0
"""The lightest a tooth becomes in any channel: cut off one by one, they would leave no hue of a warm light."""
CROWN_SHADE_RANGE = 0.1
"""By how much single crowns are lighter or darker than the row."""
MIN_TEETH_TO_SKIN_RATIO, MIN_TEETH_TO_FACE_RATIO, MAX_TEETH_TO_SKIN_RATIO = 1.3, 1.22, 1.8
"""Of the luminance of the skin around the mouth, and of a light place of the face, that the lightest of the upper teeth has at least; the second no further than
so many times the first. In sixteen photographs of people who smile it has 1.07 to 1.47 times that of a light place (median 1.2); a mouth may lie in the shade of its face."""
FACE_HIGHLIGHT_PERCENTILE, MAX_TEETH_TO_HIGHLIGHT_RATIO = 97, 1.05
"""The percentile of the luminance within the face's oval that is its highlights, and the share of theirs that teeth have
at most. Where the eyes' whites are lighter than highlights, it is a share of theirs. In three portraits that show teeth
these have 1.0, 1.0 and 1.07 times the highlights' luminance."""
ALBEDO_LUMINANCE, MAX_CHANNEL_ALBEDO = 0.55, 0.8
"""Of what throws light back in a mouth, of the hue of the person's skin: flesh and teeth; and of any channel of it."""
MIN_WHITES_TO_FACE_RATIO = 1.05
"""Of the luminance of a light place of the face, that eyes' whites have at least which are seen, and not lashes, shadow and skin."""
LIGHT_PLACE_PERCENTILE = 75
"""Of the luminance within the face's oval, that of a light place."""
LOWER_TEETH_LIGHT_SHARE = 0.75
"""Of the upper teeth's light, that lower ones have."""
BAG_LIGHT_SHARES = (0.9, 1.1)
"""Of the bag's light, what its roof has behind the upper lip, and its floor, on which light falls."""
BAG_DEPTH_SHARES = (0.2, 0.8)
"""Of the bag's depth, up to which it is in the light, and from which on it is as dark as the throat."""
COLOUR_RAMP_PIXELS = (64, 16)
"""Width and height of a ramp of colours, pixels."""


class MouthColours(NamedTuple):
    """A ramp of colours (16, 64, 3) uint8 for each part of a mouth, and what lights its shadows.

    upper, lower : teeth from the gum to their edges.
    tongue : from its tip to its root.
    bag : from the lips to the throat, its roof first.
    albedo : (3,) float64 in [0, 1], `mouth_albedo`.
    """

    upper: NDArray[np.uint8]
    lower: NDArray[np.uint8]
    tongue: NDArray[np.uint8]
    bag: NDArray[np.uint8]
    albedo: NDArray[np.float64]


def mouth_colours(
    rgb: NDArray[np.uint8], mesh: NDArray[np.floating], teeth: NDArray[np.floating] | None = None
) -> MouthColours:
    """Those of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3); `teeth` (3,) is what its upper teeth look like there, where that is
    known."""
    skin = skin_colour(rgb, mesh)
    luminance = max(float(skin @ LUMINANCE_WEIGHTS), 1.0)
    light = float(np.clip(luminance / USUAL_SKIN_LUMINANCE, *SKIN_LIGHT_RANGE))
    lips = lip_colour(rgb, mesh)
    flesh = {
        name: _blended(light * colour, lips)
        for name, colour in (
            ("gum", GUM_COLOUR),
            ("tongue", TONGUE_COLOUR),
            ("lining", LINING_COLOUR),
            ("throat", THROAT_COLOUR),
        )
    }
    edge = (
        light * float(ENAMEL_COLOUR @ LUMINANCE_WEIGHTS) * teeth_tint(rgb, mesh)
        if teeth is None
        else _of_a_tooth(teeth, rgb, mesh)
    )
    edge = edge * _teeth_luminance(edge, rgb, mesh) / max(float(edge @ LUMINANCE_WEIGHTS), 1.0)
    edge = edge * min(1.0, MAX_TEETH_LEVEL / float(edge.max()))
    root = edge * (DENTINE_COLOUR / ENAMEL_COLOUR)
    along, aside = np.linspace(0, 1, COLOUR_RAMP_PIXELS[0]), np.linspace(0, 1, COLOUR_RAMP_PIXELS[1])
    crowns = np.where(
        along[:, None] < 0.5, flesh["gum"], root + (np.clip(2 * along - 1, 0, 1) ** 0.6)[:, None] * (edge - root)
    )
    shades = 1 - CROWN_SHADE_RANGE + 2 * CROWN_SHADE_RANGE * aside
    upper = shades[:, None, None] * crowns
    back = smoothstep(along, TONGUE_LIT_SHARE, TONGUE_DARK_SHARE)
    sides = smoothstep(aside, TONGUE_SIDES_SHARE, 1)
    flat = np.broadcast_to(flesh["tongue"], (COLOUR_RAMP_PIXELS[1], COLOUR_RAMP_PIXELS[0], 3))
    for share, dark in ((back[None, :, None], TONGUE_BACK_DARKNESS), (sides[:, None, None], TONGUE_SIDES_DARKNESS)):
        flat = flat + share * (flesh["lining"] + dark * (flesh["throat"] - flesh["lining"]) - flat)
    furrow = 1 - TONGUE_FURROW_SHADE * np.exp(-0.5 * (aside / TONGUE_FURROW_HALF_WIDTHS) ** 2)
    deep = smoothstep(along, *BAG_DEPTH_SHARES)[:, None]
    floor = np.interp(aside, (0, 1), BAG_LIGHT_SHARES)[:, None, None]
    bag = floor * (flesh["lining"] + deep * (flesh["throat"] - flesh["lining"]))
    ramps = [upper, LOWER_TEETH_LIGHT_SHARE * upper, furrow[:, None, None] * flat, bag]
    if is_grey(rgb, mesh):
        ramps = [np.repeat((ramp @ LUMINANCE_WEIGHTS)[..., None], 3, axis=-1) for ramp in ramps]
    row, lower, lying, behind = (np.clip(np.rint(ramp), 0, 255).astype(np.uint8) for ramp in ramps)
    return MouthColours(row, lower, lying, behind, mouth_albedo(rgb, mesh))


def mouth_albedo(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) in [0, 1] the albedo of what throws light back in the mouth of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3): of the skin's hue,
    so that shadows are warm; grey in a picture that is."""
    skin = np.maximum(skin_colour(rgb, mesh), 1.0)
    hue = np.ones(3) if is_grey(rgb, mesh) else skin / float(skin @ LUMINANCE_WEIGHTS)
    return np.asarray(np.minimum(ALBEDO_LUMINANCE * hue, MAX_CHANNEL_ALBEDO), np.float64)


def _teeth_luminance(edge: NDArray[np.float64], rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """That of the lightest upper teeth, whose colour before is `edge` (3,): as light as a face asks for and as its eyes' whites are. Where these are seen, being
    lighter than a light place of the face, teeth are no lighter than they and its highlights."""
    skin, light = max(float(skin_colour(rgb, mesh) @ LUMINANCE_WEIGHTS), 1.0), face_luminance(rgb, mesh)
    place, highlight = (
        np.percentile(light, (LIGHT_PLACE_PERCENTILE, FACE_HIGHLIGHT_PERCENTILE)) if len(light) else (0.0, 255.0)
    )
    least = max(MIN_TEETH_TO_SKIN_RATIO * skin, min(MIN_TEETH_TO_FACE_RATIO * place, MAX_TEETH_TO_SKIN_RATIO * skin))
    whites = white_luminance(rgb, mesh)
    wanted = max(float(edge @ LUMINANCE_WEIGHTS), least, whites)
    most = float(max(MAX_TEETH_TO_HIGHLIGHT_RATIO * highlight, whites))
    return min(wanted, most) if whites > MIN_WHITES_TO_FACE_RATIO * place else wanted


def _of_a_tooth(teeth: NDArray[np.floating], rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """What `teeth` (3,) look like, their hue held between none and an enamel's in the picture's light: neither blue nor violet, and no more yellow
    than that."""
    luminance = max(float(teeth @ LUMINANCE_WEIGHTS), 1.0)
    most = ENAMEL_COLOUR / float(ENAMEL_COLOUR @ LUMINANCE_WEIGHTS) * white_tint(rgb, mesh)
    return np.asarray(luminance * np.clip(teeth / luminance, np.minimum(most, 1), np.maximum(most, 1)), np.float64)


def _blended(colour: NDArray[np.float64], lips: NDArray[np.float64]) -> NDArray[np.float64]:
    """As light as `colour` (3,), its hue half-way to that of the lips (3,)."""
    other = lips * float(colour @ LUMINANCE_WEIGHTS) / max(float(lips @ LUMINANCE_WEIGHTS), 1.0)
    return np.asarray((1 - LIP_HUE_SHARE) * colour + LIP_HUE_SHARE * other, np.float64)


def lip_colour(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) the mean colour of the lips of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3)."""
    mask = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [mesh[list(LIPS_OUTER), :2].round().astype(np.int32)], 1)
    cv2.fillPoly(mask, [mesh[list(LIPS_INNER), :2].round().astype(np.int32)], 0)
    found = rgb[mask > 0]
    return np.asarray(found.mean(axis=0) if len(found) else GUM_COLOUR, np.float64)
