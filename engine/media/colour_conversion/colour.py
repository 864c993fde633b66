"""From the pixels that a video codec keeps to sRGB, by the file's colour tags."""

from __future__ import annotations

import numpy as np
from av.video.frame import VideoFrame
from av.video.reformatter import Interpolation, VideoReformatter

from engine.media.colour_conversion.tone_mapping import Primaries, ToneMap, Transfer, tone_map
from engine.media.colour_conversion.ycbcr import (
    BT601,
    BT709,
    BT2020,
    FULL_RANGE,
    LIMITED_RANGE,
    MATRICES,
    Coding,
    rgb_from_frame,
)

# FFmpeg's numbers (AVCOL_TRC_*, AVCOL_PRI_*; ITU-T H.273, tables 3 and 2). All others are near enough to BT.709.
_TRANSFERS: dict[int, Transfer] = {16: "pq", 18: "hlg"}
_PRIMARIES: dict[int, Primaries] = {9: "bt2020", 11: "p3", 12: "p3"}
# swscale's numbers of the matrices (SWS_CS_*).
_SWSCALE_SPACES = {1: 1, 4: 4, 5: 5, 6: 5, 7: 7, 9: 9, 10: 9}
_ACCURATE_SCALING = Interpolation.BICUBIC | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT


class SrgbConverter:
    """Turns the frames of one clip into sRGB of `size` (width, height); keeps tables and scalers between frames."""

    def __init__(self, size: tuple[int, int]):
        self._size = size
        self._scaler = VideoReformatter()
        self._maps: dict[tuple[Transfer, Primaries], ToneMap] = {}

    def convert(self, frame: VideoFrame) -> np.ndarray:
        """The frame as uint8 (height, width, 3) sRGB; what is transparent is laid over white."""
        transfer, primaries = transfer_of(frame), _primaries_of(frame)
        if any(component.is_alpha for component in frame.format.components) or frame.format.name == "pal8":
            return _over_white(self._reformat(frame, "rgba"))
        if transfer != "sdr" or primaries != "bt709":
            if (transfer, primaries) not in self._maps:
                self._maps[transfer, primaries] = tone_map(transfer, primaries)
            return self._maps[transfer, primaries].apply(self._reformat(frame, "rgb48le"))
        if frame.format.name in ("yuv420p", "yuvj420p") and all(plane.line_size > 0 for plane in frame.planes):
            coding = coding_of(frame)
            if (frame.width, frame.height) != self._size:
                frame = self._scaler.reformat(frame, *self._size, interpolation=_ACCURATE_SCALING)
            return rgb_from_frame(frame, coding)
        return self._reformat(frame, "rgb24")

    def _reformat(self, frame: VideoFrame, layout: str) -> np.ndarray:
        coding = coding_of(frame)
        converted = self._scaler.reformat(
            frame,
            *self._size,
            format=layout,
            src_colorspace=_SWSCALE_SPACES[coding.matrix],
            src_color_range=coding.range,
            dst_color_range=FULL_RANGE,
            interpolation=_ACCURATE_SCALING,
        )
        return converted.to_ndarray()


def transfer_of(frame: VideoFrame) -> Transfer:
    """How the frame's code values stand for light."""
    return _TRANSFERS.get(frame.color_trc, "sdr")


def coding_of(frame: VideoFrame) -> Coding:
    """The frame's matrix and range; untagged ones are BT.709 in high definition and BT.601 below, as players have it,
    and of limited range."""
    if frame.colorspace in MATRICES:
        matrix = int(frame.colorspace)
    elif _primaries_of(frame) == "bt2020":
        matrix = BT2020
    else:
        matrix = BT709 if frame.height > 576 or frame.width >= 1280 else BT601
    full = frame.color_range == FULL_RANGE or frame.format.name.startswith("yuvj")
    return Coding(matrix, FULL_RANGE if full else LIMITED_RANGE)


def _primaries_of(frame: VideoFrame) -> Primaries:
    high_range = transfer_of(frame) != "sdr"
    return _PRIMARIES.get(frame.color_primaries, "bt2020" if high_range and frame.color_primaries == 2 else "bt709")


def _over_white(rgba: np.ndarray) -> np.ndarray:
    alpha = rgba[..., 3:].astype(np.uint16)
    return ((rgba[..., :3] * alpha + 255 * (255 - alpha) + 127) // 255).astype(np.uint8)
