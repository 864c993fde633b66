"""Depth and normals of a view from its neighbours, by PatchMatch: each pixel has a small plane, good ones spread.

Sources: M. Bleyer, C. Rhemann, C. Rother, PatchMatch Stereo, BMVC 2011 (slanted windows); S. Galliani, K. Lasinger,
K. Schindler, Massively Parallel Multiview Stereopsis by Surface Normal Diffusion, ICCV 2015 (pixels of a chequerboard in
turn, the best of several sources); Q. Xu, W. Tao, Multi-Scale Geometric Consistency Guided Multi-View Stereo, CVPR 2019
(from coarse pictures to fine ones, planes fetched from afar where they fit best).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.geometry.multiview.window_matching import SAMPLE_COUNT, WINDOW_MEMORY, Plane, Ray, fill_window, plane_cost

FIRST_ROUNDS, FINER_ROUNDS = 3, 2
"""Rounds over all pixels in the coarsest pictures and in each finer one. By trial on films: what a round changes far enough is worth
more than further rounds."""
PROPAGATION_PIXELS = (1, 3, 5)
"""Pixels away in which a plane is fetched, in each of four directions: odd, so that they are of the other colour."""
REDRAWN_SHARE = 0.35
"""Share of the depth's range at which depths are drawn anew in the first round; it halves from round to round. The next finer pictures
begin with a quarter of it, and those after with half as much."""
RANDOM_NUMBERS = 1 << 16
"""Random numbers drawn for one run; pixels take theirs in turn."""
MIN_TILT_COSINE = 0.17
"""Least cosine between a plane's normal and the line of sight: 80 degrees."""


@dataclass(frozen=True)
class StereoView:
    """A picture to measure with: `grey` (H, W) float32 0 to 255, `figure` (H, W) bool the pixels of the body, and its
    `camera`, without distortion."""

    grey: NDArray[np.float32]
    figure: NDArray[np.bool_]
    camera: Camera

    def halved(self) -> StereoView:
        """The view at half the size."""
        camera = self.camera.scaled(0.5)
        size = camera.size[1], camera.size[0]
        figure = cv2.resize(self.figure.astype(np.float32), size, interpolation=cv2.INTER_AREA) >= 0.5
        grey = np.asarray(cv2.resize(self.grey, size, interpolation=cv2.INTER_AREA), np.float32)
        return StereoView(grey, figure, camera)


@dataclass(frozen=True)
class DepthMap:
    """What a view measures, at each pixel.

    depth : (H, W) float32, metres along the view axis, 0 where nothing is known.
    normals : (H, W, 3) float32 in the world, towards the camera.
    cost : (H, W) float32, one less the correlation with the sources, 0 to 2.
    """

    depth: NDArray[np.float32]
    normals: NDArray[np.float32]
    cost: NDArray[np.float32]


def nothing_measured(size: tuple[int, int]) -> DepthMap:
    """The depth map of a view of `size` (height, width) that nothing can be compared with."""
    return DepthMap(np.zeros(size, np.float32), np.zeros((*size, 3), np.float32), np.full(size, 2, np.float32))


def patch_match_stereo(
    view: StereoView, sources: Sequence[StereoView], reach: NDArray[np.float32], levels: int = 3, seed: int = 0
) -> DepthMap:
    """Measure a view's depth.

    Parameters
    ----------
    view, sources : the view and those that it is compared with; two at least see what is to be measured.
    reach : (H, W, 2) metres along the view axis between which the depth lies; zero where nothing is to be measured. Depths are
        sought more often near the first of the two.
    levels : sizes of the pictures, each half of the next.
    """
    draws = np.random.default_rng(seed).random((RANDOM_NUMBERS, 4), np.float32)
    views = [(view, list(sources))]
    for _ in range(levels - 1):
        coarser, others = views[-1]
        views.append((coarser.halved(), [source.halved() for source in others]))
    planes: NDArray[np.float32] | None = None
    for level in reversed(range(levels)):
        finer, others = views[level]
        size = finer.camera.size
        bounds = reach
        if level:
            bounds = np.asarray(cv2.resize(reach, size[::-1], interpolation=cv2.INTER_NEAREST), np.float32)
        measured = finer.figure & (bounds[..., 0] > 0)
        planes = _first_planes(measured, bounds, finer.camera, draws) if planes is None else _enlarged(planes, size)
        planes, cost = _searched(finer, others, planes, bounds, measured, draws, levels - 1 - level)
    assert planes is not None
    depth = np.where(measured, planes[..., 0], 0).astype(np.float32)
    return DepthMap(depth, np.asarray(planes[..., 1:] @ view.camera.rotation, np.float32), cost)


def _searched(
    view: StereoView,
    sources: Sequence[StereoView],
    planes: NDArray[np.float32],
    bounds: NDArray[np.float32],
    measured: NDArray[np.bool_],
    draws: NDArray[np.float32],
    enlargements: int,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The planes (H, W, 4) improved, and their costs (H, W); the pictures are the coarsest ones after so many `enlargements`."""
    lens = np.array([view.camera.focal, view.camera.focal * view.camera.aspect, *view.camera.centre], np.float32)
    greys = np.concatenate([source.grey.ravel() for source in sources])
    figures = np.stack([source.figure for source in sources])
    figure = np.ascontiguousarray(view.figure)
    relative = np.stack([_relative(view.camera, source.camera) for source in sources])
    cost = np.full(view.grey.shape, np.inf, np.float32)
    rounds, begun = (FINER_ROUNDS, enlargements + 1) if enlargements else (FIRST_ROUNDS, 0)
    for turn in range(rounds):
        spread = REDRAWN_SHARE * 0.5 ** (begun + turn)
        for colour in (0, 1):
            _visit(
                view.grey, figure, measured, bounds, lens, greys, figures, relative,
                planes, cost, draws, spread, 2 * turn + colour,
            )  # fmt: skip
    return planes, cost


def _relative(camera: Camera, source: Camera) -> NDArray[np.float32]:
    """(3, 4): from the view's axes, metres, to homogeneous pixels of a source."""
    turn = source.rotation @ camera.rotation.T
    shift = source.translation - turn @ camera.translation
    return np.asarray(source.intrinsics @ np.hstack([turn, shift[:, None]]), np.float32)


def _enlarged(planes: NDArray[np.float32], size: tuple[int, int]) -> NDArray[np.float32]:
    return np.ascontiguousarray(cv2.resize(planes, size[::-1], interpolation=cv2.INTER_NEAREST))


def _first_planes(
    measured: NDArray[np.bool_], bounds: NDArray[np.float32], camera: Camera, draws: NDArray[np.float32]
) -> NDArray[np.float32]:
    """(H, W, 4): random depths, most near the first bound, and random normals that face the camera."""
    index = np.arange(measured.size).reshape(measured.shape) % len(draws)
    drawn = draws[index]
    depth = bounds[..., 0] + (bounds[..., 1] - bounds[..., 0]) * drawn[..., 0] ** 3
    y, x = np.indices(measured.shape)
    sight = np.stack(
        [(x - camera.centre[0]) / camera.focal, (y - camera.centre[1]) / camera.focal, np.ones(x.shape)], -1
    )
    normals = -sight / np.linalg.norm(sight, axis=-1, keepdims=True) + (drawn[..., 1:] - 0.5)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.ascontiguousarray(np.concatenate([depth[..., None], normals], axis=-1), np.float32)


@njit(parallel=True, boundscheck=False, error_model="numpy", fastmath=True)
def _visit(
    grey: np.ndarray,
    figure: np.ndarray,
    measured: np.ndarray,
    bounds: np.ndarray,
    lens: np.ndarray,
    greys: np.ndarray,
    figures: np.ndarray,
    relative: np.ndarray,
    planes: np.ndarray,
    cost: np.ndarray,
    draws: np.ndarray,
    spread: float,
    visit: int,
) -> None:
    """Try at every second pixel the planes of its neighbours and one near its own; keep the best."""
    height, width = grey.shape
    for row in prange(height):
        y = np.int64(row)  # not the unsigned one of `prange`, for which all that is called would be compiled once more
        window, places = np.empty(WINDOW_MEMORY, np.float32), np.empty(SAMPLE_COUNT, np.int32)
        for x in range((y + visit) % 2, width, 2):
            if not measured[y, x]:
                continue
            ray = (np.float32(x) - lens[2]) / lens[0], (np.float32(y) - lens[3]) / lens[1]
            near, far = bounds[y, x, 0], bounds[y, x, 1]
            count, variance = fill_window(grey, figure, x, y, window)
            best = planes[y, x, 0], planes[y, x, 1], planes[y, x, 2], planes[y, x, 3]
            least = cost[y, x]
            if least == np.inf:
                least = plane_cost(best, ray, lens, window, places, count, variance, greys, figures, relative)
            for attempt in range(5):
                if attempt < 4:
                    trial = _fetched(planes, cost, measured, x, y, attempt, ray, lens)
                else:
                    drawn = draws[(y * width + x + visit * 7919) % RANDOM_NUMBERS]
                    trial = _changed(best, drawn, np.float32(spread), far - near, ray)
                if near <= trial[0] <= far:
                    found = plane_cost(trial, ray, lens, window, places, count, variance, greys, figures, relative)
                    if found < least:
                        least, best = found, trial
            planes[y, x, 0], planes[y, x, 1], planes[y, x, 2], planes[y, x, 3] = best
            cost[y, x] = least


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def _fetched(
    planes: np.ndarray,
    cost: np.ndarray,
    measured: np.ndarray,
    x: int,
    y: int,
    direction: int,
    ray: Ray,
    lens: np.ndarray,
) -> Plane:
    """The best plane in one of four directions, as the ray of pixel (x, y) meets it; depth 0 where there is none."""
    step_x, step_y = (direction == 0) - (direction == 1), (direction == 2) - (direction == 3)
    from_x, from_y, lowest = -1, -1, np.float32(np.inf)
    for reach in PROPAGATION_PIXELS:
        px, py = x + step_x * reach, y + step_y * reach
        if 0 <= px < cost.shape[1] and 0 <= py < cost.shape[0] and measured[py, px] and cost[py, px] < lowest:
            from_x, from_y, lowest = px, py, cost[py, px]
    depth, a, b, c = np.float32(0), np.float32(0), np.float32(0), np.float32(-1)
    if from_x >= 0:
        a, b, c = planes[from_y, from_x, 1], planes[from_y, from_x, 2], planes[from_y, from_x, 3]
        if not _turned_away(a, b, c, ray):
            there = (np.float32(from_x) - lens[2]) / lens[0], (np.float32(from_y) - lens[3]) / lens[1]
            depth = planes[from_y, from_x, 0] * (a * there[0] + b * there[1] + c) / (a * ray[0] + b * ray[1] + c)
    return depth, a, b, c


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def _changed(plane: Plane, row: np.ndarray, spread: np.float32, span: np.float32, ray: Ray) -> Plane:
    """A plane with another depth and another normal; depth 0 where it turns away from the camera."""
    half, width = np.float32(0.5), np.float32(4) * spread
    depth = plane[0] + spread * span * (row[0] - half)
    a, b, c = plane[1] + width * (row[1] - half), plane[2] + width * (row[2] - half), plane[3] + width * (row[3] - half)
    length = np.sqrt(a * a + b * b + c * c)
    a, b, c = a / length, b / length, c / length
    if _turned_away(a, b, c, ray):
        depth = np.float32(0)
    return depth, a, b, c


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def _turned_away(a: np.float32, b: np.float32, c: np.float32, ray: Ray) -> bool:
    """Whether a plane with normal (a, b, c) is seen too flatly."""
    length = np.sqrt(ray[0] * ray[0] + ray[1] * ray[1] + np.float32(1))
    return a * ray[0] + b * ray[1] + c > -np.float32(MIN_TILT_COSINE) * length
