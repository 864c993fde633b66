"""From the fitted mesh and frames with their cameras to the texture: the paper's section 3.5, one step after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.alignment import aligned
from engine.avatar.texture.exposure import exposure_gains
from engine.avatar.texture.labels import UNSEEN_LABEL, FaceLabels, best_views, stitched
from engine.avatar.texture.levelling import level_seams
from engine.avatar.texture.painting import paint
from engine.avatar.texture.photo_consistency import consistent
from engine.avatar.texture.view_samples import ViewSamples, sample_views
from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.geometry.mesh.surface import triangle_areas
from engine.render.rasterisation.rasteriser import Raster
from engine.render.textures.texture_bake import charts_of, texel_raster
from engine.render.textures.texture_fill import fill_over_surface

AVATAR_TEXTURE_SIZE_TEXELS = 4096


@dataclass(frozen=True)
class StitchedTexture:
    """texture : (S, S, 3) uint8 sRGB, whole but beside its charts.
    resolution : (T,) pixels per metre at which the frame that each face took shows it, 0 where none does.
    raster : (S, S) what each texel shows.
    gains : (N, 3) of the frames.
    labels : of the faces, the frame that each took.
    best : the frames that show each best, to compare with.
    """

    texture: NDArray[np.uint8]
    resolution: NDArray[np.float32]
    raster: Raster
    gains: NDArray[np.float32]
    labels: FaceLabels
    best: FaceLabels

    @property
    def seen(self) -> NDArray[np.bool_]:
        """(S, S) texels whose colours a frame gave."""
        return np.asarray((self.raster.triangle >= 0) & (self.resolution[self.raster.triangle] > 0))


def stitch_texture(
    surface: ChartedSurface, views: Sequence[FrameView], size: int = AVATAR_TEXTURE_SIZE_TEXELS
) -> StitchedTexture:
    """The texture of `surface`, `size` texels along a side, from `views`, whose pictures are read twice.

    Raises ValueError where no view shows any of the surface.
    """
    gains = exposure_gains(sample_views(surface, views))
    views = aligned(surface, views, gains)
    samples = sample_views(surface, views)
    gains = exposure_gains(samples)
    samples = consistent(samples, gains, surface.doubted)
    areas = triangle_areas(surface.vertices, surface.triangles)
    best, labels = best_views(samples, gains, areas), stitched(samples, gains, areas)
    resolution = _resolution(samples, labels)
    del samples
    if (labels.labels == UNSEEN_LABEL).all():
        raise ValueError("no view shows any of the surface")
    raster = texel_raster(surface.atlas, size)
    painted = paint(surface, raster, labels.labels, views, gains)
    level_seams(painted, charts_of(surface.atlas, raster))
    fill_over_surface(painted.colours, painted.known, raster, surface.vertices, surface.triangles)
    return StitchedTexture(painted.colours, resolution, raster, gains, labels, best)


def _resolution(samples: ViewSamples, labels: FaceLabels) -> NDArray[np.float32]:
    """(T,) pixels per metre, in the mean of both directions, at which frames show the faces that took them."""
    taken = labels.labels[:, None]
    density = np.take_along_axis(samples.density * np.sqrt(samples.cosine), np.maximum(taken, 0), 1)
    return np.where(taken == UNSEEN_LABEL, 0, density)[:, 0]
