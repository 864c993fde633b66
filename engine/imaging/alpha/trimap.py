"""Which pixels along an outline are to be matted, given a rough belief of where the layer is.

The belief (a network's probability, say) is coarse and smooth. Most of the outline needs a narrow band
around it, or cloth and skin grow soft. Two things reach out of that band: strands of hair over a plain
background, and slivers of that background seen between strands. Both show as colours that the plain
background explains too badly, or too well.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_pieces import pieces_touching
from engine.imaging.resample import resized

Mask = NDArray[np.float32]

CERTAIN_BELIEF = 0.8
"""Belief above which a pixel is taken for the layer, and below one minus which for the background."""
BAND_SHARE = 0.008
"""Half width of the band that is always matted, as a share of the square root of the layer's area."""
STRAND_REACH_SHARE = 0.12
"""How far strands are followed, as a share of the square root of the layer's area."""
BACKGROUND_SIGMA = 10.0
"""Standard deviation, in pixels, of the neighbourhood that predicts the background's colour."""
BACKGROUND_NOISE_GREY_LEVELS = 4.0
"""Grey levels (over three channels) of noise that even the plainest background has."""
MAX_PLAIN_SIGMA = 14.0
"""Largest standard deviation of a background, grey levels over three channels, against which strands can be told."""
WORKING_SIGMA = 3.0
"""Pixels of a Gaussian's standard deviation on the smaller picture in which a wide one is applied."""
MIN_SLIVER_CONTRAST_GREY_LEVELS = 60.0
"""Grey levels a channel by which a sliver must differ from the layer around it."""


@dataclass(frozen=True)
class Trimap:
    """What is known of a layer: `known` (H, W) is 1 inside, 0 outside, 0.5 where alpha is to be found;
    `prior` and `weight` (H, W) are the alpha believed there and how much (see `alpha_matte`)."""

    known: Mask
    prior: Mask
    weight: Mask


def outline_trimap(rgb: NDArray[np.uint8], belief: Mask, prior_weight: float = 0.03) -> Trimap:
    """Trimap of the layer that `belief` (H, W) in [0, 1] says is in `rgb` (H, W, 3) uint8."""
    inside = belief > 0.5
    size = float(np.sqrt(inside.sum()))
    band = max(3.0, BAND_SHARE * size)
    depth = _distance(inside) - _distance(~inside)
    known = np.full(belief.shape, 0.5, np.float32)
    known[(belief > CERTAIN_BELIEF) & (depth > band)] = 1
    known[(belief < 1 - CERTAIN_BELIEF) & (depth < -band)] = 0
    known[_islands(known)] = 1
    strands, slivers = _strands_and_slivers(rgb, depth, band, max(8.0, STRAND_REACH_SHARE * size))
    known[strands & (known == 0)] = 0.5
    known[slivers & (known == 1)] = 0.5
    weight = prior_weight * np.maximum(np.square(2 * belief - 1), 0.05)
    weight[strands | slivers] = 0.02 * prior_weight
    return Trimap(known, np.clip(4 * belief - 1.5, 0, 1).astype(np.float32), weight.astype(np.float32))


def like_plain_background(rgb: NDArray[np.uint8], background: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where (H, W) the colours of `rgb` (H, W, 3) uint8 are those of the plain `background` (H, W) nearby."""
    height, width = background.shape
    half = (max(1, width // 2), max(1, height // 2))
    known = resized(background.astype(np.float32), half) > 0.99
    mean, spread = _plain_background(resized(rgb.astype(np.float32), half), known)
    near = cv2.GaussianBlur(known.astype(np.float32), (0, 0), 1.5 * BACKGROUND_SIGMA) > 1e-3
    noise = resized(np.where(near, spread, 2 * MAX_PLAIN_SIGMA**2).astype(np.float32), (width, height))
    miss = _squared(rgb - resized(mean, (width, height)))
    return np.asarray((noise < MAX_PLAIN_SIGMA**2) & (miss < 9 * (noise + BACKGROUND_NOISE_GREY_LEVELS**2)))


def _distance(mask: NDArray[np.bool_]) -> Mask:
    return np.asarray(cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, 5), np.float32)


def _islands(known: Mask) -> NDArray[np.bool_]:
    """Doubtful parts that touch no background: inside of the layer, where only the belief wavered."""
    doubtful = known < 1
    return doubtful & ~pieces_touching(doubtful, known == 0, connectivity=8)


def _strands_and_slivers(
    rgb: NDArray[np.uint8], depth: Mask, band: float, reach: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Hair outside the band that hangs on to the layer, and background inside of it (both (H, W) bool)."""
    height, width = depth.shape
    half = (max(1, width // 2), max(1, height // 2))
    small = resized(rgb.astype(np.float32), half)
    small_depth = resized(depth, half)
    mean, spread = _plain_background(small, small_depth < -band)
    miss = _squared(rgb - resized(mean, (width, height)))
    noise = resized(spread, (width, height))
    plain = noise < MAX_PLAIN_SIGMA**2
    noise += BACKGROUND_NOISE_GREY_LEVELS**2

    odd = plain & (miss > 9 * noise) & (depth < -band) & (depth > -1.3 * reach)
    strands = _hanging_on(odd, depth, band, reach)

    layer = (small_depth > band).astype(np.float32)
    near = _local_mean(small, layer, 0.75 * BACKGROUND_SIGMA)
    spread = _local_mean(_squared(small - near), layer, 0.75 * BACKGROUND_SIGMA)
    layer_miss = _squared(rgb - resized(near, (width, height)))
    unlike = (layer_miss > 3 * MIN_SLIVER_CONTRAST_GREY_LEVELS**2) & (layer_miss > 9 * resized(spread, (width, height)))
    slivers = plain & (miss < 9 * noise) & unlike & (layer_miss > 9 * miss) & (depth > 0) & (depth < 4 * band)
    return _grown(strands, 2), _grown(slivers, 3)


def _hanging_on(odd: NDArray[np.bool_], depth: Mask, band: float, reach: float) -> NDArray[np.bool_]:
    """The odd pixels that begin at the layer and end within reach; what runs on belongs to the background."""
    closed = cv2.morphologyEx(odd.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    outside = (closed > 0) & (depth < -band)
    begin_here = pieces_touching(outside, depth > -band - 1.5, connectivity=8)
    return begin_here & ~pieces_touching(outside, depth < -reach, connectivity=8)


def _plain_background(image: NDArray[np.float32], background: NDArray[np.bool_]) -> tuple[NDArray[np.float32], Mask]:
    """Local mean colour (H, W, 3) and squared spread (H, W) of the background, strands left out of it."""
    odd = np.zeros(background.shape, bool)
    for _ in range(3):
        weight = (background & ~odd).astype(np.float32)
        near = _blurred(weight, BACKGROUND_SIGMA / 2)
        mean = _local_mean(image, weight, BACKGROUND_SIGMA / 2)
        mean = np.where(near[..., None] > 1e-3, mean, _local_mean(image, weight, 1.5 * BACKGROUND_SIGMA)).astype(
            np.float32
        )
        miss = _squared(image - mean)
        spread = _local_mean(miss, weight, 2 * BACKGROUND_SIGMA)
        odd = background & (miss > 9 * (spread + BACKGROUND_NOISE_GREY_LEVELS**2))
    return mean, spread


def _local_mean(values: NDArray[np.float32], weight: Mask, scale: float) -> NDArray[np.float32]:
    mass = np.maximum(_blurred(weight, scale), 1e-9)
    if values.ndim == 2:
        return np.asarray(_blurred(values * weight, scale) / mass, np.float32)
    return np.asarray(_blurred(values * weight[..., None], scale) / mass[..., None], np.float32)


def _blurred(values: NDArray[np.float32], scale: float) -> NDArray[np.float32]:
    """Blurred by a Gaussian of `scale` pixels; a wide one is done on a smaller picture, which shows no less."""
    step = int(scale // WORKING_SIGMA)
    if step < 2:
        return np.asarray(cv2.GaussianBlur(values, (0, 0), scale), np.float32)
    height, width = values.shape[:2]
    small = resized(values, (max(1, width // step), max(1, height // step)))
    scales = scale * small.shape[1] / width, scale * small.shape[0] / height
    return resized(np.asarray(cv2.GaussianBlur(small, (0, 0), *scales), np.float32), (width, height))


def _squared(difference: NDArray[np.float32]) -> Mask:
    return np.asarray(np.square(difference).sum(-1), np.float32)


def _grown(mask: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    return np.asarray(cv2.dilate(mask.astype(np.uint8), np.ones((2 * by + 1, 2 * by + 1), np.uint8)) > 0)
