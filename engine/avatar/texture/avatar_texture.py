"""The texture of an avatar: stitched from frames, with eyes and mouth of the template's own, and hands where frames show little."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.eyes.fitted_eyes import IRIS_RADIUS_METRES
from engine.avatar.texture.labels import UNSEEN_LABEL, FaceLabels
from engine.avatar.texture.stitching import AVATAR_TEXTURE_SIZE_TEXELS, stitch_texture
from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.lids import place_lids
from engine.avatar.texture.template_texture.placing import place_eyes, place_hands, place_mouth
from engine.avatar.texture.views import FrameView
from engine.body.rig import Rig
from engine.geometry.mesh.surface import triangle_areas
from engine.render.textures.texture_bake import charts_of, pad_charts


@dataclass(frozen=True)
class AvatarTexture:
    """texture : (S, S, 3) uint8 sRGB.
    gains : (N, 3) what each frame's colours were multiplied by.
    seen_share : of the skin's area, how much a frame shows.
    eyes_seen : whether the eyes have colours that frames show.
    labels : which frame each face took.
    best : by which frame it is shown best.
    """

    texture: NDArray[np.uint8]
    gains: NDArray[np.float32]
    seen_share: float
    eyes_seen: bool
    labels: FaceLabels
    best: FaceLabels


def avatar_texture(
    surface: TemplateSurface,
    rig: Rig,
    vertices: NDArray[np.floating],
    views: Sequence[FrameView],
    size: int = AVATAR_TEXTURE_SIZE_TEXELS,
    iris: float = IRIS_RADIUS_METRES,
) -> AvatarTexture:
    """The texture, `size` texels a side, of the person as the cameras of `views` have them. Their template vertices are
    (V, 3), metres, and their irises have the radius `iris`, metres.

    Raises ValueError where no view shows the person.
    """
    fitted = surface.fitted(vertices)
    found = stitch_texture(fitted, views, size)
    place_hands(found.texture, found.resolution, surface, found.raster, rig)
    place_mouth(found.texture, surface, found.raster)
    place_lids(found.texture, surface, vertices, found.raster)
    eyes_seen = place_eyes(found.texture, surface, vertices, views, found.gains, iris, found.raster)
    areas = triangle_areas(fitted.vertices, fitted.triangles) * fitted.stitched
    share = float(areas[found.labels.labels != UNSEEN_LABEL].sum() / areas.sum())
    charts = charts_of(surface.atlas, found.raster)
    labels, best, gains, texture = found.labels, found.best, found.gains, found.texture
    del found
    return AvatarTexture(pad_charts(texture, charts >= 0, charts), gains, share, eyes_seen, labels, best)
