"""From the light that a sensor measured to frames as codecs take them: ordinary ones in sRGB, and those of high dynamic range.

Sources: IEC 61966-2-1 (sRGB), ITU-R BT.2100 (HLG), BT.2408 (its white at 203 cd/m2).
"""

from __future__ import annotations

import av
import numpy as np
from av.video.frame import VideoFrame
from numpy.typing import NDArray

from engine.media.colour_conversion.tone_mapping import PEAK_NITS, WHITE_NITS, srgb_code, xyz_of
from engine.media.colour_conversion.ycbcr import BT2020, LIMITED_RANGE, frame_from_rgb

TONE_TABLE_STEPS = 4096
"""Steps of the table from light to sRGB."""
HLG_TRANSFER = 18
"""FFmpeg's number of hybrid log-gamma (AVCOL_TRC_ARIB_STD_B67)."""
DARKEST_LIGHT = 1e-9
"""Luminance below which all counts as this much."""


def srgb_frame(light: NDArray[np.float32]) -> VideoFrame:
    """A frame of 8 bits, BT.709, of linear light (H, W, 3) whose white is 1; what is brighter is clipped."""
    table = np.rint(255 * srgb_code(np.linspace(0, 1, TONE_TABLE_STEPS))).astype(np.uint8)
    step = (np.clip(light, 0, 1) * np.float32(TONE_TABLE_STEPS - 1) + np.float32(0.5)).astype(np.uint16)
    return frame_from_rgb(table[step])


def hlg_frame(light: NDArray[np.float32]) -> VideoFrame:
    """A frame of 10 bits, BT.2020 and HLG, of the same light as a display shows it."""
    wide = np.linalg.inv(xyz_of("bt2020")) @ xyz_of("bt709")
    shown = np.clip(light, 0, None) @ (WHITE_NITS / PEAK_NITS * wide).T.astype(np.float32)
    luminance = np.maximum(shown @ xyz_of("bt2020")[1].astype(np.float32), DARKEST_LIGHT)
    scene = shown * luminance[..., None] ** np.float32(-0.2 / 1.2)  # the display's own curve is undone
    codes = np.clip(hlg_code(scene), 0, 1) * 65535
    frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(codes + 0.5, np.uint16), "rgb48le")
    frame = frame.reformat(format="yuv420p10le", dst_colorspace=BT2020, dst_color_range=LIMITED_RANGE)
    frame.colorspace = frame.color_primaries = BT2020
    frame.color_trc, frame.color_range = HLG_TRANSFER, LIMITED_RANGE
    return frame


def hlg_code(scene: NDArray[np.floating]) -> NDArray[np.floating]:
    """HLG code values in [0, 1] of a scene's light in [0, 1] (BT.2100, table 5): the inverse of
    `engine.media.colour_conversion.tone_mapping.hlg_scene_light`."""
    a, b, c = 0.17883277, 0.28466892, 0.55991073
    bright = a * np.log(np.maximum(12 * scene - b, DARKEST_LIGHT)) + c
    return np.asarray(np.where(scene <= 1 / 12, np.sqrt(3 * np.maximum(scene, 0)), bright))
