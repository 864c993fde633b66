"""The skin of a socket without its eye: what a shut lid is made of.

A picture of open eyes shows hardly any of the upper lid. What it shows there are lashes, their paint and shadow, and the
crease, and drawn out over the eye they are specks, ghosts and patches. So nothing within the lids' edges, and nothing that is not of the
colour of most of the skin around them, is taken. What is left is continued over the eye: a smooth surface in two dimensions
through the skin from the brow to the cheek, which passes into what is seen of that skin, with the grain of the cheek.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_frame import (
    INNER_REACH_EYE_WIDTHS,
    OUTER_REACH_EYE_WIDTHS,
    SocketFrame,
    socket_frame,
)
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS

CHEEK_BELOW_LID_VERTICES = ((117, 118, 119, 120, 100, 101), (346, 347, 348, 349, 329, 330))
"""Vertices of the cheek below the eye."""
LIT_CHEEK_SHARES = (0.35, 0.8)
"""Of the light of the cheek below, up to which what is around an eye is lash, brow, paint or a socket's shadow, in which no shut lid is, and from which on it
is skin."""
LASH_MARGIN_EYE_WIDTHS = 0.12
"""Eye widths around the opening in which nothing is believed to be skin: lashes stand there, and their shadow lies there."""
SURFACE_DEGREE = 2
"""Of the polynomial along and down that most of the skin's colours are."""
SURFACE_ROUNDS = 6
"""Rounds of reweighted least squares."""
MIN_SKIN_DEVIATION_GREY_LEVELS = 3.0
"""Grey levels by which skin differs from its surface at least."""
OWN_REACH_EYE_WIDTHS, OWN_DOUBT = 0.08, 0.15
"""Eye widths over which what skin differs from its surface by is carried on, and how much of it is doubted."""
SKIN_RANGE_PERCENTILES = (5, 95)
"""Of each channel of the skin around an eye, between which its lid is: a surface that is continued may leave them."""
CHEEK_PATCH_EYE_WIDTHS = (0.9, 0.35)
"""Width and height, eye widths, of the place on the cheek whose grain a lid has."""
GRAIN_EYE_WIDTHS = 0.1
"""Eye widths below which what is seen of the skin is its grain."""
MAX_GRAIN_GREY_LEVELS = 12.0
"""Grey levels up to which structure counts as grain: what is stronger are strands, spots and paint."""


def socket_skin(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> NDArray[np.float32]:
    """(h, w, 3) float32 of the right eye, 0, or the left one of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3), from the outer corner's side to the inner
    one's and from the socket's top to its bottom (`SocketFrame`), at the picture's resolution."""
    frame = socket_frame(mesh, side)
    along, down = socket_places(frame)
    places = frame.pixels(along, down).astype(np.float32)
    x, y = cv2.split(places)
    shown = cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    light = shown @ LUMINANCE_WEIGHTS.astype(np.float32)
    cheek = _cheek_light(rgb, mesh, side)
    skin = beside_the_eye(frame, along, down) * smoothstep(light / cheek, *LIT_CHEEK_SHARES)
    surface, trust = _surface(shown, skin, along, down)
    sigma = max(OWN_REACH_EYE_WIDTHS * frame.width, 1.0)
    near = np.asarray(cv2.GaussianBlur(trust, (0, 0), sigma))[..., None]
    own = np.asarray(cv2.GaussianBlur(trust[..., None] * (shown - surface), (0, 0), sigma))
    bare = surface + own / (near + OWN_DOUBT)
    if (trust > 0.5).any():
        bare = np.clip(bare, *np.percentile(shown[trust > 0.5], SKIN_RANGE_PERCENTILES, axis=0))
    return np.asarray(bare + _grain(rgb, mesh, side, bare.shape[:2], frame), np.float32)


def socket_places(frame: SocketFrame) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(h, w) the places, along and down, of the pixels of the socket's skin."""
    count = max(round((1 + OUTER_REACH_EYE_WIDTHS + INNER_REACH_EYE_WIDTHS) * frame.width), 2)
    along = np.linspace(-OUTER_REACH_EYE_WIDTHS, 1 + INNER_REACH_EYE_WIDTHS, count)
    top, bottom = frame.ends(along)
    rows = max(round(float((bottom - top).mean()) * frame.width), 2)
    down = top + np.linspace(0, 1, rows)[:, None] * (bottom - top)
    return np.broadcast_to(along, down.shape), down


def beside_the_eye(frame: SocketFrame, along: NDArray[np.floating], down: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(h, w) whether places are outside both lids' edges, and as far from them as lashes are long."""
    lower = np.interp(along, frame.lower[:, 0], frame.lower[:, 1])
    between = (along > -LASH_MARGIN_EYE_WIDTHS) & (along < 1 + LASH_MARGIN_EYE_WIDTHS)
    return ~(between & (down > frame.rim(along) - LASH_MARGIN_EYE_WIDTHS) & (down < lower + LASH_MARGIN_EYE_WIDTHS))


def _surface(
    shown: NDArray[np.float32], skin: NDArray[np.floating], along: NDArray[np.floating], down: NDArray[np.floating]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(h, w, 3) the polynomial through the colours of most of the `skin` (h, w) that is `shown` (h, w, 3), and (h, w) in [0, 1] how far
    a pixel is of it."""
    x, y = along - 0.5, down
    powers = [(i, j) for i in range(SURFACE_DEGREE + 1) for j in range(SURFACE_DEGREE + 1 - i)]
    basis = np.stack([x**i * y**j for i, j in powers], axis=-1)
    weights = skin.astype(np.float64)
    for _ in range(SURFACE_ROUNDS):
        normal = np.einsum("hw,hwi,hwj->ij", weights, basis, basis) + 1e-3 * np.eye(len(powers))
        found = basis @ np.linalg.solve(normal, np.einsum("hw,hwi,hwc->ic", weights, basis, shown))
        away = np.linalg.norm(shown - found, axis=2)
        usual = float(np.median(away[skin > 0.5])) if (skin > 0.5).any() else 0.0
        weights = skin / (1 + (away / (2 * max(usual, MIN_SKIN_DEVIATION_GREY_LEVELS))) ** 2) ** 2
    return found.astype(np.float32), weights.astype(np.float32)


def _cheek_light(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int) -> float:
    """The luminance of the cheek below an eye."""
    area = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillConvexPoly(area, cv2.convexHull(mesh[list(CHEEK_BELOW_LID_VERTICES[side]), :2].round().astype(np.int32)), 1)
    return max(float(np.array(cv2.mean(rgb, area)[:3]) @ LUMINANCE_WEIGHTS), 1.0)


def _grain(
    rgb: NDArray[np.uint8], mesh: NDArray[np.floating], side: int, shape: tuple[int, ...], frame: SocketFrame
) -> NDArray[np.float32]:
    """(h, w, 3) of the `shape`: the grain of the cheek below an eye, which goes to and fro where it is smaller; none of what is stronger than grain."""
    wide, high = (max(2, round(share * frame.width)) for share in CHEEK_PATCH_EYE_WIDTHS)
    middle = mesh[list(CHEEK_BELOW_LID_VERTICES[side]), :2].mean(axis=0)
    across, below = np.arange(wide) - wide / 2, np.arange(high) - high / 2
    places = middle + across[None, :, None] * frame.axes[0] + below[:, None, None] * frame.axes[1]
    x, y = cv2.split(places.astype(np.float32))
    patch = cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    grain = patch - cv2.GaussianBlur(patch, (0, 0), max(GRAIN_EYE_WIDTHS * wide, 0.5), borderType=cv2.BORDER_REPLICATE)
    grain *= np.clip(1 - (grain / MAX_GRAIN_GREY_LEVELS) ** 2, 0, 1)
    rows, columns = (np.arange(length) % (2 * size) for length, size in zip(shape, (high, wide), strict=False))
    return grain[np.minimum(rows, 2 * high - 1 - rows)][:, np.minimum(columns, 2 * wide - 1 - columns)]
