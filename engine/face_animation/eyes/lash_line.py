"""The line of lashes at the edge of an upper lid: as dark and as wide as the picture's own, and tapered to both corners."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_frame import SocketFrame
from engine.imaging.luminance import LUMINANCE_WEIGHTS

LASH_WIDTH_RANGE_EYE_WIDTHS = (0.04, 0.09)
"""Eye widths of the line in the middle of a lid: bare edges have the first, painted ones hardly more than the second."""
LASH_REACH_EYE_WIDTHS = 0.16
"""Eye widths above a lid's edge in which lashes and their paint are looked for."""
LASH_COLUMNS, LASH_ROWS = 15, 24
"""Places along the middle half of a lid, and above each of them, at which it is looked how dark it is there."""
OUTSIDE_EDGE_EYE_WIDTHS = 0.05
"""Eye widths outside of a lid's edge at which a drawn eye may end."""
SKIN_LIGHT_PERCENTILE = 90
"""Of the light above a lid's edge, that which is of skin."""
LASH_LINE_POINTS, MIN_LASH_LINE_PIXELS = 25, 1.5
"""At which the curve of the lid's edge is drawn, and pixels of the line in its middle at least."""
LASH_LINE_SAMPLES, MIN_LASH_SOFTNESS_PIXELS = 4, 0.4
"""To a pixel, along each axis, at which it is drawn, and pixels by which its edges are soft at least."""


class Lashes(NamedTuple):
    """colour : (3,) float32.
    width : of the line in the middle of the lid, eye widths.
    """

    colour: NDArray[np.float32]
    width: float


def upper_lashes(rgb: NDArray[np.uint8], socket: SocketFrame) -> Lashes:
    """Those of an eye of a picture (H, W, 3) whose face has the `socket`."""
    colour = _colour(rgb, socket)
    along = np.linspace(0.25, 0.75, LASH_COLUMNS)
    up = np.linspace(0, LASH_REACH_EYE_WIDTHS, LASH_ROWS)[:, None]
    x, y = cv2.split(
        socket.pixels(np.broadcast_to(along, (LASH_ROWS, LASH_COLUMNS)), socket.rim(along) - up).astype(np.float32)
    )
    light = cv2.remap(rgb, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE) @ LUMINANCE_WEIGHTS
    lash, skin = float(colour @ LUMINANCE_WEIGHTS), float(np.percentile(light, SKIN_LIGHT_PERCENTILE))
    dark = np.cumprod(light < (lash + skin) / 2, axis=0)  # from the edge up, as far as it goes on
    wide = float(np.median(dark.sum(axis=0))) / LASH_ROWS * LASH_REACH_EYE_WIDTHS
    return Lashes(colour, float(np.clip(wide, *LASH_WIDTH_RANGE_EYE_WIDTHS)))


def draw_lashes(frame: NDArray[np.uint8], lashes: Lashes, socket: SocketFrame, share: float) -> None:
    """Draw a `share` of the line in a frame (H, W, 3), in place, where the face in it has the `socket`."""
    low, high = socket.box(frame.shape)
    if share == 0 or (high - low).min() < 2:
        return
    part = frame[low[1] : high[1], low[0] : high[0]]
    line = share * _line(socket, lashes.width, low, part.shape[:2])[..., None]
    part[:] = np.clip(part + line * (lashes.colour - part) + 0.5, 0, 255).astype(np.uint8)


def _line(socket: SocketFrame, wide: float, low: NDArray[np.integer], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(h, w) in [0, 1], the curve of the lid's edge in a part of `shape` whose first pixel is `low` (x, y)."""
    t = np.linspace(0, 1, LASH_LINE_POINTS)
    half = max(wide, MIN_LASH_LINE_PIXELS / socket.width) / 2 * np.sin(np.pi * t)
    rim = socket.rim(t)
    band = np.concatenate([socket.pixels(t, rim + half), socket.pixels(t, rim - half)[::-1]]) - low
    finer = LASH_LINE_SAMPLES
    mask = np.zeros((finer * shape[0], finer * shape[1]), np.uint8)
    places = np.round((finer * band + (finer - 1) / 2) * 16).astype(np.int32)
    cv2.fillPoly(mask, [places], 255, cv2.LINE_8, 4)
    mask = np.asarray(cv2.resize(mask, shape[::-1], interpolation=cv2.INTER_AREA), np.uint8)
    soft = cv2.GaussianBlur(mask, (0, 0), max(wide * socket.width / 4, MIN_LASH_SOFTNESS_PIXELS))
    return np.asarray(soft, np.float32) / np.float32(255)


def _colour(rgb: NDArray[np.uint8], socket: SocketFrame) -> NDArray[np.float32]:
    """The darker half of the colours along the upper lid's edge, their mean (3,): there, or as far outside of it as lashes
    are wide, for a drawn eye may end beyond the mesh's."""
    along, down = socket.upper[1:8].T
    edge = np.stack([socket.pixels(along, down), socket.pixels(along, down - OUTSIDE_EDGE_EYE_WIDTHS)])
    x, y = np.moveaxis(np.clip(np.rint(edge).astype(int), 0, (rgb.shape[1] - 1, rgb.shape[0] - 1)), -1, 0)
    colours = rgb[y, x].astype(np.float32)
    colours = colours[colours.sum(axis=-1).argmin(axis=0), np.arange(len(along))]
    return np.asarray(colours[np.argsort(colours.sum(axis=1))[:4]].mean(axis=0), np.float32)
