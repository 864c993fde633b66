"""Hairs: thin curves drawn over a picture, far to near, each pixel covered by as much as the hair is wide.

Shading: J. Kajiya, T. Kay, Rendering fur with three dimensional textures, SIGGRAPH 1989 (diffuse), with two
shifted highlights, white and tinted, after S. Marschner et al., Light scattering from human hair fibers, 2003.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.lighting.light import Lamps


def shade_strands(
    tangents: NDArray[np.floating],
    view: NDArray[np.floating],
    passed: NDArray[np.floating],
    lamps: Lamps,
    colour: NDArray[np.floating],
    gloss: float,
) -> NDArray[np.float32]:
    """Radiance (N, 3) float32 of points on hairs.

    Parameters
    ----------
    tangents : (N, 3) unit vectors along the hair, root to tip.
    view : (N, 3) unit vectors to the eye.
    passed : (N, L) the share of each lamp's light that reaches the point.
    colour : (N, 3) linear albedo of the hair.
    gloss : strength of the highlights.
    """
    return _shade(
        np.ascontiguousarray(tangents, np.float32),
        np.ascontiguousarray(view, np.float32),
        np.ascontiguousarray(passed, np.float32),
        lamps.directions,
        lamps.irradiance,
        np.ascontiguousarray(colour, np.float32),
        gloss,
    )


def draw_strands(
    picture: NDArray[np.float32],
    depth: NDArray[np.float32],
    points: NDArray[np.floating],
    colours: NDArray[np.floating],
    widths: NDArray[np.floating],
    tolerance: float = 0.0008,
) -> None:
    """Draw hairs over a picture, in place.

    Parameters
    ----------
    picture : (H, W, 3) float32 linear.
    depth : (H, W) distance of what is in the picture; hairs further away by more than `tolerance` metres hide.
    points : (S, K, 3) x, y in pixels and the distance, for each hair from root to tip.
    colours : (S, K, 3) radiance.
    widths : (S, K) in pixels; may be far below one.
    """
    order = np.argsort(-points[:, :, 2].mean(1), kind="stable")
    _draw(
        picture,
        depth,
        np.ascontiguousarray(points[order], np.float32),
        np.ascontiguousarray(colours[order], np.float32),
        np.ascontiguousarray(widths[order], np.float32),
        tolerance,
    )


@njit(parallel=True, fastmath=True)
def _shade(
    tangents: np.ndarray,
    view: np.ndarray,
    passed: np.ndarray,
    directions: np.ndarray,
    irradiance: np.ndarray,
    colour: np.ndarray,
    gloss: float,
) -> np.ndarray:
    out = np.zeros((len(tangents), 3), np.float32)
    shift = np.float32(0.09)  # the cuticle's scales tilt the first highlight to the root, the second to the tip
    for i in prange(len(tangents)):
        tx, ty, tz = tangents[i, 0], tangents[i, 1], tangents[i, 2]
        along_view = tx * view[i, 0] + ty * view[i, 1] + tz * view[i, 2]
        across_view = np.sqrt(max(1 - along_view * along_view, 0.0))
        for k in range(len(directions)):
            share = passed[i, k]
            if share < 0.004:
                continue
            along = tx * directions[k, 0] + ty * directions[k, 1] + tz * directions[k, 2]
            across = np.sqrt(max(1 - along * along, 0.0))
            # sine of the angle between the mirrored lamp's cone and the eye
            miss = along * across_view + along_view * across
            first = np.exp(-0.5 * ((miss - shift) / 0.11) ** 2)
            second = np.exp(-0.5 * ((miss + 1.6 * shift) / 0.20) ** 2)
            for c in range(3):
                body = colour[i, c] * across * 0.32
                shine = gloss * (0.055 * first + 0.55 * second * colour[i, c])
                out[i, c] += share * irradiance[k, c] * (body + shine)
    return out


@njit(fastmath=True)
def _draw(
    picture: np.ndarray,
    depth: np.ndarray,
    points: np.ndarray,
    colours: np.ndarray,
    widths: np.ndarray,
    tolerance: float,
) -> None:
    height, width = depth.shape
    for s in range(len(points)):
        for k in range(points.shape[1] - 1):
            x0, y0, z0 = points[s, k, 0], points[s, k, 1], points[s, k, 2]
            x1, y1, z1 = points[s, k + 1, 0], points[s, k + 1, 1], points[s, k + 1, 2]
            w0, w1 = widths[s, k], widths[s, k + 1]
            dx, dy = x1 - x0, y1 - y0
            length = np.sqrt(dx * dx + dy * dy)
            if not length < 400:
                continue
            pad = 0.5 * max(w0, w1) + 0.6
            left, right = max(int(np.ceil(min(x0, x1) - pad)), 0), min(int(np.floor(max(x0, x1) + pad)), width - 1)
            top, bottom = max(int(np.ceil(min(y0, y1) - pad)), 0), min(int(np.floor(max(y0, y1) + pad)), height - 1)
            for y in range(top, bottom + 1):
                for x in range(left, right + 1):
                    t = ((x - x0) * dx + (y - y0) * dy) / (length * length) if length > 1e-4 else 0.5
                    # pieces share no pixel; only the two ends of the hair reach out, by half a pixel
                    if (t < 0 and k > 0) or (t >= 1 and k < points.shape[1] - 2):
                        continue
                    beyond = max(-t, t - 1) * length
                    t = min(max(t, 0.0), 1.0)
                    if beyond > 0.5:
                        continue
                    away = abs((x - x0) * dy - (y - y0) * dx) / max(length, 1e-4)
                    w = w0 + t * (w1 - w0)
                    half = 0.5 * w
                    # overlap of the hair with a pixel-wide box around the pixel's centre
                    cover = max(min(away + 0.5, half) - max(away - 0.5, -half), 0.0)
                    if beyond > 0:
                        cover *= 1 - 2 * beyond
                    if cover <= 0 or z0 + t * (z1 - z0) > depth[y, x] + tolerance:
                        continue
                    for c in range(3):
                        radiance = colours[s, k, c] + t * (colours[s, k + 1, c] - colours[s, k, c])
                        picture[y, x, c] += cover * (radiance - picture[y, x, c])
