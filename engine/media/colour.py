"""From the pixels that a video codec keeps to sRGB, by the file's colour tags."""

from __future__ import annotations

import numpy as np
from av.video.frame import VideoFrame
from av.video.reformatter import Colorspace, Interpolation, VideoReformatter

_MATRICES = {1: Colorspace.ITU709, 5: Colorspace.ITU601, 6: Colorspace.ITU601, 7: Colorspace.SMPTE240M}
_MATRICES |= {4: Colorspace.FCC, 9: Colorspace.BT2020, 10: Colorspace.BT2020}


def to_rgb(frame: VideoFrame, reformatter: VideoReformatter, width: int, height: int) -> np.ndarray:
    """The frame as uint8 (height, width, 3) RGB, scaled where its own size differs."""
    matrix = _MATRICES.get(frame.colorspace)
    if matrix is None:  # untagged: high definition is BT.709, all else BT.601, as players have it
        matrix = Colorspace.ITU709 if frame.height > 576 or frame.width >= 1280 else Colorspace.ITU601
    converted = reformatter.reformat(
        frame, width, height, "rgb24", src_colorspace=matrix, interpolation=Interpolation.BICUBIC
    )
    return converted.to_ndarray()
