"""Upper lids that close: the skin of the socket comes down before the eye as far as the lid's edge, which has a line of lashes.

All of it follows from how far the eye is open. As it begins to close nothing is changed of the picture.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_frame import INNER_REACH_EYE_WIDTHS, OUTER_REACH_EYE_WIDTHS, SocketFrame
from engine.face_animation.smoothstep import smoothstep

UPPER_BLEND_SHARE = 0.7
"""Of the way from the socket's top to the lid's edge over which its skin passes into the picture's."""
OUTER_BLEND_EYE_WIDTHS, INNER_BLEND_EYE_WIDTHS = 0.25, 0.15
"""Eye widths from both ends of the socket over which its skin passes into the picture's."""
EDGE_SOFTNESS_EYE_WIDTHS, MIN_EDGE_SOFTNESS_PIXELS = 0.02, 0.8
"""Eye widths, pixels at least, over which a lid's edge ends."""
SHUT_REACH_EYE_WIDTHS, SHUT_SOFTNESS_EYE_WIDTHS = 0.14, 0.16
"""Eye widths beyond the line where lids meet that are skin, too, and over which they pass into the picture's: the rim of the lower lid turns in as an eye is
shut, and a tracker's eye and the picture's differ by as much."""
BALL_LIGHT_SHARE, EDGE_SHADE_SHARE = 0.08, 0.06
"""By how much a lid is lighter in its middle, over the eyeball, and darker at its edge, which faces down."""
CREASE_PLACE_SHARE, CREASE_WIDTH_SHARE, CREASE_SHADE_SHARE = 0.45, 0.1, 0.08
"""Where the crease above a lid is, as a share of the way from the socket's top to the lid's edge, how wide it is, and by how much it is darker there."""


def draw_lid(
    frame: NDArray[np.uint8], skin: NDArray[np.float32], socket: SocketFrame, share: float, shut: float
) -> None:
    """Draw a `share` of an upper lid of `skin` (`socket_skin`) in a frame (H, W, 3), in place, where the face in it has the `socket`. `shut` : in [0, 1]
    how far what is below its edge is skin, too.
    """
    low, high = socket.box(frame.shape)
    if share == 0 or (high - low).min() < 2:
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    along, down = socket.of_pixels(x, y)
    top, bottom = socket.ends(along)
    rim = socket.rim(along)
    part = frame[low[1] : high[1], low[0] : high[0]]
    reach = 1 + OUTER_REACH_EYE_WIDTHS + INNER_REACH_EYE_WIDTHS
    at = (along + OUTER_REACH_EYE_WIDTHS) / reach * (skin.shape[1] - 1)
    height = (down - top) / np.maximum(bottom - top, 1e-3) * (len(skin) - 1)
    seen = np.asarray(
        cv2.remap(
            skin, at.astype(np.float32), height.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        ),
        np.float32,
    )
    way = (down - top) / np.maximum(rim - top, 1e-3)
    covered = smoothstep(way, 0, UPPER_BLEND_SHARE)
    covered *= smoothstep(along, -OUTER_REACH_EYE_WIDTHS, OUTER_BLEND_EYE_WIDTHS - OUTER_REACH_EYE_WIDTHS)
    covered *= smoothstep(along, 1 + INNER_REACH_EYE_WIDTHS, 1 + INNER_REACH_EYE_WIDTHS - INNER_BLEND_EYE_WIDTHS)
    soft = max(EDGE_SOFTNESS_EYE_WIDTHS, MIN_EDGE_SOFTNESS_PIXELS / socket.width) + shut * SHUT_SOFTNESS_EYE_WIDTHS
    soft = soft + np.abs(along - np.clip(along, 0, 1))  # an edge ends at the corners
    past = down - rim - shut * SHUT_REACH_EYE_WIDTHS
    covered *= 1 - smoothstep(past, -soft / 2, soft / 2)
    alpha = (share * covered)[..., None]
    lit = seen * _light(way, along)[..., None]
    part[:] = np.clip(part + alpha * (lit - part) + 0.5, 0, 255).astype(np.uint8)


def _light(way: NDArray[np.floating], along: NDArray[np.floating]) -> NDArray[np.float64]:
    """(h, w) the light on a lid: it lies over a ball, ends in a crease above, and its edge faces down. `way` (h, w) from the socket's top to the lid's edge."""
    round_ = np.sqrt(np.clip(1 - (2 * along - 1) ** 2, 0, 1))
    ball = np.sin(np.pi * np.clip((way - CREASE_PLACE_SHARE) / (1 - CREASE_PLACE_SHARE), 0, 1))
    crease = np.exp(-(((way - CREASE_PLACE_SHARE) / CREASE_WIDTH_SHARE) ** 2))
    edge = smoothstep(way, 0.6, 1) * (1 - smoothstep(way, 1, 1.2))
    return np.asarray(
        1 + round_ * (BALL_LIGHT_SHARE * ball - EDGE_SHADE_SHARE * edge - CREASE_SHADE_SHARE * crease), np.float64
    )
