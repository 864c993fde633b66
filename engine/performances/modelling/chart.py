"""A map of the actor's head: the skin unrolled from a cylinder around the vertical axis of the skull.

Everything that is painted on the face (blood, freckles, pores, furrows) is painted on this map, in metres:
u runs to the sitter's left along the cylinder, v upwards. It covers face, ears and neck; what is painted there
sticks to the skin as it moves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

AXIS_DEPTH = 0.045
"""Metres: z of the cylinder's axis in the rest pose."""

CHART_RADIUS_METRES = 0.1
"""Metres of u for one radian."""

CHART_TEXELS_PER_METRE = 4000.0
"""Texels in a metre: four to the millimetre, a little finer than the supersampled picture."""

CHART_LEFT, CHART_RIGHT, CHART_TOP, CHART_BOTTOM = -0.22, 0.22, 0.95, 0.55
CHART_SHAPE = (
    round((CHART_TOP - CHART_BOTTOM) * CHART_TEXELS_PER_METRE),
    round((CHART_RIGHT - CHART_LEFT) * CHART_TEXELS_PER_METRE),
)


def coordinates(points: NDArray[np.floating]) -> NDArray[np.float32]:
    """(V, 3) points of the rest pose to (V, 2) float32 chart coordinates (u, v), metres."""
    turn = np.arctan2(points[:, 0], points[:, 2] - AXIS_DEPTH)
    return np.stack([CHART_RADIUS_METRES * turn, points[:, 1]], 1).astype(np.float32)


def texture_coordinates(chart: NDArray[np.floating]) -> NDArray[np.float32]:
    """Chart coordinates (..., 2) to those of a texture of `CHART_SHAPE`, (0, 0) its top left, (1, 1) its bottom right."""
    return np.stack(
        [
            (chart[..., 0] - CHART_LEFT) / (CHART_RIGHT - CHART_LEFT),
            (CHART_TOP - chart[..., 1]) / (CHART_TOP - CHART_BOTTOM),
        ],
        -1,
    ).astype(np.float32)


def grid() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """u and v at the centres of the texels, (H, W) float32 each."""
    u = CHART_LEFT + (np.arange(CHART_SHAPE[1], dtype=np.float32) + 0.5) / CHART_TEXELS_PER_METRE
    v = CHART_TOP - (np.arange(CHART_SHAPE[0], dtype=np.float32) + 0.5) / CHART_TEXELS_PER_METRE
    return np.broadcast_to(u, CHART_SHAPE), np.broadcast_to(v[:, None], CHART_SHAPE)


def slopes(height: NDArray[np.float32]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """How a relief (H, W), metres, rises along u and along v, (H, W) each."""
    down, across = np.gradient(height, 1 / CHART_TEXELS_PER_METRE)
    return np.asarray(across, np.float32), np.asarray(-down, np.float32)


def box(low: Sequence[float], high: Sequence[float]) -> tuple[slice, slice]:
    """The rows and columns of the chart's texels between two corners (u, v), metres."""
    columns = slice(
        min(max(int((low[0] - CHART_LEFT) * CHART_TEXELS_PER_METRE), 0), CHART_SHAPE[1]),
        min(max(int((high[0] - CHART_LEFT) * CHART_TEXELS_PER_METRE) + 1, 0), CHART_SHAPE[1]),
    )
    rows = slice(
        min(max(int((CHART_TOP - high[1]) * CHART_TEXELS_PER_METRE), 0), CHART_SHAPE[0]),
        min(max(int((CHART_TOP - low[1]) * CHART_TEXELS_PER_METRE) + 1, 0), CHART_SHAPE[0]),
    )
    return rows, columns


def blob(centre: tuple[float, float], spread: tuple[float, float], turn: float = 0.0) -> NDArray[np.float32]:
    """A Gaussian of height one: `spread` are its standard deviations along its axes, `turn` radians. It is zero where it
    would be less than what float32 tells from zero beside one."""
    reach = 7 * max(spread)
    rows, columns = box((centre[0] - reach, centre[1] - reach), (centre[0] + reach, centre[1] + reach))
    u, v = (axis[rows, columns] for axis in grid())
    du, dv = u - centre[0], v - centre[1]
    c, s = np.cos(turn), np.sin(turn)
    height = np.zeros(CHART_SHAPE, np.float32)
    height[rows, columns] = np.exp(-0.5 * (((c * du + s * dv) / spread[0]) ** 2 + ((c * dv - s * du) / spread[1]) ** 2))
    return height


def mirrored_blobs(centre: tuple[float, float], spread: tuple[float, float], turn: float = 0.0) -> NDArray[np.float32]:
    """A blob on each side of the face, mirrored; `centre` and `turn` are those of the sitter's left."""
    return blob(centre, spread, turn) + blob((-centre[0], centre[1]), spread, -turn)


def smooth_curve(points: list[tuple[float, float]], count: int = 400) -> NDArray[np.float64]:
    """A cubic spline through (u, v) points, as `count` points evenly spread over its parameter."""
    p = np.array(points)
    steps = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    if len(p) == 2:
        return p[0] + np.linspace(0, 1, count)[:, None] * (p[1] - p[0])
    return CubicSpline(steps, p)(np.linspace(0, steps[-1], count))


def curve_coordinates(
    points: list[tuple[float, float]], reach: float
) -> tuple[NDArray[np.float32], NDArray[np.float32], tuple[slice, slice]]:
    """Distance to a smooth curve, with sign (positive to its left), and the place along it [0, 1].

    Only for the texels within `reach` metres of its bounding box, whose span in the chart is returned third.
    """
    curve = smooth_curve(points)
    low, high = curve.min(0) - reach, curve.max(0) + reach
    rows, columns = box(low, high)
    u, v = grid()
    texels = np.stack([u[rows, columns], v[rows, columns]], -1)
    distance, nearest = cKDTree(curve).query(texels)
    ahead = np.gradient(curve, axis=0)[nearest]
    offset = texels - curve[nearest]
    side = np.where(ahead[..., 0] * offset[..., 1] - ahead[..., 1] * offset[..., 0] >= 0, 1, -1)
    place = np.asarray(nearest) / (len(curve) - 1)
    return (distance * side).astype(np.float32), place.astype(np.float32), (rows, columns)


def noise(rng: np.random.Generator, size: float, octaves: int = 1) -> NDArray[np.float32]:
    """Smooth random variation, mean 0 and standard deviation 1, with features of about `size` metres; each
    further octave halves the size and the strength."""
    frequencies = (
        np.hypot(np.fft.fftfreq(CHART_SHAPE[0])[:, None], np.fft.rfftfreq(CHART_SHAPE[1])[None])
        * CHART_TEXELS_PER_METRE
    ).astype(np.float32)
    total = np.zeros(CHART_SHAPE, np.float32)
    for octave in range(octaves):
        scale = size / 2**octave
        band = np.exp(-0.5 * ((frequencies * scale - 0.7) / 0.35) ** 2)
        spectrum = fft.rfft2(rng.standard_normal(CHART_SHAPE, np.float32)) * band
        layer = fft.irfft2(spectrum, CHART_SHAPE, overwrite_x=True)
        total += layer / (layer.std() * 2**octave)
    return total / total.std()


def smooth_step(value: NDArray[np.floating], low: float, high: float) -> NDArray[np.float32]:
    """A smooth ramp from 0 at `low` to 1 at `high` (which may be the smaller)."""
    t = np.clip((value - low) / (high - low), 0, 1)
    return (t * t * (3 - 2 * t)).astype(np.float32)
