"""The colours of lids that shut: of the skin above them at their crease, and at their edge of the skin below the eye, beside which they then lie.

Lashes, brows and strands of hair stand there too: each is a smooth curve from corner to corner through what most of the
skin is. Its lightness alone is believed wholly. Its hue is that of the cheeks where they are as light, in which shadows
are redder by as much as the picture's own skin (`shading_colour`). What lids differ from that by is one for both,
small, and not red. A socket's shadow that is made lighter as it is makes a red patch, and the hue of cheeks in the
light a grey one.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.shading_colour import shading_slopes
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_OUTER, RIGHT_EYE, eye_distance

UPPER_LID_STRIPS = (
    ((247, 30, 29, 27, 28, 56, 190), (246, 161, 160, 159, 158, 157, 173)),
    ((467, 260, 259, 257, 258, 286, 414), (466, 388, 387, 386, 385, 384, 398)),
)
"""Vertices of the skin above the upper lid, and of the lid's edge, from the eye's outer corner on; right eye first."""
BELOW_BROW_VERTICES = ((113, 225, 224, 223, 222, 221, 189), (342, 445, 444, 443, 442, 441, 413))
"""Vertices further up, below the brow."""
SKIN_BELOW_LID_VERTICES = (
    ((25, 110, 24, 23, 22, 26, 112), (31, 228, 229, 230, 231, 232, 233)),
    ((255, 339, 254, 253, 252, 256, 341), (261, 448, 449, 450, 451, 452, 453)),
)
"""Vertices of the skin below the lower lid's lashes, and further down, from the eye's outer corner on; right eye first."""
CHEEK_BELOW_LID_VERTICES = ((117, 118, 119, 120, 100, 101), (346, 347, 348, 349, 329, 330))
"""Vertices of the cheek below the eye, in the light that a shut lid is in."""
LIGHTER_SKIN_SHARE = 0.5
"""Share of the skin above, its lighter part, whose colour a lid has: the rest is shadow, of the brow or in the crease."""
MIN_CHEEK_SHARE = 0.8
"""A lid's brightness, as a share of the cheek's, under which it is in the socket's shadow, as a shut lid is not."""
HIGHLIGHT_CHEEK_SHARES = (1.0, 1.15)
"""Brightness of skin above a lid, as a share of the cheek's, from which on it is a highlight, and at which it has
nothing but the light's hue. Then a lid has the cheek's: as light as that it would be white."""
SOCKET_SHADE_SHARE = 0.35
"""The share that is left of what the socket's shadow makes a lid darker."""
CORNER_FADE_EYE_WIDTHS = 0.4
"""Eye widths from a corner over which the shade of the socket is taken off a lid."""
LID_COLOUR_POLYNOMIAL_DEGREE = 2
"""Of the polynomial from corner to corner that a lid's colours are."""
MAX_OWN_HUE = 0.08
"""By which the logarithm of a channel of both lids' colour differs from that of the cheeks at most, where they are as light."""
COLOUR_ROUNDS = 5
"""Rounds of reweighted least squares in which a lid's polynomial leaves out what is not of most of the skin's
colour."""


@dataclass(frozen=True)
class LidColours:
    """Of one upper lid, from the eye's outer corner to the inner one, (1, w, 3) float32 each: `above`, at its crease, and `below`, at its edge."""

    above: NDArray[np.float32]
    below: NDArray[np.float32]


def lid_colours(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> list[LidColours]:
    """Those of both lids, right one first, of a picture (H, W, 3) with its face at `mesh` (478, 2 or 3)."""
    cheeks = [_cheek(rgb, mesh, side) for side in range(2)]
    above: list[NDArray[np.float32]] = []
    below: list[NDArray[np.float32]] = []
    for side, cheek in enumerate(cheeks):
        rows = mesh[np.array([UPPER_LID_STRIPS[side][0], BELOW_BROW_VERTICES[side]]), :2]
        width = max(2, round(float(np.linalg.norm(np.diff(rows[0], axis=0), axis=1).sum())))
        for found, pair in ((above, rows), (below, mesh[np.array(SKIN_BELOW_LID_VERTICES[side]), :2])):
            found.append(_out_of_the_shadow(_along_the_lid(_lighter(_straightened(rgb, pair, width))), cheek))
    cheek, slopes = np.mean(cheeks, axis=0), _shading_slopes(rgb, mesh)
    return [
        LidColours(*ends) for ends in zip(*(of_one_hue(both, cheek, slopes) for both in (above, below)), strict=True)
    ]


def of_one_hue(
    colours: list[NDArray[np.float32]], cheek: NDArray[np.floating], slopes: NDArray[np.floating]
) -> list[NDArray[np.float32]]:
    """Colours (1, w, 3) of both lids, as light as they are, in the hue that a `cheek` (3,) has where it is as light.
    Its channels fall by `slopes` (3,) with the logarithm of luminance. What both lids have of their own stays beside
    that."""
    shown = np.maximum(np.concatenate(colours, axis=1)[0].astype(np.float64), 1.0)
    light = shown @ LUMINANCE_WEIGHTS
    usual = cheek * (light / float(cheek @ LUMINANCE_WEIGHTS))[:, None] ** slopes
    own = np.clip(np.log(shown / usual).mean(axis=0), -MAX_OWN_HUE, MAX_OWN_HUE)
    if own[0] > own[1]:  # no redder than the cheek
        own[:2] = own[:2].mean()
    found = usual * np.exp(own)
    found *= (light / (found @ LUMINANCE_WEIGHTS))[:, None]
    return [one[None].astype(np.float32) for one in np.split(found, [colours[0].shape[1]])]


def _shading_slopes(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """(3,) `shading_slopes` of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3)."""
    places = np.rint(mesh[:, :2]).astype(np.int32)
    low = np.maximum(places[list(FACE_OVAL)].min(axis=0), 0)
    high = np.minimum(places[list(FACE_OVAL)].max(axis=0) + 1, rgb.shape[1::-1])
    if (high - low).min() < 2:
        return np.ones(3, np.float32)
    skin = np.zeros((high - low)[::-1], np.uint8)
    cv2.fillPoly(skin, [places[list(FACE_OVAL)] - low], 1)
    for part in (LEFT_EYE, RIGHT_EYE, LIPS_OUTER):
        cv2.fillPoly(skin, [places[list(part)] - low], 0)
    return shading_slopes(rgb[low[1] : high[1], low[0] : high[0]], skin, float(eye_distance(mesh[:, :2])))


def _lighter(skin: NDArray[np.float32]) -> NDArray[np.float32]:
    """Of each column of a strip of skin (h, w, 3) the lighter part."""
    by_light = np.argsort(-skin.sum(axis=2), axis=0)[: max(1, round(LIGHTER_SKIN_SHARE * len(skin)))]
    return np.take_along_axis(skin, by_light[..., None], axis=0)


def _along_the_lid(above: NDArray[np.float32]) -> NDArray[np.float32]:
    """(1, w, 3) the polynomial through most of the colours (h, w, 3) from corner to corner."""
    height, width = above.shape[:2]
    basis = np.polynomial.polynomial.polyvander(np.linspace(-1, 1, width), LID_COLOUR_POLYNOMIAL_DEGREE)
    weights = np.ones((height, width))
    for _ in range(COLOUR_ROUNDS):
        normal = np.einsum("hw,wi,wj->ij", weights, basis, basis) + 1e-6 * np.eye(LID_COLOUR_POLYNOMIAL_DEGREE + 1)
        found = basis @ np.linalg.solve(normal, np.einsum("hw,wi,hwc->ic", weights, basis, above))
        away = np.linalg.norm(above - found, axis=2)
        weights = 1 / (1 + (away / max(float(np.median(away)), 1.0)) ** 2) ** 2
    return np.asarray(found[None].clip(0, 255), np.float32)


def _out_of_the_shadow(colours: NDArray[np.float32], cheek: NDArray[np.float32]) -> NDArray[np.float32]:
    """Colours (1, w, 3) that are much darker than the cheek (3,), made brighter in their own hue. Highlights are as the cheek is."""
    least = MIN_CHEEK_SHARE * float(cheek.mean())
    bright = np.maximum(colours.mean(axis=2, keepdims=True), 1)
    wanted = np.where(bright < least, least - SOCKET_SHADE_SHARE * (least - bright), bright)
    lit = smoothstep(bright / float(cheek.mean()), *HIGHLIGHT_CHEEK_SHARES)
    brighter = colours * (wanted / bright)
    width = colours.shape[1]
    from_corner = np.minimum(np.arange(width), np.arange(width)[::-1]) / (CORNER_FADE_EYE_WIDTHS * width)
    middle = np.sin(np.pi / 2 * np.clip(from_corner, 0, 1))[:, None] ** 2
    found = colours + middle * (brighter - colours)
    return np.asarray(found + lit * (cheek - found), np.float32)


def _cheek(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float32]:
    """Mean colour (3,) of the cheek below an eye."""
    area = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillConvexPoly(area, cv2.convexHull(mesh[list(CHEEK_BELOW_LID_VERTICES[side]), :2].round().astype(np.int32)), 1)
    return np.asarray(cv2.mean(rgb, area)[:3], np.float32) + 1


def _straightened(rgb: NDArray[np.uint8], rows: NDArray[np.floating], width: int) -> NDArray[np.float32]:
    """(h, width, 3) the skin between two `rows` (2, 7, 2) of places, at the picture's own resolution."""
    height = max(2, round(float(np.linalg.norm(rows[1] - rows[0], axis=1).mean())))
    along = np.linspace(0, 6, width)
    low, high = (np.column_stack([np.interp(along, range(7), row[:, k]) for k in range(2)]) for row in rows)
    up = np.linspace(0, 1, height)[:, None, None]
    x, y = cv2.split(((1 - up) * low + up * high).astype(np.float32))
    return cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
