"""The template's own texture put into the stitched one, in the person's colours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.template_skin.skin import EYE_PARTS
from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.eyes import Eyeballs, eye_samples, painted_eyes, persons_eyes
from engine.avatar.texture.template_texture.hand_colours import face_skin
from engine.avatar.texture.template_texture.hand_joining import HandSurface, joined_hand
from engine.avatar.texture.template_texture.lid_shadow import lash_shadow, lid_shadow
from engine.avatar.texture.template_texture.mouth import mouth_light, painted_lining, painted_teeth, painted_tongue
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.avatar.texture.views import FrameView
from engine.body.rig import Rig
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.eyes import IRIS_RADIUS
from engine.performances.modelling.hands import HandBones, hand_bones, painted_hand, past_wrist
from engine.performances.modelling.skin_tone import hand_tone, like_skin, toned
from engine.render.rasterisation.rasteriser import Raster

SOCKET_LIGHT_SHARE = 0.35
"""Of the light on an eyeball, what its socket has where it shows between this and the lids."""
WRIST_LENGTH_METRES, CUFF_LENGTH_METRES = 0.03, 0.004
"""Metres past the wrist over which what the arm's colours are filled with becomes the hand's: along bare skin, and where a sleeve ends."""
SLEEVE_WINDOW_METRES = (-0.025, 0.0)
"""Metres past the wrist between which it is looked what the arm wears."""
ARM_RADIUS_METRES = 0.08
"""Metres about the arm's axis within which what is there is the arm's, or its sleeve."""


def place_mouth(texture: NDArray[np.uint8], surface: TemplateSurface, raster: Raster) -> None:
    """Paint teeth, tongue and the lining of the mouth into a `texture` (S, S, 3), in place."""
    for part in ("upper_teeth", "lower_teeth", "tongue"):
        texels = PartTexels.fine(surface.atlas, surface.of(part), len(texture))
        places = texels.blend(surface.rest, surface.triangles)
        upper = part == "upper_teeth"
        light = mouth_light(places)
        lit = painted_tongue(places) * light[:, :1] if part == "tongue" else painted_teeth(places, upper) * light
        texels.put(texture, lit)  # a tongue is painted the redder the deeper it is
    lining = PartTexels.of(raster, surface.mouth)
    lining.put(texture, painted_lining(lining.blend(surface.rest, surface.triangles)))


def place_eyes(
    texture: NDArray[np.uint8],
    surface: TemplateSurface,
    vertices: NDArray[np.floating],
    views: Sequence[FrameView],
    gains: NDArray[np.floating],
    iris_radius: float,
    raster: Raster,
) -> bool:
    """Paint the eyeballs, in the colours that `views` show of the person whose template vertices are (V, 3), with irises of a
    radius, metres, and the sockets as their white in the dark. Both eyes have the same colours. Whether frames showed enough of them: if not they are the template's."""
    fitted = surface.fitted(vertices)
    balls, irises, whites = [], [], []
    for part in EYE_PARTS:
        own = surface.of(part)
        middle = surface.rest[np.unique(surface.triangles[own])].mean(0)
        texels = PartTexels.fine(surface.atlas, own, len(texture))
        offset = texels.blend(surface.rest, surface.triangles) - middle
        radius = sphere(fitted.vertices[np.unique(surface.triangles[own])])[1]
        eyes = Eyeballs.of(offset, radius, iris_radius, texels.triangles, texels.shares)
        points = texels.blend(fitted.vertices, surface.triangles)
        gaze = eyes.gaze(points)
        shadow = lid_shadow(fitted, points, gaze) * lash_shadow(points, fitted.vertices[surface.lid_rims[part]], gaze)
        iris, white = eye_samples(fitted, eyes, views, gains, shadow)
        balls.append((texels, eyes, shadow))
        irises.append(iris)
        whites.append(white)
    iris, white = np.concatenate(irises), np.concatenate(whites)
    for texels, eyes, shadow in balls:
        colours = persons_eyes(painted_eyes(eyes), eyes, iris, white)
        texels.put(texture, colours * shadow[:, None])
    socket = PartTexels.of(raster, surface.sockets)
    dark = SOCKET_LIGHT_SHARE * np.median(colours[eyes.off_axis > IRIS_RADIUS], axis=0)
    socket.put(texture, np.broadcast_to(dark, (len(socket.texels), 3)))
    return bool(len(iris) and len(white))


def place_hands(
    texture: NDArray[np.uint8], resolution: NDArray[np.floating], surface: TemplateSurface, raster: Raster, rig: Rig
) -> None:
    """Paint what a stitched `texture` (S, S, 3) lacks of the hands, in place, in the person's own colours. `resolution` (T,): pixels
    per metre at which frames show each face, 0 where none does. Gloves stay as frames show them."""
    normals = vertex_normals(surface.rest, surface.triangles)
    flat = texture.reshape(-1, 3)
    seen = (raster.triangle >= 0) & (resolution[raster.triangle] > 0)
    face = face_skin(texture, seen, surface, raster)
    middles = surface.rest[surface.triangles].mean(1)
    for side in SIDE_NAMES:
        texels = PartTexels.of(raster, surface.hands[side])
        if not len(texels.texels):
            continue
        bones = hand_bones(rig, surface.rest, side)
        places = texels.blend(surface.rest, surface.triangles)
        hand = past_wrist(bones, places, CUFF_LENGTH_METRES) == 1
        own, shown = flat[texels.texels], resolution[texels.triangles] > 0
        about = np.linalg.norm(middles - bones.wrist, axis=1) < 2 * ARM_RADIUS_METRES
        arm = PartTexels.of(raster, surface.of("body") & about)
        sleeve = flat[arm.texels[_before_wrist(bones, arm.blend(surface.rest, surface.triangles))]]
        tone = hand_tone(face, own[hand], shown[hand], sleeve)
        if tone is None:
            continue
        facing = texels.blend(normals, surface.triangles)
        facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-9)
        painted = toned(painted_hand(bones, places, facing), tone)
        alone = HandSurface.of(surface.rest, surface.triangles, surface.hands[side], bones)
        joined = joined_hand(alone, texels, own, painted, resolution, tone)
        bare = len(sleeve) and like_skin(to_lab(sleeve), tone).mean() > 0.5
        share = past_wrist(bones, places, WRIST_LENGTH_METRES if bare else CUFF_LENGTH_METRES)[:, None]
        texels.put(texture, own + share * (joined - own))


def _before_wrist(bones: HandBones, places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(N,) which places (N, 3) are on the arm, just before the wrist."""
    offset = places - bones.wrist
    along = offset @ bones.along
    beside = np.linalg.norm(offset - along[:, None] * bones.along, axis=1)
    return np.asarray(
        (along > SLEEVE_WINDOW_METRES[0]) & (along < SLEEVE_WINDOW_METRES[1]) & (beside < ARM_RADIUS_METRES)
    )
