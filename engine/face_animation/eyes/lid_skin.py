"""The skin of upper lids that close: a picture of open eyes shows hardly any of it.

What is seen of it there, a narrow strip with lashes and their shadow, would be drawn out over the whole eye and make a
shut one black. So a closing lid takes the colours of the skin above it, more the further it closes. Lashes, brows and strands of
hair stand there too: its colours are a smooth curve from corner to corner through what most of it is, and its grain is the cheek's.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.smoothstep import smoothstep
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.landmarks import LEFT_EYE_CORNER_VERTICES, RIGHT_EYE_CORNER_VERTICES

UPPER_LID_STRIPS = (
    ((247, 30, 29, 27, 28, 56, 190), (246, 161, 160, 159, 158, 157, 173)),
    ((467, 260, 259, 257, 258, 286, 414), (466, 388, 387, 386, 385, 384, 398)),
)
"""Vertices of the skin above the upper lid, and of the lid's edge, from the eye's outer corner on; right eye first."""
EYE_CORNER_VERTEX_PAIRS = (RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES)
"""Vertices at which both lids of an eye end; right eye first."""
BELOW_BROW_VERTICES = ((113, 225, 224, 223, 222, 221, 189), (342, 445, 444, 443, 442, 441, 413))
"""Vertices further up, below the brow."""
LOWER_LID_EDGES = ((7, 163, 144, 145, 153, 154, 155), (249, 390, 373, 374, 380, 381, 382))
"""Vertices of the lower lid's edge."""
CHEEK_BELOW_LID_VERTICES = ((117, 118, 119, 120, 100, 101), (346, 347, 348, 349, 329, 330))
"""Vertices of the cheek below the eye, in the light that a shut lid is in."""
COLOUR_BLEND_SHARE = 0.4
"""Share of the way from the skin above to the lid's edge over which the colours go over."""
LID_COLOUR_REACH_SHARE = 0.6
"""Share of the way from the skin above the lid up to below the brow that a lid's colours reach: upper lashes stand
there in a picture."""
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
COLOUR_ROUNDS = 5
"""Rounds of reweighted least squares in which a lid's polynomial leaves out what is not of most of the skin's
colour."""
CHEEK_PATCH_EYE_WIDTHS = (0.9, 0.35)
"""Width and height, eye widths, of the place on the cheek whose grain a lid has."""
GRAIN_EYE_WIDTHS = 0.1
"""Eye widths below which what is seen of the skin is its grain."""
MAX_GRAIN_GREY_LEVELS = 12.0
"""Grey levels up to which structure counts as grain: what is stronger are lashes, brows and paint."""
EDGE_SHADE_SHARE = 0.16
"""By how much a lid is darker at its edge."""
BALL_LIGHT_SHARE = 0.12
"""By how much a lid is lighter in its middle, over the eyeball."""
CREASE_PLACE_SHARE, CREASE_WIDTH_SHARE, CREASE_SHADE_SHARE = 0.36, 0.14, 0.08
"""Where the crease above a lid is, as a share of the way from the skin above to the lid's edge, how wide it is, and by
how much it is darker there: soft, for a line would be an outline."""
SEAM_COVER_EYE_WIDTHS = 0.05
"""Eye widths around the line where lids meet, and beyond its ends, that are of the lid's colour. The tracker's eye and
the picture's differ by as much, and what is left of the picture's beside the line are specks of white and lash."""
_STRIP_TRIANGLES = np.array([t for k in range(8) for t in ((k, k + 1, 9 + k), (k + 1, 10 + k, 9 + k))], np.int32)


def lid_skins(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> list[NDArray[np.float32]]:
    """The skin of both upper lids, right one first, of a target (H, W, 3) with its face at `mesh` (478, 2 or 3). Each
    is (h, w, 3) float32, from the crease down to the edge, and from the eye's outer corner to the inner one."""
    return [_skin(rgb, mesh, side) for side in range(2)]


def draw_lid(
    frame: NDArray[np.uint8], skin: NDArray[np.float32], mesh: NDArray[np.floating], side: int, share: float
) -> None:
    """Give the upper lid in a frame (H, W, 3), in place, a `share` of its `skin` (h, w, 3).

    Parameters
    ----------
    mesh : (478, 2) the face in this frame. side : 0 right, 1 left.
    """
    points = _strip(mesh, side)
    low = np.maximum(np.floor(points.min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(points.max(axis=0)).astype(int) + 1, frame.shape[1::-1])
    if share == 0 or (high - low).min() < 2:
        return
    along = np.concatenate([[0], np.linspace(0, skin.shape[1] - 1, 7), [skin.shape[1] - 1]])
    field = inverse_map(
        (points - low).astype(np.float32),
        np.column_stack([np.tile(along, 2), np.repeat([0, 1], 9)]).astype(np.float32),
        _STRIP_TRIANGLES,
        (int(high[1] - low[1]), int(high[0] - low[0])),
        outside=-1.0,
    )
    part = frame[low[1] : high[1], low[0] : high[0]]
    down = field[..., 1]
    seen = cv2.remap(skin, field[..., 0], down * (len(skin) - 1), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    t = np.clip(down[..., None] / COLOUR_BLEND_SHARE, 0, 1)
    part[:] = np.clip(part + share * t * t * (3 - 2 * t) * (seen - part) + 0.5, 0, 255).astype(np.uint8)
    _cover_seam(frame, skin, points[9:], share)


def _cover_seam(frame: NDArray[np.uint8], skin: NDArray[np.float32], edge: NDArray[np.floating], share: float) -> None:
    """Give what is around the edge (9, 2) of a lid, from corner to corner, a `share` of the colours of its `skin` (h, w, 3) there, in place."""
    across = edge[-1] - edge[0]
    width = max(float(np.linalg.norm(across)), 1.0)
    reach = SEAM_COVER_EYE_WIDTHS * width
    low = np.maximum(np.floor(edge.min(axis=0) - 3 * reach).astype(int), 0)
    high = np.minimum(np.ceil(edge.max(axis=0) + 3 * reach).astype(int) + 1, frame.shape[1::-1])
    if (high - low).min() < 2:
        return
    mask = np.zeros((int(high[1] - low[1]), int(high[0] - low[0])), np.uint8)
    line = np.round((edge - low) * 16).astype(np.int32)
    cv2.polylines(mask, [line], False, 255, max(round(2 * reach), 1), cv2.LINE_AA, 4)
    soft = np.asarray(cv2.GaussianBlur(mask, (0, 0), max(reach / 2, 0.5)), np.float32)[..., None] / 255
    xs, ys = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    along = ((xs - edge[0, 0]) * across[0] + (ys - edge[0, 1]) * across[1]) / width**2
    colours = skin[-1, np.clip(np.rint(along * (skin.shape[1] - 1)), 0, skin.shape[1] - 1).astype(int)]
    part = frame[low[1] : high[1], low[0] : high[0]]
    part[:] = np.clip(part + share * soft * (colours - part) + 0.5, 0, 255).astype(np.uint8)


def _strip(mesh: NDArray, side: int) -> NDArray:
    """(18, 2) the skin above from corner to corner, then the lid's edge."""
    outer, inner = EYE_CORNER_VERTEX_PAIRS[side]
    strip = mesh[[v for row in UPPER_LID_STRIPS[side] for v in (outer, *row, inner)], :2].astype(float)
    strip[1:8] += LID_COLOUR_REACH_SHARE * (mesh[list(BELOW_BROW_VERTICES[side]), :2] - strip[1:8])
    return np.asarray(strip)


def _skin(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float32]:
    above = _above(rgb, mesh, side)
    height, width = above.shape[:2]
    by_light = np.argsort(-above.sum(axis=2), axis=0)[: max(1, round(LIGHTER_SKIN_SHARE * height))]
    colours = _along_the_lid(np.take_along_axis(above, by_light[..., None], axis=0))
    colours = _out_of_the_shadow(colours, _cheek(rgb, mesh, side))
    tall = max(
        height,
        round(float(np.linalg.norm(_strip(mesh, side)[1:8] - mesh[list(LOWER_LID_EDGES[side]), :2], axis=1).mean())),
    )
    return np.asarray(colours * _shading(tall, width) + _grain(rgb, mesh, side, (tall, width)), np.float32)


def _shading(height: int, width: int) -> NDArray[np.float32]:
    """(h, w, 1) the light on a lid: it lies over a ball, ends in a crease above, and its edge is in the lashes' shade."""
    down, across = np.linspace(0, 1, height)[:, None], np.linspace(-1, 1, width)[None]
    round_ = np.sqrt(1 - across**2)
    ball = round_ * np.sin(np.pi * np.clip((down - CREASE_PLACE_SHARE) / (1 - CREASE_PLACE_SHARE), 0, 1))
    crease = round_ * np.exp(-(((down - CREASE_PLACE_SHARE) / CREASE_WIDTH_SHARE) ** 2))
    shade = 1 - EDGE_SHADE_SHARE * down + BALL_LIGHT_SHARE * ball - CREASE_SHADE_SHARE * crease
    return np.asarray(shade, np.float32)[..., None]


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


def _grain(
    rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int, shape: tuple[int, int]
) -> NDArray[np.float32]:
    """(h, w, 3) of the `shape`: the grain of the cheek below an eye, which goes to and fro where it is smaller; none of what is stronger than grain."""
    outer, inner = (mesh[v, :2].astype(np.float64) for v in EYE_CORNER_VERTEX_PAIRS[side])
    wide, high = (max(2, round(share * float(np.linalg.norm(inner - outer)))) for share in CHEEK_PATCH_EYE_WIDTHS)
    right = (inner - outer) / np.linalg.norm(inner - outer)
    middle = mesh[list(CHEEK_BELOW_LID_VERTICES[side]), :2].mean(axis=0)
    across, down = np.arange(wide) - wide / 2, np.arange(high) - high / 2
    places = middle + across[None, :, None] * right + down[:, None, None] * np.array([-right[1], right[0]])
    x, y = cv2.split(places.astype(np.float32))
    patch = cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    grain = patch - cv2.GaussianBlur(patch, (0, 0), max(GRAIN_EYE_WIDTHS * wide, 0.5), borderType=cv2.BORDER_REPLICATE)
    grain *= np.clip(1 - (grain / MAX_GRAIN_GREY_LEVELS) ** 2, 0, 1)
    rows, columns = (np.arange(length) % (2 * size) for length, size in zip(shape, (high, wide), strict=True))
    return grain[np.minimum(rows, 2 * high - 1 - rows)][:, np.minimum(columns, 2 * wide - 1 - columns)]


def _out_of_the_shadow(colours: NDArray[np.float32], cheek: NDArray[np.float32]) -> NDArray[np.float32]:
    """Colours (1, w, 3) that are much darker than the cheek (3,), made brighter in their own hue: shaded skin is redder than the cheek, which made it grey.
    Highlights are as the cheek is."""
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


def _above(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float32]:
    """(h, w, 3) the skin from the crease up towards the brow, straightened, at the picture's own resolution."""
    rows = mesh[np.array([UPPER_LID_STRIPS[side][0], BELOW_BROW_VERTICES[side]]), :2].astype(np.float32)
    width = max(2, round(float(np.linalg.norm(np.diff(rows[0], axis=0), axis=1).sum())))
    height = max(2, round(float(np.linalg.norm(rows[1] - rows[0], axis=1).mean())))
    along = np.linspace(0, 6, width)
    low, high = (np.column_stack([np.interp(along, range(7), row[:, k]) for k in range(2)]) for row in rows)
    up = np.linspace(0, 1, height)[:, None, None]
    x, y = cv2.split(((1 - up) * low + up * high).astype(np.float32))
    return cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
