"""What the floor looks like where somebody stands: a mosaic of its plane, from the frames that show each of its points.

The floor lies still and is flat, so that a place of it has one colour in all frames but for their exposure, shadows of who stands on
it included: what of a frame looks otherwise is not the floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture
from engine.render.textures.sampling import bilinear

MOSAIC_SPACING_METRES = 0.005
"""Metres between points of the mosaic."""
MOSAIC_MARGIN_METRES = 0.5
"""Metres that the mosaic reaches beyond the places that it is made around."""
MIN_SHOWN_SHARE = 1 / 3
"""Of the frames that have a point in their picture, how many must show it free: beside a foot it is seen from half of all sides,
beneath one from none, whatever a mask says of a few."""
TRIED_HEIGHTS_METRES = np.arange(-5, 6) * 0.003
"""Metres about where the floor is thought to be, within which it is looked for."""
MIN_FRAMES_SHOWING_FLOOR = 3
"""Frames that must show a point of the floor, at least."""
SEARCH_POINT_STEP = 4
"""Of the points along each side one in so many is asked where it is."""
GAIN_ROUNDS = 2
"""How often exposures and colours are found from each other."""
MIN_SIGMA = 2.0
"""Levels by which colours of a place differ, at least."""
NORMAL_QUANTILE = 0.9, 1.645
"""The quantile of absolute differences from which their sigma is taken, and how many sigmas it is."""
STRANGE_SHARE = 0.05
"""Of the floor's pixels, those that have any of its colours, not the one that the place has, and of all, those of any other."""
STRANGE_DENSITY = 256.0**-3
"""Of any colour at all, per level cubed."""


def cost_among_strange(density: NDArray[np.floating]) -> NDArray[np.float64]:
    """The negative logarithm of a density per level cubed where a few pixels have any colour at all: what is strange to all is no
    more likely of one than of another."""
    return np.asarray(-np.log((1 - STRANGE_SHARE) * density + STRANGE_SHARE * STRANGE_DENSITY))


@dataclass(frozen=True)
class FloorView:
    """`image` (H, W, 3) uint8, where the person may be `covered` (H, W) bool, and the `camera` as the room has it."""

    image: NDArray[np.uint8]
    covered: NDArray[np.bool_]
    camera: Camera


@dataclass(frozen=True)
class FloorMosaic:
    """The floor at `height` metres.

    corner : (2,) x and z of its first point, metres. Points are `spacing` * (column, row) from there.
    colours : (M, N, 3) float32 of the points, NaN where it is not known.
    gains : (F, 3) by which frames differ from it.
    sigma : (3,) levels by which they do beside.
    mixture : of all its colours.
    spacing : metres between its points.
    """

    height: float
    corner: NDArray[np.float64]
    colours: NDArray[np.float32]
    gains: NDArray[np.float32]
    sigma: NDArray[np.float64]
    mixture: ColourMixture
    spacing: float = MOSAIC_SPACING_METRES

    def cost(self, image: NDArray[np.uint8], gain: NDArray[np.floating], camera: Camera) -> NDArray[np.float64]:
        """(h, w) how unlikely each pixel of a picture (h, w, 3) is the floor's: a negative log-likelihood per level cubed. Where
        the mosaic has a place, its colour and those beside it are expected, elsewhere any of the floor."""
        colours = image / gain
        of_any = np.exp(-self.mixture.negative_log_likelihood(colours.reshape(-1, 3)).reshape(image.shape[:2]))
        known, off, spread = self._off(colours, camera)
        here = np.exp(-0.5 * (off**2).sum(-1)) / (spread + np.sqrt(2 * np.pi) * self.sigma).prod(-1)
        density = of_any.copy()
        density[known] = (1 - STRANGE_SHARE) * here + STRANGE_SHARE * of_any[known]
        return cost_among_strange(density)

    def deviations(self, image: NDArray[np.uint8], gain: NDArray[np.floating], camera: Camera) -> NDArray[np.float64]:
        """(h, w) sigmas by which each pixel of a picture (h, w, 3) differs from the floor at its place and beside, in the channel in which
        it differs most; NaN where the floor is not known."""
        known, off, _ = self._off(image / gain, camera)
        out = np.full(known.shape, np.nan)
        out[known] = off.max(-1)
        return out

    def _off(
        self, colours: NDArray[np.floating], camera: Camera
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.float32]]:
        """Where the floor is known that a camera sees, (h, w), and two arrays of these K pixels. (K, 3) are sigmas by
        which their `colours` (h, w, 3) lie beyond those of the place and beside it. (K, 3) are levels between the
        latter."""
        expected = self.seen_by(camera)
        known = np.isfinite(expected[..., 0])
        kernel = np.ones((3, 3), np.uint8)
        least = cv2.erode(np.where(known[..., None], expected, np.inf), kernel)[known]
        most = cv2.dilate(np.where(known[..., None], expected, -np.inf), kernel)[known]
        off = np.maximum(np.maximum(least - colours[known], colours[known] - most), 0) / self.sigma
        return known, off, most - least

    def seen_by(self, camera: Camera) -> NDArray[np.float32]:
        """(h, w, 3) the floor as a camera would see it with nobody there, NaN where that is not known."""
        y, x = np.indices(camera.size, np.float64)
        rays = camera.rays(np.stack([x, y], -1).reshape(-1, 2))
        eye = np.array(camera.eye)
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = (self.height - eye[1]) / rays[:, 1]
        reach[~(reach > 0)] = np.nan
        at = ((eye + reach[:, None] * rays)[:, [0, 2]] - self.corner) / self.spacing
        columns, rows = at.T.reshape(2, *camera.size).astype(np.float32)
        nothing = (np.nan,) * 3
        return np.asarray(cv2.remap(self.colours, columns, rows, cv2.INTER_LINEAR, None, cv2.BORDER_CONSTANT, nothing))


def floor_mosaic(
    views: Sequence[FloorView],
    around: NDArray[np.floating],
    height: float | None = None,
    spacing: float = MOSAIC_SPACING_METRES,
) -> FloorMosaic | None:
    """The mosaic around places (N, 3) near the floor, its points `spacing` metres apart; at `height`, or where about zero frames agree most.
    None where they show hardly any of it."""
    corner = around[:, [0, 2]].min(0) - MOSAIC_MARGIN_METRES
    size = np.ceil((around[:, [0, 2]].max(0) + MOSAIC_MARGIN_METRES - corner) / spacing).astype(int) + 1
    columns, rows = np.meshgrid(np.arange(size[0]), np.arange(size[1]))
    places = np.stack(
        [
            corner[0] + spacing * columns,
            np.zeros(columns.shape),
            corner[1] + spacing * rows,
        ],
        -1,
    )
    if height is None:
        height = _height(views, places[::SEARCH_POINT_STEP, ::SEARCH_POINT_STEP].reshape(-1, 3))
    shown = _shown(views, places.reshape(-1, 3) + np.array([0, height, 0]))
    known = np.flatnonzero(np.isfinite(shown[..., 0]).any(1))
    some = known[:: SEARCH_POINT_STEP**2]
    if len(some) < MIN_MIXTURE_PIXELS:
        return None
    gains = _gains(shown[some])
    colours = np.full((len(shown), 3), np.nan, np.float32)
    colours[known] = _medians(shown[known] / gains)[:, 0]
    off = np.abs(shown[some] / gains - colours[some, None])
    share, sigmas = NORMAL_QUANTILE
    sigma = np.maximum(np.nanquantile(off.reshape(-1, 3), share, axis=0) / sigmas, MIN_SIGMA)
    on_grid = colours.reshape(*columns.shape, 3)
    return FloorMosaic(float(height), corner, on_grid, gains, sigma, ColourMixture.fit(colours[known]), spacing)


def _height(views: Sequence[FloorView], places: NDArray[np.float64]) -> float:
    """Where the floor is: its places look alike in all frames."""
    scatter = []
    for height in TRIED_HEIGHTS_METRES:
        shown = _shown(views, places + np.array([0, height, 0]))
        gains = _gains(shown)
        off = np.abs(shown / gains - _medians(shown / gains))
        scatter.append(np.nanmean(off) if np.isfinite(off).any() else np.inf)
    return float(TRIED_HEIGHTS_METRES[int(np.argmin(scatter))])


def _shown(views: Sequence[FloorView], places: NDArray[np.float64]) -> NDArray[np.float32]:
    """(N, F, 3) the colours of places (N, 3) in the frames, NaN where they do not show them, and of all places that too few show."""
    shown = np.full((len(places), len(views), 3), np.nan, np.float32)
    in_picture = np.zeros(len(places), np.intp)
    for number, view in enumerate(views):
        pixels = view.camera.project(places)
        height, width = view.camera.size
        inside = (pixels[:, 2] > 0) & ((pixels[:, :2] >= 0) & (pixels[:, :2] <= [width - 1, height - 1])).all(1)
        in_picture += inside
        x, y = np.rint(pixels[inside, :2]).astype(np.intp).T
        free = np.flatnonzero(inside)[~view.covered[y, x]]
        shown[free, number] = bilinear(view.image, pixels[free])
    seldom = np.isfinite(shown[..., 0]).sum(1) < np.maximum(MIN_SHOWN_SHARE * in_picture, MIN_FRAMES_SHOWING_FLOOR)
    shown[seldom] = np.nan
    return shown


def _gains(shown: NDArray[np.float32]) -> NDArray[np.float32]:
    """(F, 3) by which frames differ from what most show of places, from colours (N, F, 3)."""
    gains = np.ones(shown.shape[1:], np.float32)
    for _ in range(GAIN_ROUNDS):
        usual = _medians(shown / gains)
        for gain, one in zip(gains, np.swapaxes(shown, 0, 1), strict=True):
            seen = np.isfinite(one[:, 0])
            if seen.sum() >= MIN_MIXTURE_PIXELS:
                gain[:] = np.median(one[seen], axis=0) / np.maximum(np.median(usual[seen], axis=0), 1.0)
    return gains


def _medians(shown: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, 1, 3) the medians of the F colours of each place, (N, F, 3), NaN where it has none."""
    ordered = np.sort(shown, axis=1)  # what is not a number comes last
    middle = np.maximum(np.isfinite(shown[..., 0]).sum(1) - 1, 0) // 2
    return np.take_along_axis(ordered, middle[:, None, None], axis=1)
