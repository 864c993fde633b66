"""The eyeball as a layer of its own: a white in the target's tone, the iris completed to its disk, the catch-light in it.

What a picture shows of the white is a few pixels between lashes, shadow and iris: continued behind the lids they become
a white of lash colour with the smear of the old iris. So the white is modelled. It has the tint that whites have in the
picture (`whites`), is as light as this eye's are beside the skin below it, and as shaded by its lid as the picture
shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.lash_line import Lashes, upper_lashes
from engine.face_animation.eyes.socket_frame import socket_frame
from engine.face_animation.whites import eye_whites, white_tint
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import (
    LEFT_EYE,
    LEFT_EYE_CORNER_VERTICES,
    LEFT_IRIS,
    RIGHT_EYE,
    RIGHT_EYE_CORNER_VERTICES,
    RIGHT_IRIS,
)

EYE_OUTLINE_IRIS_CORNERS = (
    (RIGHT_EYE, RIGHT_IRIS, *RIGHT_EYE_CORNER_VERTICES),
    (LEFT_EYE, LEFT_IRIS, *LEFT_EYE_CORNER_VERTICES),
)
CHEEK_BELOW_EYE_VERTICES = ((117, 118, 119, 120, 100, 101), (346, 347, 348, 349, 329, 330))
"""Vertices of the cheek below each eye."""
LAYER_MARGIN_EYE_WIDTHS = 0.5
"""Around the opening, in eye widths: how far the eyeball's layer reaches behind the lids."""
MIN_EYE_WIDTH_PIXELS = 14.0
"""Pixels; smaller eyes move with the face's warp alone."""
WHITE_LIGHT_RANGE = (0.8, 1.5)
"""Of the light of the cheek below, between which the white's is."""
USUAL_WHITE_LIGHT = 1.0
"""The light of a white that the picture does not show, as a share of that of the cheek below."""
WHITE_HUE_RANGE = (0.0, 0.6)
"""Of the skin's hue, that there is in the white of an eye."""
LID_SHADOW_START_EYE_WIDTHS, LID_SHADOW_END_EYE_WIDTHS = 0.07, 0.14
"""Eye widths below the upper lid up to which it shades the white, and from which on it does not."""
MAX_LID_SHADE = 0.45
EYE_CORNER_SHADE_SHARE, EYE_CORNER_SHADE_EYE_WIDTHS = 0.4, 0.4
"""Of the light, that a white that is shaded by its lid has less in the eye's corners, and eye widths from them up to which it does: it is a ball."""
OWN_WHITE_SOFTNESS_EYE_WIDTHS, OWN_WHITE_MARGIN_EYE_WIDTHS = 0.05, 0.08
"""Eye widths over which what the picture shows of the white passes into the rest, and within which lids and iris count less and less."""
KEPT_LIGHT_RATIOS, KEPT_HUE_DIFFERENCES = (0.7, 0.88), (0.06, 0.12)
"""Of the white's light, from which on, and by how much the shares of red and blue may differ up to which, what the picture shows beside the iris is
kept as it is."""
IRIS_RINGS = 12
"""Rings of an iris, between which its colours are told apart."""
SPURIOUS_LEVELS, SPARED_LEVELS = 36.0, 80.0
"""Grey levels from the usual of its ring from which on a place of the iris is lash, lid or light, and at which it is so
wholly."""
GLINT_RADII = 0.8
"""Within which a place that is so much lighter is the catch-light's."""


@dataclass(frozen=True)
class Eyeball:
    """One eye's layer at rest, (h, w) pixels of the picture.

    white : (h, w, 3) float32, the eyeball without its iris.
    iris : (h, w, 3) float32, the iris and the pupil.
    iris_alpha : (h, w) float32 in [0, 1].
    glint : (h, w, 4) float32, the catch-light, and in [0, 1] where it is.
    corner : (2,) float32, where the layer's upper left pixel lies in the picture (x, y).
    ends : (2, 2) float32, the corners of the eye in the picture (x, y).
    width : pixels between them.
    opening : area between the lids, in squares of the width.
    lashes : of the upper lid.
    lid_shade : share of the light that the upper lid keeps from the white at its edge.
    centre : (2,) float64, where the iris is, from the middle between the corners, in eye widths along and across.
    radius : of the iris, in eye widths.
    """

    white: NDArray[np.float32]
    iris: NDArray[np.float32]
    iris_alpha: NDArray[np.float32]
    glint: NDArray[np.float32]
    corner: NDArray[np.float32]
    ends: NDArray[np.float32]
    width: float
    opening: float
    lashes: Lashes
    lid_shade: float
    centre: NDArray[np.float64]
    radius: float


def prepare_eyes(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> tuple[Eyeball | None, Eyeball | None]:
    """The two eyeballs of a target, right eye first; None where an eye is too small or shut in the picture."""
    return _prepare(rgb, mesh, 0), _prepare(rgb, mesh, 1)


def _prepare(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> Eyeball | None:
    contour, iris, outer, inner = EYE_OUTLINE_IRIS_CORNERS[side]
    ends = mesh[[outer, inner], :2].astype(np.float32)
    width = float(np.linalg.norm(ends[1] - ends[0]))
    opening = mesh[list(contour), :2].astype(np.float32)
    area = float(cv2.contourArea(opening))
    low = np.floor(opening.min(axis=0) - LAYER_MARGIN_EYE_WIDTHS * width).astype(int)
    high = np.ceil(opening.max(axis=0) + LAYER_MARGIN_EYE_WIDTHS * width).astype(int)
    low, high = np.maximum(low, 0), np.minimum(high, (rgb.shape[1], rgb.shape[0]))
    if width < MIN_EYE_WIDTH_PIXELS or area < 0.08 * width**2 or (high - low).min() < 8:
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
    beside = (seen > 0) & ~inside_iris
    if beside.sum() < 6:
        return None
    tone = _white(rgb, mesh, side)
    lid_shade = _lid_shade(patch, beside, below_lid(opening - low, patch.shape[:2]))
    light = white_light(lid_shade, (opening - low).astype(np.float32), patch.shape[:2])
    disk, glint = _complete_iris(patch, (seen > 0) & inside_iris, distance, radius)
    alpha = np.clip((1.08 * radius - distance) / max(0.2 * radius, 1.0) + 0.5, 0, 1)
    along = (ends[1] - ends[0]).astype(np.float64) / width
    off = mesh[iris[0], :2] - ends.mean(axis=0)
    return Eyeball(
        _with_own(tone, patch / light[..., None], beside, width),
        disk,
        alpha.astype(np.float32),
        glint,
        low.astype(np.float32),
        ends,
        width,
        area / width**2,
        upper_lashes(rgb, socket_frame(mesh, side)),
        lid_shade,
        np.array([off @ along, off @ (-along[1], along[0])]) / width,
        radius / width,
    )


def below_lid(opening: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(h, w) how far below the upper lid of an `opening` (16, 2), pixels of a part of `shape`, its pixels are, in eye widths."""
    across = (opening[8] - opening[0]).astype(np.float64)
    width = max(float(np.linalg.norm(across)), 1.0)
    right = across / width * (np.sign(across[0]) or 1.0)
    down = np.array([-right[1], right[0]])
    lid = opening[:9] @ np.column_stack([right, down])
    lid = lid[np.argsort(lid[:, 0])]
    ys, xs = np.mgrid[: shape[0], : shape[1]]
    places, heights = xs * right[0] + ys * right[1], xs * down[0] + ys * down[1]
    return np.asarray((heights - np.interp(places, lid[:, 0], lid[:, 1])) / width, np.float32)


def white_light(lid_shade: float, opening: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(h, w) of the light, what a lid that keeps `lid_shade` of it, and the corners of an `opening` (16, 2), leave for the white in a part of
    `shape`."""
    if lid_shade == 0:
        return np.ones(shape, np.float32)
    lid = np.clip(1 - below_lid(opening, shape) / LID_SHADOW_END_EYE_WIDTHS, 0, 1) ** 1.5
    ys, xs = np.mgrid[: shape[0], : shape[1]]
    across = (opening[8] - opening[0]).astype(np.float64)
    along = ((xs - opening[0, 0]) * across[0] + (ys - opening[0, 1]) * across[1]) / max(float(across @ across), 1.0)
    corner = np.clip(1 - np.minimum(along, 1 - along) / EYE_CORNER_SHADE_EYE_WIDTHS, 0, 1) ** 2
    return np.asarray((1 - lid_shade * lid) * (1 - EYE_CORNER_SHADE_SHARE * corner), np.float32)


def _with_own(
    tone: NDArray[np.float64], patch: NDArray[np.float32], beside: NDArray[np.bool_], width: float
) -> NDArray[np.float32]:
    """(h, w, 3) the white: of one `tone` (3,), but for what is seen `beside` (h, w) the iris in a `patch` (h, w, 3) of an eye of a `width`, pixels, and is
    white."""
    whole = np.asarray(tone, np.float32)
    ratio = patch @ LUMINANCE_WEIGHTS.astype(np.float32) / max(float(tone @ LUMINANCE_WEIGHTS), 1.0)
    hue = np.abs(patch / np.maximum(patch.sum(axis=-1, keepdims=True), 1) - whole / whole.sum()).max(axis=-1)
    own = np.clip((ratio - KEPT_LIGHT_RATIOS[0]) / (KEPT_LIGHT_RATIOS[1] - KEPT_LIGHT_RATIOS[0]), 0, 1)
    own *= np.clip((KEPT_HUE_DIFFERENCES[1] - hue) / (KEPT_HUE_DIFFERENCES[1] - KEPT_HUE_DIFFERENCES[0]), 0, 1)
    margin = max(OWN_WHITE_MARGIN_EYE_WIDTHS * width, 3.0)
    own *= np.minimum(cv2.distanceTransform(beside.astype(np.uint8), cv2.DIST_L2, 3) / margin, 1)
    soft = max(OWN_WHITE_SOFTNESS_EYE_WIDTHS * width, 1.0)
    own = np.asarray(cv2.GaussianBlur(own.astype(np.float32), (0, 0), soft)) * np.minimum(
        cv2.distanceTransform(beside.astype(np.uint8), cv2.DIST_L2, 3) / margin, 1
    )
    return np.asarray(whole + own[..., None] * (np.minimum(patch, 255) - whole), np.float32)


def _white(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float64]:
    """(3,) the colour of an eye's white: as light beside its cheek as that eye's is which shows it better."""
    shares = []
    for one in range(2):
        whites = eye_whites(rgb, mesh, one)
        if len(whites):
            shares.append(float((whites @ LUMINANCE_WEIGHTS).mean()) / _cheek(rgb, mesh, one))
    light = float(np.clip(max(shares, default=USUAL_WHITE_LIGHT), *WHITE_LIGHT_RANGE))
    return np.minimum(_cheek(rgb, mesh, side) * light * white_tint(rgb, mesh, WHITE_HUE_RANGE), 255.0)


def _cheek(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> float:
    """The luminance of the skin below an eye."""
    area = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillConvexPoly(
        area, cv2.convexHull(np.rint(mesh[list(CHEEK_BELOW_EYE_VERTICES[side]), :2]).astype(np.int32)), 1
    )
    return max(float(np.array(cv2.mean(rgb, area)[:3]) @ LUMINANCE_WEIGHTS), 1.0)


def _lid_shade(patch: NDArray[np.float32], beside: NDArray[np.bool_], depth: NDArray[np.float32]) -> float:
    """How much darker the white of a `patch` (h, w, 3) is at the upper lid than below: drawn eyes have no shade there."""
    light = patch @ LUMINANCE_WEIGHTS.astype(np.float32)
    near, far = (
        light[beside & (depth < LID_SHADOW_START_EYE_WIDTHS)],
        light[beside & (depth > LID_SHADOW_END_EYE_WIDTHS)],
    )
    if len(near) < 3 or len(far) < 3:
        return MAX_LID_SHADE / 2
    return float(np.clip(1 - np.median(near) / max(float(np.median(far)), 1.0), 0, MAX_LID_SHADE))


def _fill(points: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.uint8]:
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points).astype(np.int32)], 1)
    return mask


def _complete_iris(
    patch: NDArray[np.float32], known: NDArray[np.bool_], distance: NDArray[np.float32], radius: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The iris (h, w, 3) as a full disk, and the catch-light (h, w, 4) in it. What lids hide, and what is lash, shadow or light, takes
    the median colour at its distance from the pupil."""
    rings = np.minimum((distance / max(radius, 1) * IRIS_RINGS).astype(int), IRIS_RINGS + 3)
    filled, medians = [], []
    for ring in range(IRIS_RINGS + 4):
        colours = patch[known & (rings == ring)]
        if len(colours):
            filled.append(ring)
            medians.append(np.median(colours, axis=0))
    if not filled:
        return patch.copy(), np.zeros((*distance.shape, 4), np.float32)
    at = np.clip(distance / max(radius, 1) * IRIS_RINGS - 0.5, 0, IRIS_RINGS + 3)
    values = np.asarray(medians, np.float32)
    modelled = np.stack([np.interp(at, filled, values[:, k]) for k in range(3)], axis=-1).astype(np.float32)
    off = (patch - modelled) @ LUMINANCE_WEIGHTS.astype(np.float32)
    own = np.clip((SPARED_LEVELS - np.abs(off)) / (SPARED_LEVELS - SPURIOUS_LEVELS), 0, 1)
    edge = np.minimum(cv2.distanceTransform(known.astype(np.uint8), cv2.DIST_L2, 3) / 2, 1)
    disk = modelled + cv2.GaussianBlur(own * edge, (0, 0), 0.6)[..., None] * (patch - modelled)
    lit = np.clip((off - SPURIOUS_LEVELS) / (SPARED_LEVELS - SPURIOUS_LEVELS), 0, 1) * (
        known & (distance < GLINT_RADII * radius)
    )
    alpha = cv2.GaussianBlur(lit.astype(np.float32), (0, 0), 0.6)
    return np.asarray(disk, np.float32), np.dstack([patch, alpha]).astype(np.float32)
