"""Eyes that look and close: the eyeball stays behind, the lids' skin moves over it.

The paper warps the eye with the face, so that a closing lid squeezes the iris, and names eyes that do not
close as its limit (section 7.3). Here the eyeball is a layer of its own, prepared once: the white, continued
behind lids and iris, and the iris, completed to its full disk. A frame draws it into the opening that the
lids leave, with the iris where the driver looks.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS

EYE_VERTICES = ((RIGHT_EYE, RIGHT_IRIS, 33, 133), (LEFT_EYE, LEFT_IRIS, 263, 362))
LAYER_MARGIN_EYE_WIDTHS = 0.5
"""Around the opening, in eye widths: how far the eyeball's layer reaches behind the lids."""
FULL_OPENING_CHANGE = 0.15
"""Change of the opening's area, as a share of it, from which the eyeball's layer is fully drawn."""
FULL_GAZE_CHANGE = 0.03
"""Change of the gaze, in eye widths, from which the eyeball's layer is fully drawn."""
SHUT_SHARE = 0.1
"""Share of the picture's opening under which an eye is shut."""
CLOSING_GAP_SHARES = (0.75, 0.3)
"""Shares of the picture's opening at which a lid begins to take its own colours, and has."""
LASH_LINE_EYE_WIDTHS = 0.05
"""Width of the line of lashes on a lid that closes, in eye widths."""
MIN_EYE_WIDTH = 14.0
"""Pixels; smaller eyes move with the face's warp alone."""


@dataclass(frozen=True)
class Eyeball:
    """One eye's layer at rest, (h, w) pixels of the picture.

    white : (h, w, 3) float32, the eyeball without its iris.
    iris : (h, w, 3) float32, the iris and the pupil.
    iris_alpha : (h, w) float32 in [0, 1].
    corner : (2,) float32, where the layer's upper left pixel lies in the picture (x, y).
    ends : (2, 2) float32, the corners of the eye in the picture (x, y).
    width : pixels between them.
    opening : area between the lids, in squares of the width.
    lashes : (3,) float32, the colour of the upper lid's edge.
    """

    white: NDArray[np.float32]
    iris: NDArray[np.float32]
    iris_alpha: NDArray[np.float32]
    corner: NDArray[np.float32]
    ends: NDArray[np.float32]
    width: float
    opening: float
    lashes: NDArray[np.float32]


def gaze_offsets(meshes: NDArray[np.floating], neutral: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2, 2) how far each iris has moved against the neutral frame, right eye first, in eye widths along
    and across the line between the eye's corners. A shut eye does not look anywhere: it moves back to rest."""
    return iris_positions(meshes) - iris_positions(neutral[None])


def iris_positions(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2, 2) where each iris stands between the eye's corners, right eye first, from their middle, in eye widths along
    and across the line between them."""
    return np.stack([_look(meshes, side) for side in EYE_VERTICES], axis=1)


def _look(meshes: NDArray[np.floating], side: tuple) -> NDArray[np.float64]:
    _, iris, outer, inner = side
    a, b = meshes[:, outer, :2], meshes[:, inner, :2]
    along = b - a
    width = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / width
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    centre = meshes[:, iris[0], :2] - (a + b) / 2
    return np.stack([(centre * along).sum(1), (centre * across).sum(1)], axis=1) / width


def prepare_eyes(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> tuple[Eyeball | None, Eyeball | None]:
    """The two eyeballs of a target, right eye first; None where an eye is too small or shut in the picture."""
    return tuple(_prepare(rgb, mesh, side) for side in EYE_VERTICES)  # type: ignore[return-value]


def _prepare(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: tuple) -> Eyeball | None:
    contour, iris, outer, inner = side
    ends = mesh[[outer, inner], :2].astype(np.float32)
    width = float(np.linalg.norm(ends[1] - ends[0]))
    opening = mesh[list(contour), :2].astype(np.float32)
    area = float(cv2.contourArea(opening))
    low = np.floor(opening.min(axis=0) - LAYER_MARGIN_EYE_WIDTHS * width).astype(int)
    high = np.ceil(opening.max(axis=0) + LAYER_MARGIN_EYE_WIDTHS * width).astype(int)
    low, high = np.maximum(low, 0), np.minimum(high, (rgb.shape[1], rgb.shape[0]))
    if width < MIN_EYE_WIDTH or area < 0.08 * width**2 or (high - low).min() < 8:
        return None
    patch = rgb[low[1] : high[1], low[0] : high[0]].astype(np.float32)
    centre = mesh[iris[0], :2] - low
    radius = float(np.linalg.norm(mesh[list(iris[1:]), :2] - mesh[iris[0], :2], axis=1).mean())
    ys, xs = np.mgrid[: patch.shape[0], : patch.shape[1]].astype(np.float32)
    distance = np.hypot(xs - centre[0], ys - centre[1])
    seen = _fill(opening - low, patch.shape[:2])
    if width > 30:
        seen = np.asarray(cv2.erode(seen, np.ones((3, 3), np.uint8)), np.uint8)
    inside_iris = distance < 1.12 * radius
    white = _continue(patch, (seen > 0) & ~inside_iris)
    if white is None:
        return None
    disk = _complete_iris(patch, (seen > 0) & inside_iris, distance, radius)
    alpha = np.clip((1.08 * radius - distance) / max(0.12 * radius, 1.0) + 0.5, 0, 1)
    return Eyeball(
        white,
        disk,
        alpha.astype(np.float32),
        low.astype(np.float32),
        ends,
        width,
        area / width**2,
        _lashes(rgb, opening),
    )


def _lashes(rgb: NDArray[np.uint8], opening: NDArray[np.float32]) -> NDArray[np.float32]:
    """The darker half of the colours along the upper lid's edge, their mean (3,): there, or as far outside of it as lashes
    are wide, for a drawn eye may end beyond the mesh's."""
    middle, width = (opening[0] + opening[8]) / 2, np.linalg.norm(opening[8] - opening[0])
    away = opening[1:8] - middle
    outside = opening[1:8] + LASH_LINE_EYE_WIDTHS * width * away / np.maximum(
        np.linalg.norm(away, axis=1, keepdims=True), 1
    )
    edge = np.clip(np.round([opening[1:8], outside]).astype(int), 0, (rgb.shape[1] - 1, rgb.shape[0] - 1))
    colours = rgb[edge[..., 1], edge[..., 0]].astype(np.float32)
    darker = colours.sum(axis=-1).argmin(axis=0)
    colours = colours[darker, np.arange(7)]
    return np.asarray(colours[np.argsort(colours.sum(axis=1))[:4]].mean(axis=0), np.float32)


def _fill(points: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.uint8]:
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points).astype(np.int32)], 1)
    return mask


def _continue(patch: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32] | None:
    """The white of the eye continued over the whole layer by a wide normalised blur, exact where known."""
    if known.sum() < 6:
        return None
    total, weight = np.zeros_like(patch), np.zeros(patch.shape[:2], np.float32)
    mask = known.astype(np.float32)
    for sigma in (2.0, 5.0, 12.0, 40.0):
        total += cv2.GaussianBlur(patch * mask[..., None], (0, 0), sigma) * 10.0 ** (-sigma / 4)
        weight += cv2.GaussianBlur(mask, (0, 0), sigma) * 10.0 ** (-sigma / 4)
    smooth = total / np.maximum(weight, 1e-20)[..., None]
    edge = np.minimum(cv2.distanceTransform(known.astype(np.uint8), cv2.DIST_L2, 3) / 2, 1)[..., None]
    return np.asarray(smooth + edge * (patch - smooth), np.float32)


def _complete_iris(
    patch: NDArray[np.float32], known: NDArray[np.bool_], distance: NDArray[np.float32], radius: float
) -> NDArray[np.float32]:
    """The iris as a full disk: what the lids hide takes the mean colour at its distance from the pupil."""
    rings = np.minimum((distance / max(radius, 1) * 12).astype(int), 15)
    count = np.bincount(rings[known], minlength=16).astype(np.float32)
    total = np.stack([np.bincount(rings[known], patch[..., k][known], 16) for k in range(3)], axis=1)
    filled = np.flatnonzero(count > 0)
    if len(filled) == 0:
        return patch.copy()
    mean = total[filled] / count[filled, None]
    profile = np.stack([np.interp(np.arange(16), filled, mean[:, k]) for k in range(3)], axis=1)
    modelled = cv2.GaussianBlur(profile[rings].astype(np.float32), (0, 0), max(radius / 12, 0.5))
    edge = np.minimum(cv2.distanceTransform(known.astype(np.uint8), cv2.DIST_L2, 3) / 2, 1)[..., None]
    return np.asarray(modelled + edge * (patch - modelled), np.float32)


def draw_eye(
    frame: NDArray[np.uint8], eye: Eyeball, mesh: NDArray[np.floating], side: int, look: NDArray[np.floating]
) -> None:
    """Draw an eyeball into the opening that the lids leave in a frame, in place.

    Parameters
    ----------
    mesh : (478, 2) the face in this frame. side : 0 right, 1 left. look : (2,) from `gaze_offsets`.
    """
    contour, _, outer, inner = EYE_VERTICES[side]
    opening = mesh[list(contour), :2].astype(np.float32)
    low = np.maximum(np.floor(opening.min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(opening.max(axis=0)).astype(int) + 2, (frame.shape[1], frame.shape[0]))
    if (high - low).min() < 2:
        return
    shape = (int(high[1] - low[1]), int(high[0] - low[0]))
    cover = np.zeros(shape, np.uint8)
    cv2.fillPoly(cover, [np.round((opening - low) * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    place = _place(eye, mesh[[outer, inner], :2], low)
    white = cv2.warpAffine(eye.white, place, shape[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    along = place[:, :2] @ (eye.ends[1] - eye.ends[0])
    across = np.array([-along[1], along[0]])
    shifted = place.copy()
    shifted[:, 2] += look[0] * along + look[1] * across
    iris = cv2.warpAffine(eye.iris, shifted, shape[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    disk = cv2.warpAffine(eye.iris_alpha, shifted, shape[::-1], flags=cv2.INTER_LINEAR)[..., None]
    ball = white + disk * (iris - white)
    below = frame[low[1] : high[1], low[0] : high[0]].astype(np.float32)
    alpha = _departure(eye, opening, look) * cover[..., None].astype(np.float32) / 255
    drawn = below + alpha * (ball - below)
    seam = lid_closing_share(eye, mesh, side) * _lash_line(opening - low, shape)[..., None]
    drawn += seam * (eye.lashes - drawn)
    frame[low[1] : high[1], low[0] : high[0]] = np.clip(drawn + 0.5, 0, 255).astype(np.uint8)


def lid_closing_share(eye: Eyeball, mesh: NDArray[np.floating], side: int) -> float:
    """How far the upper lid of a face (478, 2) takes its own colours: 0 as long as it is open, 1 long before it is shut."""
    by = _open_by(eye, mesh[list(EYE_VERTICES[side][0]), :2].astype(np.float32))
    return float(np.clip((CLOSING_GAP_SHARES[0] - by) / (CLOSING_GAP_SHARES[0] - CLOSING_GAP_SHARES[1]), 0, 1))


def _lash_line(opening: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """The upper lid's edge, as wide as lashes are in its middle, (h, w) in [0, 1]."""
    line = opening[:9]
    width = float(np.linalg.norm(opening[8] - opening[0]))
    out = np.array([[0, -0.5]]) * LASH_LINE_EYE_WIDTHS * width * np.sin(np.linspace(0, np.pi, 9))[:, None] ** 0.5
    band = np.concatenate([line + out, (line - out)[::-1]])
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(band * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    cv2.polylines(mask, [np.round(line * 16).astype(np.int32)], False, 255, 1, cv2.LINE_AA, 4)
    return np.asarray(
        cv2.GaussianBlur(mask, (0, 0), max(LASH_LINE_EYE_WIDTHS * width / 4, 0.4)), np.float32
    ) / np.float32(255)


def _departure(eye: Eyeball, opening: NDArray[np.float32], look: NDArray[np.floating]) -> float:
    """How far the layer is drawn: 0 where lids and gaze are as in the picture, 1 where they are not, and 0
    again where the lids have met, so that nothing shines through their seam."""
    open_by = _open_by(eye, opening)
    moved = max(abs(open_by - 1) / FULL_OPENING_CHANGE, float(np.hypot(*look)) / FULL_GAZE_CHANGE)
    return min(moved, 1.0) * min(max((open_by - SHUT_SHARE) / SHUT_SHARE, 0.0), 1.0)


def _open_by(eye: Eyeball, opening: NDArray[np.float32]) -> float:
    """Area of the opening against the picture's."""
    width = float(np.linalg.norm(opening[8] - opening[0]))
    return float(cv2.contourArea(opening)) / max(width, 1.0) ** 2 / eye.opening


def _place(eye: Eyeball, ends: NDArray[np.floating], low: NDArray[np.int64]) -> NDArray[np.float64]:
    """(2, 3) from the layer's pixels to those of the box at `low`: the similarity of the eye's corners."""
    before, after = (eye.ends[1] - eye.ends[0]).astype(float), (ends[1] - ends[0]).astype(float)
    norm = float(before @ before)
    c, s = float(before @ after) / norm, float(before[0] * after[1] - before[1] * after[0]) / norm
    linear = np.array([[c, -s], [s, c]])
    shift = ends.mean(axis=0) - low - linear @ (eye.ends.mean(axis=0) - eye.corner)
    return np.column_stack([linear, shift])
