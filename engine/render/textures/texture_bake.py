"""Pictures onto the texture of a surface: each texel gets the colours of the pixels that show it.

A view gives to a texel what it sees of it, the less the more it is seen from the side. It gives nothing behind other parts
of the surface (depth buffer), and nothing beside an edge of them, where cameras that are a little off take the wrong one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.texture_charts.texture_atlas import TextureAtlas
from engine.imaging.filling.nearest import nearest_in
from engine.render.rasterisation.rasteriser import Raster, rasterise
from engine.render.rasterisation.visibility import (
    DEPTH_JUMP,
    DEPTH_SLACK,
    DepthBuffer,
    depth_buffer,
    shows,
    view_cosines,
)

MAX_VIEW_DEGREES = 45.0
"""Degrees between a view and the surface's normal up to which it gives anything."""
STRIP_TEXELS = 1 << 18
"""Texels that are worked on at once: memory stays within the texture's own."""


@dataclass(frozen=True)
class View:
    """A `picture` (H, W, 3) uint8 of the surface by a `camera` of its size.

    trust : (H, W) float32 >= 0: what each of its pixels weighs, all the same by default.
    paints : (T,) bool, the triangles to which it gives anything, all by default.
    gain : what its colours are multiplied by, for exposures that differ.
    """

    picture: NDArray[np.uint8]
    camera: Camera
    trust: NDArray[np.float32] | None = None
    paints: NDArray[np.bool_] | None = None
    gain: float = 1.0


@dataclass(frozen=True)
class ViewWeighting:
    """What a view's pixels weigh on the surface, and which of them show it at all."""

    max_degrees: float = MAX_VIEW_DEGREES
    """Between a view and the surface's normal, up to which it gives anything."""
    power: float = 1.0
    """Of the cosine to the normal: 0 gives all alike, much makes the most frontal win."""
    depth_slack: float = DEPTH_SLACK
    """As `engine.render.rasterisation.visibility.DEPTH_SLACK` says, in the unit of the vertices."""
    depth_jump: float = DEPTH_JUMP
    """As `engine.render.rasterisation.visibility.DEPTH_JUMP` says, in the unit of the vertices."""


@dataclass(frozen=True)
class BakedTexture:
    """colours : (S, S, 3) float32, 0 to 255, zero where no view gave any.
    weights : (S, S) float32, what all views gave to each texel.
    charts : (S, S) int32, which chart each texel shows, -1 beside them.
    """

    colours: NDArray[np.float32]
    weights: NDArray[np.float32]
    charts: NDArray[np.int32]


def texel_raster(atlas: TextureAtlas, size: int) -> Raster:
    """What each texel's centre shows of the surface, (S, S); its depth says nothing. Of charts that lie on each other, the
    triangle that comes first."""
    flat = np.zeros((len(atlas.uv), 3), np.float32)
    flat[:, :2] = atlas.uv * size - 0.5
    return rasterise(flat, atlas.corners, (size, size))


def charts_of(atlas: TextureAtlas, texels: Raster) -> NDArray[np.int32]:
    """(S, S) which chart each texel of `texel_raster` shows, -1 beside them."""
    return np.where(texels.triangle >= 0, atlas.charts[texels.triangle], -1).astype(np.int32)


def bake(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    atlas: TextureAtlas,
    views: Iterable[View],
    size: int,
    weighting: ViewWeighting = ViewWeighting(),
    normals: NDArray[np.floating] | None = None,
) -> BakedTexture:
    """The mean of what all views see, weighted by what each texel weighs in them.

    Parameters
    ----------
    vertices, triangles : the surface, (V, 3) float and (T, 3), counter-clockwise seen from outside; triangle `t` lies on
        the texture as the atlas' triangle `t`.
    views : one after the other; only one of them is held at a time.
    size : texels along a side of the texture, whose centres are looked up.
    weighting : what each view weighs.
    normals : (V, 3) unit normals by which to judge from where a point is seen; by default the surface's own. Smooth ones
        make fewer patches.

    Colours are taken bilinearly. Raises ValueError where triangles and atlas, or a view's arrays, do not fit.
    """
    if len(triangles) != len(atlas.corners):
        raise ValueError("the atlas has other triangles than the surface")
    points, faces = np.asarray(vertices, np.float64), np.ascontiguousarray(triangles, np.int32)
    towards = np.asarray(vertex_normals(points, faces) if normals is None else normals, np.float64)
    texels = texel_raster(atlas, size)
    covered = np.flatnonzero(texels.triangle >= 0)
    shown, places = texels.triangle.ravel()[covered], texels.barycentrics.reshape(-1, 3)[covered]
    sums, weights = np.zeros((size * size, 3), np.float32), np.zeros(size * size, np.float32)
    for view in views:
        _check(view, len(faces))
        cosine = view_cosines(view.camera, points, towards)
        pixels = view.camera.project(points)
        buffer = depth_buffer(view.camera, points, faces, weighting.depth_jump)
        fronting = (cosine[faces] > 0).any(1) & (pixels[faces, 2] > 0).all(1)
        if view.paints is not None:
            fronting &= view.paints
        own = np.flatnonzero(fronting[shown])
        trust = np.ones(view.camera.size, np.float32) if view.trust is None else view.trust
        pixels_seen = _ViewPixels(view.picture, np.asarray(trust, np.float32), buffer)
        least = np.cos(np.radians(weighting.max_degrees))
        terms = _WeightTerms(view.gain, least, weighting.power, weighting.depth_slack)
        for start in range(0, len(own), STRIP_TEXELS):
            here = own[start : start + STRIP_TEXELS]
            corners, share = faces[shown[here]], places[here]
            where = view.camera.project(np.einsum("nk,nkd->nd", share, points[corners]))
            facing = (share * cosine[corners]).sum(1)
            _gather(pixels_seen, terms, where, facing, covered[here], sums, weights)
    np.divide(sums, weights[:, None], out=sums, where=weights[:, None] > 0)
    return BakedTexture(sums.reshape(size, size, 3), weights.reshape(size, size), charts_of(atlas, texels))


def pad_charts(texture: NDArray, known: NDArray[np.bool_], charts: NDArray[np.int32]) -> NDArray:
    """A texture (S, S, C) whose texels beside the charts have colours of the nearest chart.

    Each has that of the nearest texel that is `known` (S, S) there, so that neither filtering nor smaller sizes bring in
    anything else. `charts` (S, S) is as `BakedTexture` has it. Texels of the charts stay, those that are not known, too.

    Smaller sizes keep charts apart as long as the gap between two (`chart_gap`) is four of their texels. A chart of which
    nothing is known takes from others.
    """
    on = charts >= 0
    told = known & on
    if not told.any():
        return texture
    rows, columns = nearest_in(told)
    if (~told & on).any():  # first to the nearest chart, then to the nearest of it that is known
        chart_rows, chart_columns = nearest_in(on)
        nearest_chart = charts[chart_rows, chart_columns]
        wrong = ~on & (nearest_chart != charts[rows, columns])
        for chart in np.unique(nearest_chart[wrong]):
            own, here = told & (charts == chart), wrong & (nearest_chart == chart)
            if own.any():
                box = tuple(slice(at.min(), at.max() + 1) for at in np.nonzero(own | here))
                found = nearest_in(own[box])
                for numbers, near, first in zip((rows, columns), found, box, strict=True):
                    numbers[box][here[box]] = near[here[box]] + first.start
    return np.where(on[..., None], texture, texture[rows, columns])


def chart_gap(charts: NDArray[np.int32]) -> float:
    """The least number of texels between texels of two charts (S, S), -1 beside them, to 5%; infinite where there is one."""
    on = charts >= 0
    if not on.any():
        return float("inf")
    rows, columns = nearest_in(on)
    owner = charts[rows, columns]
    away = np.hypot(rows - np.arange(len(charts))[:, None], columns - np.arange(charts.shape[1])).astype(np.float32)
    gaps = [float("inf")]
    for axis in (0, 1):
        first, second = (np.take(owner, range(k, charts.shape[axis] - 1 + k), axis) for k in (0, 1))
        apart = first != second
        between = np.take(away, range(charts.shape[axis] - 1), axis) + np.take(away, range(1, charts.shape[axis]), axis)
        if apart.any():
            gaps.append(float(between[apart].min()))
    return min(gaps)


def _check(view: View, triangles: int) -> None:
    size = view.camera.size
    if view.picture.shape != (*size, 3) or view.picture.dtype != np.uint8:
        raise ValueError(f"a view's picture is (H, W, 3) uint8, of its camera's size {size}: {view.picture.shape}")
    if view.trust is not None and view.trust.shape != size:
        raise ValueError("a view's trust has another size than its picture")
    if view.paints is not None and view.paints.shape != (triangles,):
        raise ValueError("a view paints other triangles than the surface has")


class _ViewPixels(NamedTuple):
    """What a view has of each pixel (H, W): its colour, how far it is trusted, and the depth of the surface."""

    picture: np.ndarray
    trust: np.ndarray
    buffer: DepthBuffer


class _WeightTerms(NamedTuple):
    """How much a view counts: its gain, the least cosine to the normal and its power, and how far behind is still seen."""

    gain: float
    min_cosine: float
    power: float
    slack: float


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _gather(
    view: _ViewPixels,
    terms: _WeightTerms,
    where: np.ndarray,
    facing: np.ndarray,
    texels: np.ndarray,
    sums: np.ndarray,
    weights: np.ndarray,
) -> None:
    """Add what a view shows at `where` (N, 3), at cosines `facing` (N,) to the normal, to the `texels` (N,) that are there."""
    picture, trust, buffer = view
    gain, least, power, slack = terms
    height, width = trust.shape
    for i in range(len(texels)):
        x, y = where[i, 0], where[i, 1]
        if not facing[i] >= least or not shows(buffer, x, y, where[i, 2], slack):
            continue
        left, top = max(min(int(x), width - 2), 0), max(min(int(y), height - 2), 0)
        right, bottom = min(left + 1, width - 1), min(top + 1, height - 1)
        fx, fy = x - left, y - top
        a, b, c, d = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
        # pixels that are not trusted lend no colour either
        a, b = a * trust[top, left], b * trust[top, right]
        c, d = c * trust[bottom, left], d * trust[bottom, right]
        share = facing[i] ** power
        t = texels[i]
        for k in range(3):
            value = a * picture[top, left, k] + b * picture[top, right, k]
            value += c * picture[bottom, left, k] + d * picture[bottom, right, k]
            sums[t, k] += share * gain * value
        weights[t] += share * (a + b + c + d)
