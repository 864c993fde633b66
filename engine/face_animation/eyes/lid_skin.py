"""The skin of upper lids that close: a picture of open eyes shows hardly any of it.

What is seen of it there, a narrow strip with lashes and their shadow, would be drawn out over the whole eye and make a
shut one black. So a closing lid takes the colours of the skin around it (`lid_colours`), more the further it closes, and the grain of the cheek.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.lid_colours import (
    BELOW_BROW_VERTICES,
    CHEEK_BELOW_LID_VERTICES,
    UPPER_LID_STRIPS,
    LidColours,
    lid_colours,
)
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.landmarks import LEFT_EYE_CORNER_VERTICES, RIGHT_EYE_CORNER_VERTICES

EYE_CORNER_VERTEX_PAIRS = (RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES)
"""Vertices at which both lids of an eye end; right eye first."""
LOWER_LID_EDGES = ((7, 163, 144, 145, 153, 154, 155), (249, 390, 373, 374, 380, 381, 382))
"""Vertices of the lower lid's edge."""
COLOUR_BLEND_SHARE = 0.4
"""Share of the way from the skin above to the lid's edge over which the colours go over."""
LID_COLOUR_REACH_SHARE = 0.6
"""Share of the way from the skin above the lid up to below the brow that a lid's colours reach: upper lashes stand
there in a picture."""
CHEEK_PATCH_EYE_WIDTHS = (0.9, 0.35)
"""Width and height, eye widths, of the place on the cheek whose grain a lid has."""
GRAIN_EYE_WIDTHS = 0.1
"""Eye widths below which what is seen of the skin is its grain."""
MAX_GRAIN_GREY_LEVELS = 12.0
"""Grey levels up to which structure counts as grain: what is stronger are lashes, brows and paint."""
PASSING_SHARES = (0.3, 1.0)
"""Shares of the way from the skin above to the lid's edge from which on, and up to which, its tone and hue pass over from those of the skin above to those of the skin
below."""
EDGE_SHADE_SHARE = 0.1
"""By how much a lid is darker at its edge."""
BALL_LIGHT_SHARE = 0.12
"""By how much a lid is lighter in its middle, over the eyeball."""
CREASE_PLACE_SHARE, CREASE_WIDTH_SHARE, CREASE_SHADE_SHARE = 0.36, 0.14, 0.08
"""Where the crease above a lid is, as a share of the way from the skin above to the lid's edge, how wide it is, and by
how much it is darker there: soft, for a line would be an outline."""
SEAM_COVER_EYE_WIDTHS = 0.05
"""Eye widths around the line where lids meet, and beyond its ends, that are of the lid's colour. The tracker's eye and
the picture's differ by as much, and what is left of the picture's beside the line are specks of white and lash."""
OUTER_CORNER_COVER_EYE_WIDTHS = 0.08
"""Eye widths around an eye's outer corner that are of the lid's colour: tracker and picture differ most in where it is."""
_STRIP_TRIANGLES = np.array([t for k in range(8) for t in ((k, k + 1, 9 + k), (k + 1, 10 + k, 9 + k))], np.int32)


def lid_skins(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> list[NDArray[np.float32]]:
    """The skin of both upper lids, right one first, of a target (H, W, 3) with its face at `mesh` (478, 2 or 3). Each
    is (h, w, 3) float32, from the crease down to the edge, and from the eye's outer corner to the inner one."""
    return [_skin(rgb, mesh, side, colours) for side, colours in enumerate(lid_colours(rgb, mesh))]


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
    corner = OUTER_CORNER_COVER_EYE_WIDTHS * width
    outer = np.round((edge[0] - corner * across / width / 3 - low) * 16).astype(int).tolist()
    cv2.circle(mask, outer, round(16 * corner), 255, -1, cv2.LINE_AA, 4)
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


def _skin(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int, colours: LidColours) -> NDArray[np.float32]:
    width = colours.above.shape[1]
    opening = _strip(mesh, side)[1:8] - mesh[list(LOWER_LID_EDGES[side]), :2]
    tall = max(2, round(float(np.linalg.norm(opening, axis=1).mean())))
    passed = smoothstep(np.linspace(0, 1, tall), *PASSING_SHARES)[:, None, None]
    blended = colours.above + passed * (colours.below - colours.above)
    return np.asarray(blended * _shading(tall, width) + _grain(rgb, mesh, side, (tall, width)), np.float32)


def _shading(height: int, width: int) -> NDArray[np.float32]:
    """(h, w, 1) the light on a lid: it lies over a ball, ends in a crease above, and its edge is in the lashes' shade."""
    down, across = np.linspace(0, 1, height)[:, None], np.linspace(-1, 1, width)[None]
    round_ = np.sqrt(1 - across**2)
    ball = round_ * np.sin(np.pi * np.clip((down - CREASE_PLACE_SHARE) / (1 - CREASE_PLACE_SHARE), 0, 1))
    crease = round_ * np.exp(-(((down - CREASE_PLACE_SHARE) / CREASE_WIDTH_SHARE) ** 2))
    shade = 1 - EDGE_SHADE_SHARE * down + BALL_LIGHT_SHARE * ball - CREASE_SHADE_SHARE * crease
    return np.asarray(shade, np.float32)[..., None]


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
