"""The colours of bare skin that the face shows best: hands take theirs from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.performances.modelling.skin_tone import of_skin_s_hue
from engine.render.rasterisation.rasteriser import Raster

CHEEK_RADIUS_METRES = 0.022
"""Metres about the middles of cheeks and nose within which a face is bare skin: below the lids, above the lips."""
MIN_FACE_SHARE = 0.5
"""Share of what a face shows that has to be of skin's hues: else a mask or a helmet covers it."""


def face_skin(
    texture: NDArray[np.uint8], seen: NDArray[np.bool_], surface: TemplateSurface, raster: Raster
) -> NDArray[np.uint8]:
    """(M, 3) the colours that a stitched `texture` (S, S, 3) has of bare skin of the face, where it was `seen` (S, S); none where
    the face does not show any."""
    eyes = [surface.rest[np.unique(surface.triangles[surface.of(name)])].mean(0) for name in ("left_eye", "right_eye")]
    mouth = surface.rest[np.unique(surface.triangles[surface.of("tongue")])].mean(0)
    spots = [eye + 0.55 * (mouth - eye) * [0, 1, 0] for eye in eyes]
    spots.append((spots[0] + spots[1]) / 2)
    middles = surface.rest[surface.triangles].mean(1)
    own = surface.of("body") & ~surface.mouth & (middles[:, 2] > mouth[2])
    beside = np.min([np.hypot(*(middles - spot)[:, :2].T) for spot in spots], axis=0)
    texels = PartTexels.of(raster, own & (beside < CHEEK_RADIUS_METRES)).texels
    colours = texture.reshape(-1, 3)[texels[seen.ravel()[texels]]]
    if not len(colours):
        return colours
    skin = of_skin_s_hue(colours)
    return colours[skin] if skin.mean() >= MIN_FACE_SHARE else colours[:0]
