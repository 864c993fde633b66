"""What a rastered pixel looks up: attributes of the triangle's vertices, and textures."""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.rasterisation.rasteriser import Raster


def interpolate(
    attributes: NDArray[np.floating], triangles: NDArray[np.integer], raster: Raster, background: float = 0.0
) -> NDArray[np.float32]:
    """Blend a vertex attribute over each covered pixel.

    Parameters
    ----------
    attributes : (V, C) any vertex attribute: colour, normal, position, texture coordinate.
    triangles : (T, 3) indices into `attributes`, in the order in which the triangles were rastered. They may
        differ from the rastered ones where the attribute has its own indices, as texture coordinates do.
    background : value of uncovered pixels.

    Returns
    -------
    (H, W, C) float32
    """
    values = np.ascontiguousarray(attributes, dtype=np.float32)
    faces = np.ascontiguousarray(triangles, dtype=np.int32)
    return _interpolate(values, faces, raster.triangle, raster.barycentrics, background)


def sample_texture(
    texture: NDArray[np.uint8] | NDArray[np.floating],
    uv: NDArray[np.floating],
    covered: NDArray[np.bool_] | None = None,
) -> NDArray[np.float32]:
    """Look up a texture bilinearly; beyond its border it is continued by its outermost texels.

    Parameters
    ----------
    texture : (h, w, C). uint8 is not rescaled: values stay 0 to 255.
    uv : (H, W, 2) texture coordinates as in glTF: (0, 0) the top-left corner of the top-left texel, (1, 1) the
        bottom-right corner of the last.
    covered : (H, W) pixels to look up, all by default; the others become zero.

    Returns
    -------
    (H, W, C) float32
    """
    if covered is None:
        covered = np.ones(uv.shape[:2], np.bool_)
    return _sample(np.ascontiguousarray(texture), np.ascontiguousarray(uv, dtype=np.float32), covered)


@njit(parallel=True, boundscheck=False)
def _interpolate(
    values: np.ndarray, faces: np.ndarray, ids: np.ndarray, weights: np.ndarray, background: float
) -> np.ndarray:
    height, width = ids.shape
    channels = values.shape[1]
    out = np.full((height, width, channels), background, np.float32)
    for y in prange(height):
        for x in range(width):
            t = ids[y, x]
            if t < 0:
                continue
            a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
            wa, wb, wc = weights[y, x, 0], weights[y, x, 1], weights[y, x, 2]
            for k in range(channels):
                out[y, x, k] = wa * values[a, k] + wb * values[b, k] + wc * values[c, k]
    return out


@njit(parallel=True, boundscheck=False)
def _sample(texture: np.ndarray, uv: np.ndarray, covered: np.ndarray) -> np.ndarray:
    height, width = covered.shape
    rows, columns, channels = texture.shape
    out = np.zeros((height, width, channels), np.float32)
    for y in prange(height):
        for x in range(width):
            if not covered[y, x]:
                continue
            u = min(max(uv[y, x, 0] * columns - 0.5, 0.0), columns - 1.0)
            v = min(max(uv[y, x, 1] * rows - 0.5, 0.0), rows - 1.0)
            left, top = int(u), int(v)
            right, bottom = min(left + 1, columns - 1), min(top + 1, rows - 1)
            fu, fv = np.float32(u - left), np.float32(v - top)
            for k in range(channels):
                upper = texture[top, left, k] * (1 - fu) + texture[top, right, k] * fu
                lower = texture[bottom, left, k] * (1 - fu) + texture[bottom, right, k] * fu
                out[y, x, k] = upper * (1 - fv) + lower * fv
    return out
