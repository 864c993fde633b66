"""Texels in the colours of the frames that their faces take, and by how much two frames differ where they meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.labels import UNSEEN_LABEL
from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.compiled import njit
from engine.render.rasterisation.rasteriser import Raster
from engine.render.textures.sampling import bilinear
from engine.render.textures.texture_bake import STRIP_TEXELS


@dataclass(frozen=True)
class PaintedTexture:
    """colours : (S, S, 3) uint8, zero where no frame gave any.
    known : (S, S) bool, where one did.
    seams : (M, 2) int64, pairs of texels side by side, as numbers in reading order, whose faces take different frames.
    jumps : (M, 3) float32, the second's frame minus the first's, the mean of what both show at both texels.
    """

    colours: NDArray[np.uint8]
    known: NDArray[np.bool_]
    seams: NDArray[np.int64]
    jumps: NDArray[np.float32]


def paint(
    surface: ChartedSurface,
    raster: Raster,
    labels: NDArray[np.intp],
    views: Sequence[FrameView],
    gains: NDArray[np.floating],
    strip: int = STRIP_TEXELS,
) -> PaintedTexture:
    """The texture of a surface whose faces take their colours from the frames `labels` (T,) of `views`.

    `raster` (S, S): of its texels (`engine.render.textures.texture_bake.texel_raster`); `gains` (N, 3) of the frames; at most `strip`
    texels are worked on at once, which changes nothing.
    """
    size = len(raster.triangle)
    of_texel = np.where(raster.triangle >= 0, labels[raster.triangle], UNSEEN_LABEL).astype(np.int16)
    known = of_texel != UNSEEN_LABEL
    seams = _meeting_texels(of_texel, surface.atlas.charts, raster.triangle)
    first, second = of_texel.ravel()[seams.T]
    # frames are asked for their own texels, and at seams for the other's: the second frame at the first texel, and back
    asked = np.concatenate([np.flatnonzero(known), seams[:, 0], seams[:, 1]])
    by = np.concatenate([of_texel[known], second, first])
    own = int(known.sum())
    order = np.argsort(by, kind="stable")
    spans = np.searchsorted(by[order], np.arange(len(views) + 1))
    colours = np.zeros((size * size, 3), np.uint8)
    beyond = np.zeros((2 * len(seams), 3), np.float32)
    for n, view in enumerate(views):
        mine = order[spans[n] : spans[n + 1]]
        if not len(mine):
            continue
        picture, gain = view.picture(), gains[n].astype(np.float32)
        for start in range(0, len(mine), strip):
            here = mine[start : start + strip]
            found = _look(surface, raster, asked[here], view, picture) * gain
            at_home = here < own
            colours[asked[here[at_home]]] = np.clip(np.rint(found[at_home]), 0, 255)
            beyond[here[~at_home] - own] = found[~at_home]
    at_first, at_second = beyond[: len(seams)], beyond[len(seams) :]
    jumps = (at_first - colours[seams[:, 0]] + colours[seams[:, 1]] - at_second) / 2
    return PaintedTexture(colours.reshape(size, size, 3), known, seams, jumps.astype(np.float32))


def _look(
    surface: ChartedSurface, raster: Raster, texels: NDArray[np.int64], view: FrameView, picture: NDArray[np.uint8]
) -> NDArray[np.float32]:
    """(n, 3) what a view shows at the places that texels show."""
    places = _places(
        surface.vertices, surface.triangles, raster.triangle.ravel(), raster.barycentrics.reshape(-1, 3), texels
    )
    return bilinear(picture, view.places(places))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _places(
    vertices: np.ndarray, faces: np.ndarray, triangle: np.ndarray, shares: np.ndarray, texels: np.ndarray
) -> np.ndarray:
    out = np.zeros((len(texels), 3), np.float64)
    for n in range(len(texels)):
        t = triangle[texels[n]]
        for corner in range(3):
            for axis in range(3):
                out[n, axis] += shares[texels[n], corner] * vertices[faces[t, corner], axis]
    return out


def _meeting_texels(
    of_texel: NDArray[np.int16], charts: NDArray[np.int32], triangle: NDArray[np.int32]
) -> NDArray[np.int64]:
    """(M, 2) pairs of neighbours on one chart with different labels, both known."""
    numbers = np.arange(of_texel.size, dtype=np.int64).reshape(of_texel.shape)
    found = []
    for one, other in (
        ((slice(None), slice(-1)), (slice(None), slice(1, None))),
        ((slice(-1), slice(None)), (slice(1, None), slice(None))),
    ):
        a, b = of_texel[one], of_texel[other]
        meet = np.nonzero((a != b) & (a != UNSEEN_LABEL) & (b != UNSEEN_LABEL))
        together = charts[triangle[one][meet]] == charts[triangle[other][meet]]
        pairs = np.stack([numbers[one][meet], numbers[other][meet]], 1)
        found.append(pairs[together])
    return np.concatenate(found)
