"""How large an input may be. Everything here is checked from headers, before a pixel is decoded."""

from __future__ import annotations

from dataclasses import dataclass

MAX_DECODED_SIDE_PIXELS = 16_384
"""Pixels of a side of whatever is looked at. Detectors and warps keep coordinates in 16 bits: from 32,767 on they end the
whole process; half of it leaves room for what they put around a picture."""
MIN_SIDE_PIXELS = 16
"""Pixels of a side: in less there is no face, and nobody whole."""


@dataclass(frozen=True)
class Limits:
    """Upper bounds for one input file; the caller (settings of the service, options of the shell) chooses them.

    The defaults take any phone's photo and a video of three minutes up to 4K at 30 frames a second. The pixel rate
    refuses 4K at 60 frames a second: decoding alone would be slower than 2 cores allow.
    """

    image_bytes: int = 100_000_000
    image_megapixels: float = 40.0
    """At most 178: beyond, Pillow's own guard against decompression bombs refuses."""

    video_bytes: int = 2_000_000_000
    video_seconds: float = 180.0
    video_megapixels: float = 8.9
    """Pixels of one frame: 4096x2160 has 8.85 million."""

    video_megapixels_per_second: float = 300.0
    """Pixels of a frame times frames a second: 4K at 30 has 249 million, 4K at 60 has 498."""

    video_frames: int = 21_600
    """Three minutes at 120 frames a second."""
