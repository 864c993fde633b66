"""The actor's T-shirt: a ribbed collar swept along the neckline, and the cloth below it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import triangulate
from engine.performances.modelling.figure import Figure
from engine.render.rasterisation.rasteriser import rasterise

NECKLINE_AXIS_DEPTH = 0.012
"""Metres: z of the vertical axis around which the neckline runs."""

COLLAR_WIDTH = 0.017
"""Width of the ribbed collar, metres."""


@dataclass(frozen=True)
class Shirt:
    """A grid of cloth bound to the fine skin, N vertices.

    corners : (N, 3) int32, vertices of the triangle of skin under each.
    share : (N, 3) float32, its barycentrics there.
    lift : (N,) float32 metres above the skin.
    triangles : (T, 3) int32.
    light_triangles : (U, 3) int32, fewer, for shadows.
    weave : (N, 2) float32 metres along the cloth, around the neck and away from it: the collar is where the second is less
        than `COLLAR_WIDTH`.
    """

    corners: NDArray[np.int32]
    share: NDArray[np.float32]
    lift: NDArray[np.float32]
    triangles: NDArray[np.int32]
    light_triangles: NDArray[np.int32]
    weave: NDArray[np.float32]


def sew_shirt(figure: Figure, seed: int = 31) -> Shirt:
    """Cut the shirt to the figure's rest pose."""
    skin = (figure.fine @ figure.rest).astype(np.float32)
    triangles = triangulate(figure.quads)
    turns = np.linspace(-np.pi, np.pi, 361)[:-1]
    low, high, scale = 0.46, 0.70, 2500.0
    turn = np.arctan2(skin[:, 0], skin[:, 2] - NECKLINE_AXIS_DEPTH)
    radius = np.hypot(skin[:, 0], skin[:, 2] - NECKLINE_AXIS_DEPTH)
    width = 1440
    pixels = np.stack([(turn / (2 * np.pi) + 0.5) * width, (high - skin[:, 1]) * scale, -radius], 1)
    whole = triangles[np.ptp(turn[triangles], axis=1) < 1]
    raster = rasterise(pixels, whole, (round((high - low) * scale), width))
    profile = np.where(np.isfinite(raster.depth), -raster.depth, np.nan)
    drawn = np.flatnonzero(np.isfinite(profile).sum(0) > 0.8 * len(profile))
    away = np.concatenate([np.linspace(-0.002, 0.022, 25), 0.022 + 0.19 * np.linspace(0, 1, 56)[1:] ** 1.15])
    rows = np.empty((len(turns), len(away)), int)
    # triangles across the seam behind the neck are not drawn: there, the nearest column that is stands in
    wanted = (turns / (2 * np.pi) + 0.5) * width
    nearest = drawn[np.abs(drawn[None] - wanted[:, None]).argmin(1)]
    columns = np.repeat(nearest[:, None], len(away), 1)
    for i, angle in enumerate(turns):
        column = _filled(profile[:, columns[i, 0]])
        first = int((high - neckline(angle)) * scale)
        run = np.concatenate([[0], np.cumsum(np.hypot(np.diff(column), 1 / scale))])
        rows[i] = np.searchsorted(run, run[first] + away).clip(0, len(column) - 1)
    found = raster.triangle[rows, columns]
    # a run with a pixel that no triangle covers takes the one before it that has none
    whole_runs = np.flatnonzero((found >= 0).all(1))
    source = whole_runs[np.searchsorted(whole_runs, np.arange(len(turns)), side="right") - 1]
    found, rows, columns = found[source], rows[source], columns[source]
    share = raster.barycentrics[rows, columns]
    weave = np.stack(np.broadcast_arrays(turns[:, None] * 0.068, away[None]), 2)
    lift = _thickness(away)[None] + _folds(np.random.default_rng(seed), turns, away)
    index = np.arange(rows.size).reshape(rows.shape)
    return Shirt(
        corners=whole[found].reshape(-1, 3),
        share=share.reshape(-1, 3),
        lift=lift.ravel().astype(np.float32),
        triangles=_grid(index),
        light_triangles=_grid(index[::3, ::2]),
        weave=weave.reshape(-1, 2).astype(np.float32),
    )


def drape(shirt: Shirt, skin: NDArray[np.floating], normals: NDArray[np.floating]) -> NDArray[np.float32]:
    """The shirt's vertices (N, 3) on the posed skin with its normals."""
    on_skin = (skin[shirt.corners] * shirt.share[..., None]).sum(1)
    out = (normals[shirt.corners] * shirt.share[..., None]).sum(1)
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9)
    return (on_skin + shirt.lift[:, None] * out).astype(np.float32)


def neckline(turn: float) -> float:
    """Height of the collar's upper edge, metres, by the angle around the neck (0 in front)."""
    return float(np.interp(abs(turn), [0, 0.35, 0.8, 1.35, 2.0, np.pi], [0.618, 0.622, 0.634, 0.652, 0.662, 0.666]))


def _filled(column: NDArray[np.floating]) -> NDArray[np.floating]:
    known = np.flatnonzero(np.isfinite(column))
    return np.interp(np.arange(len(column)), known, column[known])


def _thickness(away: NDArray[np.floating]) -> NDArray[np.floating]:
    """Height of the cloth over the skin: a rounded collar, a seam, then loose cloth."""
    collar = 0.0030 * np.sqrt(np.clip((away + 0.002) / 0.004, 0, 1))
    seam = -0.0009 * np.exp(-0.5 * ((away - COLLAR_WIDTH) / 0.0009) ** 2)
    loose = 0.0022 * np.clip((away - COLLAR_WIDTH) / 0.03, 0, 1)
    return np.where(away < -0.0015, -0.002, collar + seam + loose)


def _folds(rng: np.random.Generator, turns: NDArray[np.floating], away: NDArray[np.floating]) -> NDArray[np.floating]:
    """Soft folds that run away from the collar, and a few across."""
    total = np.zeros((len(turns), len(away)))
    for _ in range(16):
        waves, phase, bend = rng.integers(3, 17), rng.uniform(0, 6.28), rng.normal(0, 14)
        total += rng.uniform(0.3, 1) * np.sin(waves * turns[:, None] + phase + bend * away[None])
    for _ in range(5):
        total += rng.uniform(0.2, 0.7) * np.sin(
            rng.uniform(40, 110) * away[None] + rng.integers(1, 5) * turns[:, None] + rng.uniform(0, 6.28)
        )
    return 0.00075 * total * np.clip((away[None] - COLLAR_WIDTH) / 0.05, 0, 1)


def _grid(index: NDArray[np.integer]) -> NDArray[np.int32]:
    """Triangles of a grid that closes around the neck."""
    after = np.roll(index, -1, 0)
    quads = np.stack([index[:, :-1], index[:, 1:], after[:, 1:], after[:, :-1]], 2).reshape(-1, 4)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
