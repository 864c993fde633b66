"""The template's own texture put into the stitched one, in the person's colours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.eyes import Eyeballs, eye_samples, painted_eyes, persons_eyes
from engine.avatar.texture.template_texture.hands import hand_bones, painted_hand, past_wrist
from engine.avatar.texture.template_texture.lid_shadow import lid_shadow
from engine.avatar.texture.template_texture.mouth import painted_lining, painted_teeth, painted_tongue
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.avatar.texture.views import FrameView
from engine.body.rig import Rig
from engine.geometry.joint_names import SIDES
from engine.geometry.surface import vertex_normals
from engine.imaging.histogram_matching import matched_in_lab
from engine.performances.modelling.eyes import EYEBALL_RADIUS
from engine.render.rasteriser import Raster

WRIST_LENGTH = 0.03
"""Metres past the wrist over which the frames' colours become the template's."""
MAX_STRETCH = 1.3
"""Of the painted hand's contrast: what frames have more of is their shading."""
MIN_SEEN_SHARE = 0.05
"""Of a hand's texels, that frames must show for their colours to be those of the hand; else all are, filled ones too."""


def place_mouth(texture: NDArray[np.uint8], surface: TemplateSurface, raster: Raster) -> None:
    """Paint teeth, tongue and the lining of the mouth into a `texture` (S, S, 3), in place."""
    for part in ("upper_teeth", "lower_teeth", "tongue"):
        texels = PartTexels.fine(surface.atlas, surface.of(part), len(texture))
        places = texels.blend(surface.rest, surface.triangles)
        upper = part == "upper_teeth"
        texels.put(texture, painted_tongue(places) if part == "tongue" else painted_teeth(places, upper))
    lining = PartTexels.of(raster, surface.mouth)
    lining.put(texture, painted_lining(lining.blend(surface.rest, surface.triangles)))


def place_eyes(
    texture: NDArray[np.uint8],
    surface: TemplateSurface,
    vertices: NDArray[np.floating],
    views: Sequence[FrameView],
    gains: NDArray[np.floating],
) -> bool:
    """Paint the eyeballs, in the colours that `views` show of the person whose template vertices are (V, 3). Both eyes have
    the same colours. Whether frames showed enough of them: if not they are the template's."""
    fitted = surface.fitted(vertices)
    balls, irises, whites = [], [], []
    for part in ("left_eye", "right_eye"):
        own = surface.of(part)
        middle = surface.rest[np.unique(surface.triangles[own])].mean(0)
        texels = PartTexels.fine(surface.atlas, own, len(texture))
        offset = texels.blend(surface.rest, surface.triangles) - middle
        radius = np.linalg.norm(offset, axis=1, keepdims=True)
        eyes = Eyeballs(offset * EYEBALL_RADIUS / radius, texels.triangles, texels.shares)
        iris, white = eye_samples(fitted, eyes, views, gains)
        balls.append((texels, eyes))
        irises.append(iris)
        whites.append(white)
    iris, white = np.concatenate(irises), np.concatenate(whites)
    for texels, eyes in balls:
        points = texels.blend(fitted.vertices, surface.triangles)
        shadow = lid_shadow(fitted, points, eyes.gaze(points))
        texels.put(texture, persons_eyes(painted_eyes(eyes), eyes, iris, white) * shadow[:, None])
    return bool(len(iris) and len(white))


def place_hands(
    texture: NDArray[np.uint8], seen: NDArray[np.bool_], surface: TemplateSurface, raster: Raster, rig: Rig
) -> None:
    """Paint the hands, in the colours that a stitched `texture` (S, S, 3) has of them, where it was `seen` (S, S)."""
    normals = vertex_normals(surface.rest, surface.triangles)
    flat, shown = texture.reshape(-1, 3), seen.ravel()
    for side in SIDES:
        texels = PartTexels.of(raster, surface.hands[side])
        if not len(texels.texels):
            continue
        bones = hand_bones(rig, surface.rest, side)
        places = texels.blend(surface.rest, surface.triangles)
        facing = texels.blend(normals, surface.triangles)
        facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-9)
        own = flat[texels.texels].astype(np.float32)
        share = past_wrist(bones, places, WRIST_LENGTH)[:, None].astype(np.float32)
        hand = share[:, 0] == 1  # a sleeve may reach as far as the wrist
        told = hand & shown[texels.texels]
        reference = own[told] if told.sum() > MIN_SEEN_SHARE * hand.sum() else own[hand]
        painted = matched_in_lab(painted_hand(bones, places, facing), reference, MAX_STRETCH)
        texels.put(texture, own + share * (painted - own))
