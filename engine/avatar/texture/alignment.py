"""Frames laid onto what they agree on, by a smooth shift of each: what shape and sway leave is not seen where two of them meet.

Source: Q.-Y. Zhou, V. Koltun, Color Map Optimization for 3D Reconstruction with Consumer Depth Cameras, SIGGRAPH 2014,
section 5: points of the surface have colours, and pictures are bent by lattices until they show these; both in turns.
Three things differ here. Colours are robust means, since some frames show something else at a point. Small pictures
come first, so that larger shifts are found. The person's masks are one channel more: where the surface stands out of
the outline, the outline is drawn onto it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.image_shift import ImageShift
from engine.avatar.texture.lattice_step import lattice_step
from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.compiled import njit
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.resample import resized, size_within
from engine.render.rasterisation.visibility import depth_buffer, seen_points
from engine.render.textures.sampling import bilinear
from engine.render.textures.texture_bake import texel_raster


class Level(NamedTuple):
    """How finely frames are compared.

    side : pixels of their longer side.
    texels : along a side of the texture; their middles are the points.
    nodes : of the lattice, along the longer side.
    rounds : of the comparison.
    """

    side: int
    texels: int
    nodes: int
    rounds: int


ALIGNMENT_LEVELS = (Level(240, 256, 14, 4), Level(480, 448, 28, 3), Level(960, 640, 40, 2))
BLUR_SIGMA_PIXELS = 1.2
"""Pixels: the deviation by which pictures are blurred, so that between pixels they change as their slopes say."""
MAX_ALIGNED_DEGREES = 70.0
"""Between a normal and the way to the camera, from which on a frame has nothing to say about a point."""
MAX_SHIFT_SIDES = 1 / 30
"""The most that a place is shifted, in shares of the longer side: an arm that drifts by 5 cm, seen from two metres."""
OUTLIER_LEVELS = 20.0
"""Grey levels from which on a colour is thought to be that of something else: the scale of Cauchy's weights."""
LATE_OUTLIER_LEVELS = 60.0
"""Scale of Cauchy's weights, in grey levels, while a frame is still moved: what is a few pixels off looks like
something else, too."""
MASK_LEVELS = 60
"""Grey levels that lie between the person and the room, in the channel of the masks."""
CONSENSUS_ROUNDS = 3
"""How often colours that are not what most frames show are weighted less, and what they agree on is found anew."""


@dataclass(frozen=True)
class _Sight:
    """What a frame sees.

    layers : (H, W, 4) uint8, its small picture and the mask.
    points : (n,) by number, those that its camera sees.
    places : (n, 2) of them in the small picture.
    weights : (n,) how frontal they are.
    """

    layers: NDArray[np.uint8]
    points: NDArray[np.intp]
    places: NDArray[np.float32]
    weights: NDArray[np.float32]

    @property
    def side(self) -> int:
        """Pixels of the longer side."""
        return max(self.layers.shape)

    def shown(self, shift: ImageShift) -> NDArray[np.uint8]:
        """(n, 4) what is seen of the points."""
        return np.rint(bilinear(self.layers, shift.shifted(self.places))).astype(np.uint8)


def aligned(surface: ChartedSurface, views: Sequence[FrameView], gains: NDArray[np.floating]) -> tuple[FrameView, ...]:
    """The views, each with the shift by which it shows the surface as the others do; `gains` (N, 3) make exposures one. Their
    pictures are read once for each of `ALIGNMENT_LEVELS`."""
    shifts = [ImageShift.none(view.camera.size, max(view.camera.size)) for view in views]
    for level in ALIGNMENT_LEVELS:
        points, normals = _points(surface, level.texels)
        sights = [
            _sight(surface, points, normals, view, np.asarray(gain, np.float32), level.side)
            for view, gain in zip(views, gains, strict=True)
        ]
        shrunk = [sight.layers.shape[1] / view.camera.size[1] for sight, view in zip(sights, views, strict=True)]
        shifts = [
            shift.scaled(factor).finer(sight.layers.shape[:2], sight.side / level.nodes)
            for shift, factor, sight in zip(shifts, shrunk, sights, strict=True)
        ]
        for _ in range(level.rounds):
            colours = _agreed(len(points), sights, [one.shown(its) for one, its in zip(sights, shifts, strict=True)])
            shifts = [_stepped(sight, shift, colours) for sight, shift in zip(sights, shifts, strict=True)]
        shifts = [shift.scaled(1 / factor) for shift, factor in zip(shifts, shrunk, strict=True)]
    return tuple(replace(view, shift=shift) for view, shift in zip(views, shifts, strict=True))


def _points(surface: ChartedSurface, texels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (P, 3) of what is stitched, spread as texels are, and their unit normals (P, 3)."""
    raster = texel_raster(surface.atlas, texels)
    on = (raster.triangle >= 0) & surface.stitched[raster.triangle]
    corners, shares = surface.triangles[raster.triangle[on]], raster.barycentrics[on]
    normals = vertex_normals(surface.vertices, surface.triangles)
    facing = np.einsum("nk,nkd->nd", shares, normals[corners])
    facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-12)
    return np.einsum("nk,nkd->nd", shares, surface.vertices[corners]), facing


def _sight(
    surface: ChartedSurface,
    points: NDArray[np.float64],
    normals: NDArray[np.float64],
    view: FrameView,
    gain: NDArray[np.float32],
    side: int,
) -> _Sight:
    height, width = view.camera.size
    if max(height, width) > side:
        width, height = size_within((height, width), side)
    camera = replace(view.camera.scaled(width / view.camera.size[1]), size=(height, width))
    mask = np.full((height, width), MASK_LEVELS, np.uint8)
    if view.person is not None:
        mask = resized(view.person().astype(np.uint8) * np.uint8(MASK_LEVELS), (width, height))
    picture = np.clip(resized(view.picture(), (width, height)) * gain, 0, 255).astype(np.uint8)
    layers = cv2.GaussianBlur(np.dstack([picture, mask]), (0, 0), BLUR_SIGMA_PIXELS)
    pixels = camera.project(points)
    back = np.asarray(camera.eye) - points
    cosine = np.einsum("nk,nk->n", back, normals) / np.maximum(np.linalg.norm(back, axis=1), 1e-9)
    own = (cosine > np.cos(np.radians(MAX_ALIGNED_DEGREES))) & (pixels[:, 2] > 0) & (pixels[:, 2] < view.farthest)
    own[own] = seen_points(depth_buffer(camera, surface.vertices, surface.triangles), pixels[own])
    number = np.flatnonzero(own)
    return _Sight(np.asarray(layers), number, pixels[number, :2].copy(), (cosine[number] ** 2).astype(np.float32))


def _agreed(count: int, sights: Sequence[_Sight], shown: Sequence[NDArray[np.uint8]]) -> NDArray[np.float32]:
    """(P, 4) what frames agree on that points look like, all of it the person."""
    colours = np.zeros((count, 4), np.float32)
    for number in range(1 + CONSENSUS_ROUNDS):
        sums, total = np.zeros((count, 3), np.float32), np.full(count, 1e-6, np.float32)
        for sight, seen in zip(sights, shown, strict=True):
            _add_seen(sight.points, sight.weights, seen, colours, number > 0, sums, total)
        colours[:, :3] = sums / total[:, None]
    colours[:, 3] = MASK_LEVELS
    return colours


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _add_seen(
    points: np.ndarray,
    frontal: np.ndarray,
    seen: np.ndarray,
    colours: np.ndarray,
    agreed: bool,
    sums: np.ndarray,
    total: np.ndarray,
) -> None:
    """Add what one frame shows of its points, and with what weight; less where it is not what was `agreed` on before."""
    one, levels, scale = np.float32(1), np.float32(MASK_LEVELS), np.float32(OUTLIER_LEVELS**2)
    for n in range(len(points)):
        k = points[n]
        masked = np.float32(seen[n, 3]) / levels
        weight = frontal[n] * (masked * masked)
        if agreed:
            away = np.float32(0)
            for c in range(3):
                off = np.float32(seen[n, c]) - colours[k, c]
                away += off * off
            weight /= one + away / scale
        total[k] += weight
        for c in range(3):
            sums[k, c] += weight * np.float32(seen[n, c])


def _stepped(sight: _Sight, shift: ImageShift, colours: NDArray[np.float32]) -> ImageShift:
    """The shift after one step of Gauss and Newton towards the colours (P, 4)."""
    step = lattice_step(shift, sight.layers, sight.places, colours[sight.points], sight.weights, LATE_OUTLIER_LEVELS)
    limit = MAX_SHIFT_SIDES * sight.side
    return replace(shift, nodes=np.clip(shift.nodes + step, -limit, limit).astype(np.float32))
